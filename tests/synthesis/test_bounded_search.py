"""Branch and bound finds what trying everything finds, and says what it did."""

import math

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap import synthesis
from mocap._shared import deadlines
from mocap.body.planar import on_ground
from mocap.errors import NoWalk
from mocap.synthesis import Problem, branch_and_bound, search_ahead
from mocap.synthesis.ground_walks import GroundWalks
from tests.bundled import bundled
from tests.refusals import refusals
from tests.strategies import seeds


def random_graph(seed, nodes=5, edges=11):
    """Return a small graph, strongly connected by a ring, with random lengths and costs."""
    random = np.random.default_rng(seed)
    graph = nx.MultiDiGraph()
    ends = [(n, (n + 1) % nodes) for n in range(nodes)]
    ends += [tuple(random.integers(nodes, size=2).tolist()) for _ in range(edges - nodes)]
    for start, end in ends:
        graph.add_edge(start, end, frames=int(random.integers(1, 4)), cost=float(random.random()))
    return graph


def problem_on(graph, length=7):
    """Return a problem whose g depends on the whole walk: an edge taken before costs double."""

    def step(walk, edge):
        cost = graph.edges[edge]["cost"] * (2 if edge in walk else 1)
        return cost, (*walk, edge)

    return Problem(graph, step, lambda walk: len(walk) >= length)


def every_walk(problem, node, walk=(), cost=0.0):
    """Give all complete walks with their costs: the oracle."""
    if problem.done(walk):
        yield cost, list(walk)
        return
    for edge in problem.graph.out_edges(node, keys=True):
        more, longer = problem.step(walk, edge)
        yield from every_walk(problem, edge[1], longer, cost + more)


@given(seeds, st.integers(1, 6))
def test_it_finds_the_best_of_all_walks(seed, length):
    """As in [KGP02, Eq. 8]."""
    problem = problem_on(random_graph(seed), length)
    found = branch_and_bound(problem, 0, ())
    costs = [cost for cost, _ in every_walk(problem, 0)]
    assert found.cost == pytest.approx(min(costs))
    assert found.complete
    assert found.stopped == ""
    assert math.isclose(sum(problem.step(found.walk[:i], e)[0] for i, e in enumerate(found.walk)), found.cost)


@given(seeds, st.integers(3, 8))
def test_it_finds_the_best_walk_within_the_horizon(seed, horizon):
    graph = random_graph(seed)
    frames = nx.get_edge_attributes(graph, "frames")
    problem = problem_on(graph, length=99)
    capped = Problem(graph, problem.step, lambda walk: sum(frames[e] for e in walk) >= horizon)
    found = branch_and_bound(problem, 0, (), horizon=horizon)
    assert found.cost == pytest.approx(min(cost for cost, _ in every_walk(capped, 0)))


def test_the_bound_saves_work_and_says_how_much():
    problem = problem_on(random_graph(1, edges=16), 8)
    found = branch_and_bound(problem, 0, ())
    everything = sum(1 for _ in every_walk(problem, 0))
    assert found.cut > 0 and found.expanded < everything / 3


def test_a_budget_gives_the_best_so_far_and_says_so():
    problem = problem_on(random_graph(2, edges=16), 9)
    best = branch_and_bound(problem, 0, ())
    for nodes in (20, 0):
        found = branch_and_bound(problem, 0, (), budget=nodes)
        assert found.stopped == "out of nodes" and found.expanded <= nodes
        assert found.cost >= best.cost or not found.complete
    assert branch_and_bound(problem, 0, (), budget=20).complete


@given(seeds)
def test_the_cheapest_edge_is_tried_first(seed):
    """As in [KGP02, order]: with a budget of one walk for each edge, the greedy walk is found."""
    problem, node, greedy = problem_on(random_graph(seed), 6), 0, ()
    while not problem.done(greedy):
        edges = problem.graph.out_edges(node, keys=True)
        greedy += (min(edges, key=lambda edge, walk=greedy: problem.step(walk, edge)[0]),)
        node = greedy[-1][1]
    assert branch_and_bound(problem, 0, (), budget=6).walk == list(greedy)


