"""The search in layers: as good as trying everything where nothing is cut, and honest when stopped."""

import numpy as np
import pytest

from mocap.body.ground_path import GroundPath, s_curve
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.motion_graph import from_transitions
from mocap.steering import beam_search, search_states
from mocap.steering.beam_search import Beam, find_walk
from mocap.steering.paper_search import PathCost, PathState
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Prices, Wishes, make_route
from mocap.steering.search_states import expand, start_states
from mocap.synthesis.bounded_search import Problem, branch_and_bound
from tests.bundled import walking
from tests.strategies import wave

GRAPH = walking()


def test_without_cuts_and_prices_it_finds_what_branch_and_bound_finds(monkeypatch):
    """The paper's search is the oracle; sliding along the path, which it does not know, is turned off."""
    monkeypatch.setattr(search_states, "slide", lambda space, states, most: 0.0)
    path = GroundPath([[0, 0], [0.1, 0.45], [0.3, 0.75]])
    route = make_route(GRAPH, path, Wishes())
    for node in (3, 200, 500):
        start = start_states(GRAPH, np.array([node]), 0j, 0.2)
        beam = Beam(width=10**6, place=1e-6, turn=1e-6, rescue=0.0)
        found = find_walk(GRAPH, route, start, beam, Prices(seam=0.0, match=0.0, stray=0.0))
        cost = PathCost(GRAPH, route)
        state = PathState(complex(start.turn[0]), complex(start.move[0]), 0.0)
        best = branch_and_bound(Problem(GRAPH.source.graph, cost.cost, cost.done), GRAPH.nodes[node], state)
        # A hop may ride on past the end of the path, to which the paper's walk stops: never for less.
        assert found.cost >= best.cost - 1e-12
        walked, state = 0.0, PathState(complex(start.turn[0]), complex(start.move[0]), 0.0)
        for edge in found.edges:
            if cost.done(state):
                break
            more, state = cost.cost(state, GRAPH.edges[edge])
            walked += more
        assert walked <= 1.2 * best.cost + 1e-3


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_a_wider_beam_costs_more_and_follows_better():
    narrow, wide = (follow_path(GRAPH, s_curve(15), beam=Beam(width=width)) for width in (3, 100))
    assert wide.found.cost < narrow.found.cost
    assert wide.found.expanded > 10 * narrow.found.expanded
    assert wide.found.cut > 0


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_the_work_is_linear_in_the_length():
    prices = Prices()
    walks = [follow_path(GRAPH, s_curve(length), prices=prices, tries=1) for length in (10, 40)]
    short, long = (walk.found.expanded for walk in walks)
    assert 3 < long / short < 5


def test_the_cost_is_what_the_walk_is_off():
    followed = follow_path(
        GRAPH, GroundPath([[0, 0], [0, 6]]), prices=Prices(seam=0.0, match=0.0, stray=0.0), tries=1
    )
    assert followed.found.cost >= (followed.off**2).sum() - 1e-9


def test_it_tells_how_far_it_has_come():
    seen = []

    def progress(layers):
        for layer in layers:
            seen.append((layer, len(layers)))
            yield layer

    path = GroundPath([[0, 0], [0, 6]])
    follow_path(GRAPH, path, beam=Beam(progress=progress, layer=0.25), tries=1)
    assert seen == [(layer, 25) for layer in range(25)]


def test_out_of_time_it_gives_the_best_so_far_and_says_so():
    followed = follow_path(GRAPH, s_curve(200), beam=Beam(seconds=0.3))
    assert followed.found.stopped == "out of time"
    assert 0 < followed.progress < 1
    assert followed.report().endswith("out of time: the best so far")
    with pytest.raises(NoWalk, match="out of time before its first step"):
        follow_path(GRAPH, s_curve(), beam=Beam(seconds=-1))


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_an_interruption_gives_the_best_walk_so_far(monkeypatch):
    rounds = iter(range(40))

    def interrupted(*args):
        if next(rounds, None) is None:
            raise KeyboardInterrupt
        return expand(*args)

    monkeypatch.setattr(beam_search, "expand", interrupted)
    followed = follow_path(GRAPH, s_curve())
    assert followed.found.stopped == "interrupted"
    assert 0.05 < followed.progress < 0.9
    assert followed.off.mean() < 0.1


def test_a_graph_that_ends_is_told():
    line = compile_graph(from_transitions([wave(120)], [], window=8))
    with pytest.raises(NoWalk, match=r"Every walk ends after 2\.. m of the path: prune"):
        follow_path(line, GroundPath([[0, 0], [0, 50]]))
