"""Paths have the lengths that geometry says, and refuse what is none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import GroundPath, arcs, ground_path, spline
from tests.refusals import refusals
from tests.strategies import seeds


@given(seeds, st.integers(2, 30))
def test_points_lie_where_their_length_says(seed, count):
    path = GroundPath(np.random.default_rng(seed).normal(size=(count, 2)))
    assert path.at(path.along) == pytest.approx(path.points)
    assert path.at([-1, path.length + 1]) == pytest.approx(path.points[[0, -1]])
    fine = path.resampled(0.05)
    steps = np.hypot(*np.diff(fine.points, axis=0).T)
    assert steps.max() <= 0.05 + 1e-9
    assert fine.length <= path.length + 1e-9


@pytest.mark.parametrize(
    ("name", "length"), [("circle", 6 * np.pi), ("S-curve", 20), ("square", 12 + 3 * np.pi)]
)
def test_shapes_are_as_long_as_they_must_be(name, length):
    assert ground_path.SHAPES[name]().length == pytest.approx(length, rel=1e-3)


@pytest.mark.parametrize("name", ["circle", "square", "figure of eight"])
def test_closed_shapes_close(name):
    points = ground_path.SHAPES[name]().points
    assert points[-1] == pytest.approx(points[0], abs=0.01)


def test_positive_turns_go_left():
    """Left of a body that faces +z is +x."""
    assert arcs((0, 0), 0.0, [(np.pi, np.pi / 2)]).points[-1] == pytest.approx([2, 2], abs=0.01)


@given(seeds)
def test_a_spline_passes_its_points_smoothly(seed):
    points = np.random.default_rng(seed).normal(size=(6, 2)) * 3
    curve = spline(points)
    for point in points:
        assert np.hypot(*(curve.points - point).T).min() < 0.03


def test_points_that_repeat_count_once():
    points = [[0, 0], [0, 0], [0, 3], [1e-12, 3], [4, 3]]
    assert GroundPath(points).points.tolist() == [[0, 0], [0, 3], [4, 3]]


test_what_is_no_path_is_refused = refusals(
    *(("two points", GroundPath, points) for points in ([[1, 2]], [1, 2, 3], [[0, 0, 0], [1, 1, 1]])),
    ("zero length", GroundPath, [[1, 2], [1, 2]]),
    ("Point 1 of the path is not finite", GroundPath, [[0, 0], [1, np.nan], [2, 2]]),
    ("metres", GroundPath, [[0, 0], [1e9, 0]]),
)


@pytest.mark.parametrize("angle", [2.085495351331207, *np.linspace(0, 6, 20)])
def test_a_path_that_is_turned_takes_as_many_pieces(angle):
    """Turned, 12 m are 12.000000000000002 m: one piece more, and no point would lie at the corner."""
    turn = np.exp(1j * angle)
    corner = np.array([[0, 0], [0, 6], [6 * np.sin(1.9), 6 + 6 * np.cos(1.9)]])
    turned = turn * (corner[:, 1] + 1j * corner[:, 0])
    path = GroundPath(np.stack([turned.imag, turned.real], axis=1)).resampled(0.05)
    assert len(path.points) == 241
    np.testing.assert_allclose(path.points[120], [turned[1].imag, turned[1].real], atol=1e-9)
