"""Routes give their points where they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.steering.path_objective import Route
from tests.strategies import seeds


@given(seeds, st.integers(2, 20))
def test_points_are_met_and_lines_join_them(seed, count):
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 2)) @ [1, 1j]
    route = Route(points, 0.1, np.full(count, -1), np.full(count, np.nan))
    along = np.linspace(-1, route.length + 1, 50)
    places = np.arange(count) * 0.1
    expected = np.interp(along, places, points.real) + 1j * np.interp(along, places, points.imag)
    assert route.at(along) == pytest.approx(expected)
    assert route.near(places + 0.05) == pytest.approx(points)
    assert np.abs(route.ways) == pytest.approx(np.ones(count))
    assert route.bare
