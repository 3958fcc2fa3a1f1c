"""The tree of a search holds every walk once, and its picture shows what the search did."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.errors import MocapError
from mocap.plotting.search_tree import TreePicture, grow_tree
from mocap.synthesis.bounded_search import Problem, branch_and_bound
from tests.strategies import seeds
from tests.synthesis.test_bounded_search import every_walk, problem_on, random_graph


@given(seeds, st.integers(1, 5))
def test_the_tree_holds_every_walk_and_where_the_search_went(seed, length):
    problem = problem_on(random_graph(seed), length)
    tree, found = grow_tree(problem, 0, ()), branch_and_bound(problem, 0, ())
    walks = {tuple(walk): cost for cost, walk in every_walk(problem, 0)}
    assert {tree.state[t]: tree.cost[t] for t in np.flatnonzero(tree.complete)} == pytest.approx(walks)
    met = np.isfinite(tree.known)
    assert sorted(tree.known[met & ~tree.complete]) == list(range(1, tree.expanded + 1))
    best = tree.best(tree.expanded)
    assert tree.cost[best] == pytest.approx(found.cost)
    assert tree.state[best] == found.state
    assert tree.cut(tree.expanded).sum() == found.cut
    assert tree.expanded == found.expanded


def test_the_bound_falls_and_cuts_as_the_search_goes_on():
    tree = grow_tree(problem_on(random_graph(3), 5), 0, ())
    bests = [tree.best(n) for n in range(tree.expanded + 1)]
    bounds = [tree.cost[best] if best >= 0 else np.inf for best in bests]
    assert bests[0] == -1
    assert bounds == sorted(bounds, reverse=True)
    assert not tree.cut(0).any()
    for expanded, bound in enumerate(bounds):
        assert (tree.cost[tree.cut(expanded)] >= bound).all()


def test_a_horizon_ends_walks_in_the_tree_too():
    problem = problem_on(random_graph(1), 99)
    tree, found = (f(problem, 0, (), horizon=5) for f in (grow_tree, branch_and_bound))
    assert (tree.frames[tree.complete] >= 5).all()
    assert tree.cost[tree.best(tree.expanded)] == pytest.approx(found.cost)


def test_a_tree_too_large_to_draw_is_refused():
    graph = nx.MultiDiGraph([(1, 1)] * 4)
    nx.set_edge_attributes(graph, 1, "frames")
    with pytest.raises(MocapError, match=r"more than 20000 walks: look less far"):
        grow_tree(Problem(graph, lambda s, e: (0.0, s), lambda s: False), 1, None, horizon=9)


def test_the_picture_shows_each_branch_once():
    tree = grow_tree(problem_on(random_graph(2), 5), 0, ())
    picture = TreePicture(tree)
    for count in (0, 1, tree.expanded // 2, tree.expanded):
        pending, cut, expanded, best, crosses, rings = picture.after(count)
        counts = [len(part.get_segments()) for part in (expanded, cut, pending, best)]
        found = int((tree.complete & (tree.known <= count)).sum())
        assert counts[0] == max(0, count - 1) + found
        assert counts[1] == len(crosses.get_xdata()) == tree.cut(count).sum()
        assert counts[2] == len(rings.get_xdata())
        assert (counts[3] > 0) == (tree.best(count) >= 0)
    assert counts[2] == 0
    assert picture.after() == [pending, cut, expanded, best, crosses, rings]
    ends = picture.places[tree.complete]
    assert len(np.unique(ends[:, 0])) == len(ends)  # each has its own column
