"""Both ways from clip into clip: own frames around a smooth passage; and what only a join does."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.inertialization import inertialize
from mocap.blending.interpolation import blend
from mocap.blending.joining import join, lay_window_on, splice
from mocap.blending.weights import linear_weights
from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError, SkeletonMismatch
from mocap.matching.distance_grids import distance_grid
from mocap.matching.point_clouds import point_cloud
from tests.strategies import planar, random_motion, wave

A, B = wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)
GRIDS = {window: distance_grid(A, B, window=window) for window in (1, 8)}
GRID = GRIDS[8][20:90, 20:60]
LEAVE, ENTER = (20 + int(n) for n in np.unravel_index(GRID.argmin(), GRID.shape))
both = pytest.mark.parametrize("way", [join, inertialize])


@both
@given(i=st.integers(0, 100), j=st.integers(0, 70), window=st.integers(1, 20))
def test_before_the_window_it_is_a_and_after_it_b_laid_on(way, i, j, window):
    joined = way(A, i, B, j, window)
    laid = lay_window_on(A, i, B, j, window)
    assert len(joined) == i + len(B) - j
    assert np.array_equal(joined.root_positions[:i], A.root_positions[:i])
    assert np.array_equal(joined.rotations[:i], A.rotations[:i])
    assert np.array_equal(joined.root_positions[i + window :], laid.root_positions[j + window :])
    assert np.array_equal(joined.rotations[i + window :], laid.rotations[j + window :])


@both
@given(transform=planar)
def test_where_b_was_captured_does_not_matter(way, transform):
    here, there = (joint_positions(way(A, LEAVE, b, ENTER, 8)) for b in (B, transform.apply_motion(B)))
    assert here == pytest.approx(there, abs=1e-7)


@both
def test_a_clip_joined_to_itself_where_it_is_goes_on(way):
    again = way(A, 30, A, 30, 10)
    assert joint_positions(again) == pytest.approx(joint_positions(A), abs=1e-9)


def test_a_join_is_the_blend_of_the_two_windows_and_any_weights_may_be_given():
    laid = lay_window_on(A, LEAVE, B, ENTER, 8)
    for weights in (linear_weights, lambda window: np.full(window, 0.3)):
        joined = join(A, LEAVE, B, ENTER, 8, weights=weights)
        mixed = blend(A[LEAVE : LEAVE + 8], laid[ENTER : ENTER + 8], weights(8))
        assert np.array_equal(joined.rotations[LEAVE : LEAVE + 8], mixed.rotations)


def test_marks_are_carried_through_by_the_larger_weight():
    a = replace(A, labels={"walk": True}, contacts={"hand": True})
    b = replace(B, labels={"run": True}, contacts={"hand": False, "elbow": True})
    joined = join(a, 30, b, 10, 8)
    assert joined.labels["walk"].tolist() == [True] * 34 + [False] * 76
    assert joined.labels["run"].tolist() == [False] * 34 + [True] * 76
    assert joined.contacts["hand"].tolist() == [True] * 34 + [False] * 76
    assert inertialize(a, 30, b, 10, 8).contacts["elbow"].tolist() == [False] * 30 + [True] * 80


def roughness(motion):
    """Return the largest jump of any joint's velocity around the seam, m/s."""
    points = joint_positions(motion)[LEAVE - 3 : LEAVE + 16]
    return np.linalg.norm(np.diff(points, 2, axis=0), axis=-1).max() * motion.fps


@both
def test_the_seam_is_as_smooth_as_the_clips_and_a_cut_is_not(way):
    clip = np.linalg.norm(np.diff(joint_positions(A), 2, axis=0), axis=-1).max() * A.fps
    assert roughness(way(A, LEAVE, B, ENTER + 4, 12)) < 1.5 * clip
    assert roughness(way(A, LEAVE, B, ENTER + 4, 1)) > 2 * clip


@both
@pytest.mark.parametrize(
    ("i", "j", "window", "name"),
    [(113, 0, 8, "'a', which has 120"), (0, 83, 8, "'b', which has 90"), (-1, 0, 8, "'a'")],
)
def test_a_window_must_not_run_off_a_clip(way, i, j, window, name):
    with pytest.raises(MocapError, match=f"frames from frame {i or j} runs off {name}"):
        way(A, i, B, j, window)


@both
def test_motions_must_go_together(way):
    with pytest.raises(SkeletonMismatch):
        way(A, 0, random_motion(0, frames=20), 0, 5)
    with pytest.raises(MocapError, match="resample one first"):
        way(A, 0, replace(B, fps=60.0), 0, 5)
    with pytest.raises(MocapError, match="at least one frame, got 0"):
        way(A, 0, B, 0, 0)


@given(st.sampled_from([*GRIDS]), st.integers(0, 112), st.integers(0, 82), planar)
def test_the_windows_agree_as_well_as_the_distance_grid_says(window, i, j, transform):
    laid = lay_window_on(A, i, transform.apply_motion(B), j, window)
    gaps = point_cloud(A)[i : i + window] - point_cloud(laid)[j : j + window]
    assert (gaps**2).sum(-1).mean() == pytest.approx(GRIDS[window][i, j], abs=1e-9)


@pytest.mark.parametrize(("i", "j"), [(0, 0), (1, 1), (3, 89), (120, 90), (0, 90)])
def test_spliced_frames_stand_in_a_row(i, j):
    middle = A[5:7]
    spliced = splice(A, i, middle, B, j)
    for field in ("root_positions", "rotations"):
        parts = getattr(A, field)[:i], getattr(middle, field), getattr(B, field)[j:]
        assert np.array_equal(getattr(spliced, field), np.concatenate(parts))
    assert spliced.name == "a to b"
