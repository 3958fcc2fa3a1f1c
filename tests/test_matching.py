"""The closed form against a numerical optimiser, and the grids against a loop over windows."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from mocap import rotations
from mocap.errors import MocapError, SkeletonMismatch
from mocap.matching import align, distance_grid, distinct_joints, point_cloud, root_grid
from mocap.skeleton import Skeleton
from mocap.transforms import PlanarTransform
from tests.strategies import planar, random_motion, seeds, wave


def squared_distance(transform, points, others, weights):
    return float(weights @ ((points - PlanarTransform(*transform).points(others)) ** 2).sum(-1))


@settings(max_examples=25)
@given(seeds)
def test_no_optimiser_finds_a_better_alignment(seed):
    random = np.random.default_rng(seed)
    points, others = random.normal(size=(2, 12, 3))
    weights = random.random(12)
    best = squared_distance(align(points, others, weights), points, others, weights)
    for start in np.linspace(-np.pi, np.pi, 4, endpoint=False):
        found = minimize(squared_distance, [start, 0, 0], args=(points, others, weights))
        assert best <= found.fun + 1e-6


@given(seeds, planar)
def test_alignment_finds_the_transform_that_was_applied(seed, transform):
    points = np.random.default_rng(seed).normal(size=(8, 3))
    found = align(transform.points(points), points)
    assert found.points(points) == pytest.approx(transform.points(points), abs=1e-9)


@given(seeds, planar, planar)
def test_the_distance_does_not_change_when_either_cloud_is_moved(seed, move_a, move_b):
    a, b = np.random.default_rng(seed).normal(size=(2, 8, 3))
    weights = np.full(8, 1 / 8)
    before = squared_distance(align(a, b), a, b, weights)
    a, b = move_a.points(a), move_b.points(b)
    assert squared_distance(align(a, b), a, b, weights) == pytest.approx(before, abs=1e-8)


def test_alignment_works_on_many_clouds_at_once():
    a, b = np.random.default_rng(0).normal(size=(2, 3, 4, 9, 3))
    together = align(a, b)
    assert np.shape(together.angle) == (3, 4)
    one = align(a[2, 1], b[2, 1])
    assert [field[2, 1] for field in together] == pytest.approx(list(one))


@pytest.mark.parametrize("weights", [[1, 1], [1, -1, 1], [0, 0, 0], [1, np.nan, 1]])
def test_weights_must_make_sense(weights):
    with pytest.raises(MocapError, match="Weights must be 3 numbers, not negative and not all 0"):
        align(np.eye(3), np.eye(3), weights)


def grid_by_loops(a, b, window):
    """Align and measure window by window."""
    rows, columns = len(a) - window + 1, len(b) - window + 1
    grid = np.empty((rows, columns))
    for i, j in np.ndindex(rows, columns):
        p, q = a[i : i + window].reshape(-1, 3), b[j : j + window].reshape(-1, 3)
        grid[i, j] = squared_distance(align(p, q), p, q, np.full(len(p), 1 / len(p)))
    return grid


@settings(max_examples=20)
@given(seeds, st.integers(1, 4))
def test_the_grid_is_the_loop_over_windows(seed, window):
    a, b = (np.random.default_rng(seed + s).normal(size=(n, 6, 3)) for s, n in ((0, 7), (1, 5)))
    assert distance_grid(a, b, window=window) == pytest.approx(grid_by_loops(a, b, window), abs=1e-10)


def test_the_grid_of_motions_is_that_of_their_points():
    a, b = wave(20), wave(25, phase=1.0)
    assert np.array_equal(
        distance_grid(a, b, window=5), distance_grid(point_cloud(a), point_cloud(b), window=5)
    )


@given(seeds, planar)
def test_a_clip_is_at_no_distance_from_itself_moved_anywhere(seed, transform):
    motion = random_motion(seed)
    grid = distance_grid(motion, transform.motion(motion), window=3)
    assert np.sqrt(grid.diagonal()) == pytest.approx(0, abs=1e-6)
    assert grid == pytest.approx(grid.T, abs=1e-9)


def test_far_from_the_origin_no_digits_are_lost():
    near, other = wave(30), wave(30, phase=2.0)
    far = PlanarTransform(1.0, 1e4, -1e4).motion(near)
    assert distance_grid(far, other, window=4) == pytest.approx(
        distance_grid(near, other, window=4), abs=1e-8
    )


def test_clips_that_do_not_go_together_are_refused():
    with pytest.raises(SkeletonMismatch):
        distance_grid(wave(9), random_motion(0), window=2)
    with pytest.raises(MocapError, match="resample one first"):
        distance_grid(wave(9), replace(wave(9), fps=60), window=2)
    with pytest.raises(MocapError, match="'wave' has 9 frames, too few for a window of 10"):
        distance_grid(wave(20), wave(9), window=10)
    with pytest.raises(MocapError, match="at least one frame, got 0"):
        distance_grid(wave(9), wave(9), window=0)
    with pytest.raises(MocapError, match="2 and 3 points do not match"):
        distance_grid(np.zeros((5, 2, 3)), np.zeros((5, 3, 3)), window=2)


def test_coincident_joints_are_one_point():
    hips = Skeleton(
        ["root", "l", "r", "lknee", "rknee"], [-1, 0, 0, 1, 2], np.array([[0, 0, 0]] * 3 + [[0, -1, 0]] * 2)
    )
    assert distinct_joints(hips) == [0, 3, 4]


def test_a_cmu_skeleton_has_31_points(real_data):
    from mocap import load_skeleton

    assert len(distinct_joints(load_skeleton(real_data / "cmu" / "16" / "16.asf"))) == 31


def test_root_grid_adds_metres_and_radians():
    a = random_motion(0, frames=6)
    b = replace(random_motion(1, frames=4, skeleton=a.skeleton), name="b")
    grid = root_grid(a, b, window=2)
    for i, j in np.ndindex(*grid.shape):
        steps = [
            np.linalg.norm(a.root_positions[i + f] - b.root_positions[j + f])
            + rotations.angle_between(a.rotations[i + f, 0], b.rotations[j + f, 0])
            for f in range(2)
        ]
        assert grid[i, j] == pytest.approx(np.mean(steps))


def test_root_grid_is_misled_by_where_a_clip_was_captured():
    """The paper's point: the same motion elsewhere is far in the root metric, and at 0 in the right one."""
    a = wave(20)
    b = PlanarTransform(2.0, 3.0, 0.0).motion(a)
    assert root_grid(a, b, window=3).diagonal().min() > 2
    assert distance_grid(a, b, window=3).diagonal().max() < 1e-12
