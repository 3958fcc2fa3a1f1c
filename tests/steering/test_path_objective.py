"""Routes give their points where they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.ground_path import GroundPath
from mocap.steering.path_objective import Route, Wishes, make_route
from tests.bundled import walking
from tests.refusals import refused
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
    assert points[route.point(places + 0.05)] == pytest.approx(points)
    assert np.abs(route.ways) == pytest.approx(np.ones(count))
    assert route.bare


def test_a_path_may_be_as_long_as_the_clips_walk_in_an_hour():
    graph = walking()
    speeds = graph.step[graph.first[~graph.blended]] * graph.fps
    make_route(graph, GroundPath([[0, 0], [0, 3600 * speeds.mean()]]), Wishes())
    refused("more than an hour", make_route, graph, GroundPath([[0, 0], [0, 3600 * speeds.max()]]), Wishes())