def test_an_interruption_gives_the_best_so_far():
    problem, calls = problem_on(random_graph(2, edges=16), 9), iter(range(60))

    def step(walk, edge):
        if next(calls, None) is None:
            raise KeyboardInterrupt
        return problem.step(walk, edge)

    found = branch_and_bound(Problem(problem.graph, step, problem.done), 0, ())
    assert found.stopped == "interrupted"
    assert found.complete
    assert len(found.walk) == 9


@pytest.mark.parametrize("seconds", [1, 9, 40])
def test_a_deadline_gives_what_a_budget_of_as_many_walks_gives(monkeypatch, seconds):
    """The clock goes on by a second whenever a walk is about to be expanded."""
    clock = iter(range(10**6))
    monkeypatch.setattr(deadlines, "monotonic", lambda: float(next(clock)))
    problem = problem_on(random_graph(2, edges=16), 9)
    limited = branch_and_bound(problem, 0, (), deadline=seconds)
    expected = branch_and_bound(problem, 0, (), budget=seconds - 1)
    assert limited.stopped == "out of time" and expected.stopped == "out of nodes"
    assert limited[:-1] == expected[:-1]


def test_a_deadline_is_for_all_stretches_together(monkeypatch):
    clock = iter(range(10**6))
    monkeypatch.setattr(deadlines, "monotonic", lambda: float(next(clock)))
    problem = problem_on(random_graph(2), 12)
    whole = search_ahead(problem, 0, (), look=(8, 3))
    limited = search_ahead(problem, 0, (), look=(8, 3), deadline=whole.expanded // 2)
    assert limited.stopped == "out of time" and not limited.complete
    assert limited.expanded == whole.expanded // 2 - 1
    assert 0 < len(limited.walk) < len(whole.walk)
    assert search_ahead(problem, 0, (), look=(8, 3), deadline=10**6) == whole


@given(seeds)
def test_stretch_by_stretch_it_comes_to_the_end(seed):
    problem = problem_on(random_graph(seed), 12)
    found = search_ahead(problem, 0, (), look=(8, 3))
    assert found.complete and len(found.walk) == 12
    assert all(a[1] == b[0] for a, b in zip(found.walk, found.walk[1:], strict=False))
    costs = [problem.step(tuple(found.walk[:i]), edge)[0] for i, edge in enumerate(found.walk)]
    assert found.cost == pytest.approx(sum(costs))


PROBLEM = problem_on(random_graph(0))
BELOW_0 = Problem(PROBLEM.graph, lambda walk, edge: (-1.0, walk), lambda walk: False)

test_what_cannot_be_searched_is_told = refusals(
    (NoWalk, "no node 77", branch_and_bound, PROBLEM, 77, ()),
    ("some must be kept", lambda: search_ahead(PROBLEM, 0, (), look=(5, 9))),
    ("0 or more, got -1", branch_and_bound, BELOW_0, 0, ()),
    (NoWalk, "ends too early", lambda: branch_and_bound(problem_on(line_of(1), 3), 0, ())),
)


def line_of(edges):
    """Return a graph without a choice."""
    graph = nx.MultiDiGraph()
    graph.add_edges_from([(n, n + 1) for n in range(edges)], frames=1, cost=1.0)
    return graph


@pytest.mark.parametrize(("keep", "expanded"), [(1, 3 + 3 + 3 + 3 + 2 + 1), (2, 3 + 3 + 2), (3, 3 + 3)])
def test_each_stretch_looks_ahead_and_keeps_as_much_as_asked(keep, expanded):
    """Six edges without a choice: each stretch looks three frames ahead, or to the end.

    As in [KGP02, 4.2].
    """
    found = search_ahead(problem_on(line_of(6), 6), 0, (), look=(3, keep))
    assert (found.expanded, found.cut, found.cost, found.complete) == (expanded, 0, 6.0, True)


def test_a_stretch_that_ran_out_early_is_kept_as_far_as_it_goes():
    found = search_ahead(problem_on(line_of(6), 6), 0, (), look=(99, 99), budget=2)
    assert found.stopped == "out of nodes"
    assert (len(found.walk), found.complete, found.expanded) == (6, True, 6)


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
        _, points, after = walks.step(start, edge)
        assert abs(points[0]) < 0.1
        assert after.frames == len(points)
        assert start.rotation * walks.graph.at[number] + start.translation == pytest.approx(0)
        assert np.angle(start.rotation * np.exp(1j * walks.graph.going[number])) == pytest.approx(0)


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
