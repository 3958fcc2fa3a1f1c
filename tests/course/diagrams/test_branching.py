"""What diagrams compute, and what they refuse; test_drawn.py holds what they draw."""

from itertools import pairwise, product

import networkx as nx
import numpy as np
import pytest

from mocap import graphs
from mocap.body import GroundPath
from mocap.course import diagrams
from mocap.course.diagrams import edge_lengths, search_events, tarjan_states
from mocap.course.diagrams.ground import nearest_points
from mocap.course.diagrams.layers import STRIDE, TURNS, Steps, layer_states, lengthened
from tests.refusals import refusals

EIGHT = graphs.notes_example()
LENGTHS = edge_lengths(EIGHT)


@pytest.mark.parametrize("seed", range(10))
def test_the_last_state_holds_the_strongly_connected_components(seed):
    graph = nx.gnp_random_graph(9, 0.15, seed=seed, directed=True)
    last = tarjan_states({node: list(graph[node]) for node in graph})[-1]
    expected = set(map(frozenset, nx.strongly_connected_components(graph)))
    assert set(map(frozenset, last.components)) == expected
    assert last.stack == []


def test_the_search_finds_the_walk_of_the_notes():
    events = search_events(LENGTHS, 6, 2, longest=8)
    (found,) = [event for event in events if event.fate == "complete"]
    assert found.walk == (6, 7, 8, 3, 1, 2)
    assert found.cost == pytest.approx(sum(LENGTHS[a][b] for a, b in pairwise(found.walk)))
    taken = [event.walk for event in events]
    assert taken.index((6, 7, 8, 3, 4)) < taken.index((6, 7, 8, 3, 1))  # into the sink first
    assert len(max(taken, key=len)) == 9


@pytest.mark.parametrize("seed", range(8))
def test_it_finds_what_an_exhaustive_search_finds(seed):
    rng = np.random.default_rng(seed)
    lengths = {
        a: {int(b): float(rng.uniform(0.1, 1)) for b in rng.choice(6, 2, replace=False)} for a in range(6)
    }
    events = search_events(lengths, 0, 5, longest=5)
    whole = nx.DiGraph([(a, b, {"weight": w}) for a, row in lengths.items() for b, w in row.items()])
    complete = [event.cost for event in events if event.fate == "complete"]
    if 5 in whole and nx.has_path(whole, 0, 5):
        assert min(complete) == pytest.approx(nx.shortest_path_length(whole, 0, 5, weight="weight"))
    else:
        assert not complete
    assert complete == sorted(complete, reverse=True)


LINE = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(STRIDE * np.arange(8)) @ [1j, 1]


def every_walk(line, count):
    for turns in product(TURNS, repeat=count):
        walk = Steps((0j,), 0.0, 0.0)
        for turn in turns:
            walk = lengthened(walk, turn, line)
        yield walk


@pytest.mark.parametrize("seed", range(5))
def test_a_beam_that_holds_all_walks_finds_the_best_of_all(seed):
    line = np.cumsum(0.7 * np.exp(1j * np.random.default_rng(seed).normal(size=6).cumsum()))
    best = min(walk.cost for walk in every_walk(line, 4))
    for look in (False, True):
        assert [*layer_states(line, 4, width=99, look=look)][-1].best.cost == pytest.approx(best)


def test_the_look_ahead_needs_a_narrower_beam():
    def narrowest(look):
        costs = [[*layer_states(LINE, 5, width=width, look=look)][-1].best.cost for width in range(1, 10)]
        return 1 + costs.index(min(costs))

    assert (narrowest(True), narrowest(False)) == (2, 6)


def test_of_walks_that_stand_alike_the_best_stays_and_no_more_than_the_beam_go_on():
    for state in layer_states(LINE, 5, width=4):
        ends = [(np.round(walk.places[-1], 6), round(walk.heading, 6)) for walk in state.kept]
        if state.line in (5, 6):
            assert len(set(ends)) == len(ends)
            assert all(
                any(
                    abs(walk.places[-1] - other.places[-1]) < 1e-6 and state.score[other] <= state.score[walk]
                    for other in state.kept
                )
                for walk in (state.crossed if state.line == 5 else ())
            )
        assert state.line != 6 or len(state.kept) <= 4


test_windows_that_do_not_fit_are_refused = refusals(
    (
        r"Windows of 4 frames do not fit into an array of shape \(3, 3\)",
        lambda: diagrams.diagonal_sums(np.ones((3, 3)), window=4, step=1),
    )
)


def test_the_nearest_point_is_the_nearest():
    corner, points = GroundPath([[0, 0], [0, 3], [3, 3]]), np.random.default_rng(0).uniform(-1, 4, (50, 2))
    found = np.hypot(*(points - nearest_points(corner, points)).T)
    truth = np.hypot(*(points[:, None] - corner.resampled(0.001).points).transpose(2, 0, 1)).min(axis=1)
    assert found == pytest.approx(truth, abs=0.005)
