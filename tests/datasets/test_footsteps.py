"""The ways that feet are planted along; `test_generated` holds where they stand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from walking.footsteps import smooth_path, winding

from tests.strategies import seeds


def test_a_winding_path_turns_as_its_stretches_say():
    points = winding([(2.0, 0), (3.0, 180), (2.0, 0)])
    assert points[0].tolist() == [0, 0]
    assert np.linalg.norm(np.diff(points, axis=0), axis=-1) == pytest.approx(0.05)
    assert points[-1, 0] == pytest.approx(2 * 3.0 / np.pi, abs=0.1)  # back beside the start, to its left
    assert points[-1, 1] == pytest.approx(0, abs=0.1)


def test_a_smooth_path_on_a_circle_is_as_long_and_turns_as_much():
    angle = np.linspace(0, np.pi, 60)
    path = smooth_path(2 * np.stack([1 - np.cos(angle), np.sin(angle)], axis=-1))
    along = np.linspace(0, path.length, 200)
    assert path.length == pytest.approx(2 * np.pi, rel=1e-3)
    assert np.ptp(path.heading(along)) == pytest.approx(np.pi, rel=0.02)
    assert np.ptp(np.linalg.norm(np.diff(path.at(along), axis=0), axis=-1)) < 1e-4


@given(st.floats(-5, 15))
def test_a_straight_smooth_path_goes_straight_on_past_its_ends(along):
    path, along = smooth_path([[1, 0], [1, 4], [1, 10]]), np.array([along])
    assert path.at(along)[0] == pytest.approx([1, along[0]], abs=1e-9)
    assert path.heading(along) == pytest.approx(0, abs=1e-9)


@given(seeds)
def test_a_smooth_path_passes_its_points_and_its_heading_is_its_direction(seed):
    """Bends of up to 0.6 radians, a metre apart."""
    bends = np.cumsum(np.random.default_rng(seed).uniform(-0.6, 0.6, 9))
    points = np.cumsum(np.stack([np.sin(bends), np.cos(bends)], axis=1), axis=0)
    path = smooth_path(points)
    along = np.linspace(0, path.length, 1000)
    for point in points:
        assert np.hypot(*(path.at(along) - point).T).min() < 0.01
    step = path.at(along + 1e-5) - path.at(along - 1e-5)
    assert np.hypot(*step.T) / 2e-5 == pytest.approx(1, abs=0.01)
    directions = np.arctan2(*step.T) - path.heading(along)
    assert np.cos(directions) == pytest.approx(1, abs=1e-6)
