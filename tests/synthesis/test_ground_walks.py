"""Walks on the ground lie where the motions made of them go."""

import numpy as np
import pytest

from mocap import synthesis
from mocap.body.planar import on_ground
from mocap.synthesis.ground_walks import GroundWalks
from tests.bundled import bundled


@pytest.fixture(scope="module")
def graph():
    return bundled("walk_circle", "walk_curve_1")


def test_a_walk_goes_where_its_motion_goes(graph):
    walk, walks = synthesis.random_walk(graph, seconds=10, seed=3), GroundWalks(graph)
    number = walks.graph.nodes.index(walk[0][0])
    _, start = walks.start(number)
    found, wanted = walks.points(walk, start), on_ground(synthesis.to_motion(graph, walk).root_positions)
    assert len(found) == len(wanted)
    turn = (found[-1] - found[0]) / (wanted[-1] - wanted[0])
    assert abs(turn) == pytest.approx(1)
    assert found == pytest.approx(found[0] + turn * (wanted - wanted[0]))


def test_it_starts_at_the_origin_and_straight_ahead(graph):
    walks = GroundWalks(graph)
    for number in (0, 40, 300):
        node, start = walks.start(number)
        edge = min(walks.graph.source.graph.out_edges(node, keys=True))
        points, after = walks.step(start, edge)
        assert abs(points[0]) < 0.1
        assert after.frames == len(points)
        assert start.turn * walks.graph.at[number] + start.move == pytest.approx(0)
        assert np.angle(start.turn * np.exp(1j * walks.graph.going[number])) == pytest.approx(0)


def test_a_problem_asks_its_price_for_every_edge_and_ends_after_so_many_frames(graph):
    walks, asked = GroundWalks(graph), []

    def price(points, before, edge):
        asked.append((len(points), before, edge))
        return 1.0

    problem = walks.problem(price, frames=30)
    node, start = walks.start(5)
    found = synthesis.branch_and_bound(problem, node, start)
    assert found.cost == len(found.walk)
    assert found.complete
    frames = graph.graph.edges
    assert found.state.frames == sum(frames[edge]["frames"] for edge in found.walk) >= 30
    assert all(count == frames[edge]["frames"] for count, _, edge in asked)
    assert {before for _, before, _ in asked} >= {0}
    assert not problem.done(start)
