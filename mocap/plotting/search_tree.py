"""A search seen as a tree: every walk it might have tried, where it went, and what its bound cut away."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices, Mask
from mocap.errors import MocapError
from mocap.plotting.style import COLOURS, PATH, QUIET
from mocap.synthesis.bounded_search import Problem, SearchEdge, State, branch_and_bound

MOST_BRANCHES = 20_000
UNSEEN = "#CCCCCC"


class SearchTree(NamedTuple):
    """All T walks up to a horizon, the empty one first, each after the one that it goes on from.

    Parameters
    ----------
    parent : shape (T,), the walk that each goes on from; -1 for the first.
    edge : the last edge of each.
    state : what the problem knows of each.
    frames, cost : shape (T,), how long each is, and its f.
    complete : shape (T,), whether the halting rule or the horizon ends it.
    visit : shape (T,), when the search came to it, counted from 0; T where it never did.
    """

    parent: Indices
    edge: list[SearchEdge | None]
    state: list[State]
    frames: Indices
    cost: Array
    complete: Mask
    visit: Indices

    @property
    def visits(self) -> int:
        """How many of the walks the search came to."""
        return int((self.visit < len(self.visit)).sum())

    def best(self, visits: int) -> int:
        """Find the best complete walk among the first so many visited; -1 before there is one."""
        cost = np.where(self.complete & (self.visit < visits), self.cost, np.inf)
        return int(cost.argmin()) if np.isfinite(cost).any() else -1

    def cut(self, visits: int) -> Mask:
        """Mark the branches that the bound cuts off after so many visits: what lies beyond goes unseen."""
        best = self.best(visits)
        bound = self.cost[best] if best >= 0 else np.inf
        met = self.visit < visits
        return np.asarray(met[self.parent] & (self.parent >= 0) & ~met & (self.cost >= bound))

    def line(self, walk: int) -> list[int]:
        """List a walk and all it goes on from, the empty one first."""
        line = [walk]
        while (walk := int(self.parent[walk])) >= 0:
            line.append(walk)
        return line[::-1]


def grow_tree(problem: Problem, node: Hashable, state: State, *, horizon: float = math.inf) -> SearchTree:
    """Try every walk, and note which of them `synthesis.branch_and_bound` comes to, and when.

    Parameters
    ----------
    problem, node, state, horizon : as there.

    Raises
    ------
    MocapError : for more than 20 000 walks, which no picture shows.
    NoWalk : as there.

    Examples
    --------
    >>> import networkx as nx
    >>> graph = nx.MultiDiGraph([(1, 1), (1, 1)])
    >>> nx.set_edge_attributes(graph, 1, "frames")
    >>> dear = Problem(graph, lambda _, edge: (edge[2], None), lambda _: False)  # g is the edge's key
    >>> tree = grow_tree(dear, 1, None, horizon=3)
    >>> len(tree.cost), tree.visits
    (15, 4)

    Notebook: 07-walks-and-search
    """
    visit: dict[tuple[SearchEdge, ...], int] = {}

    def done(told: tuple[State, tuple[SearchEdge, ...]]) -> bool:
        visit.setdefault(told[1], len(visit))  # the search asks this of every walk that it comes to
        return problem.done(told[0])

    def step(told: tuple[State, tuple[SearchEdge, ...]], edge: SearchEdge) -> tuple[float, State]:
        cost, after = problem.step(told[0], edge)
        return cost, (after, (*told[1], edge))

    watched = Problem(problem.graph, step, done)
    found = _every_walk(watched, node, (state, ()), horizon)
    visit.clear()
    branch_and_bound(watched, node, (state, ()), horizon=horizon)
    parent, told, frames, cost, complete = zip(*found, strict=True)
    states, walks = zip(*told, strict=True)
    return SearchTree(
        np.array(parent),
        [walk[-1] if walk else None for walk in walks],
        list(states),
        np.array(frames),
        np.array(cost, float),
        np.array(complete),
        np.array([visit.get(walk, len(walks)) for walk in walks]),
    )


def _every_walk(
    problem: Problem, node: Hashable, state: State, horizon: float
) -> list[tuple[int, State, int, float, bool]]:
    """Grow all walks without a bound, depth first, the cheapest first: parent, state, frames, f, complete."""
    waiting: list[tuple[int, Hashable, State, int, float]] = [(-1, node, state, 0, 0.0)]
    found: list[tuple[int, State, int, float, bool]] = []
    while waiting:
        parent, node, state, frames, cost = waiting.pop()
        complete = problem.done(state) or frames >= horizon
        found.append((parent, state, frames, cost, complete))
        if len(found) > MOST_BRANCHES:
            raise MocapError(f"There are more than {MOST_BRANCHES} walks: look less far ahead.")
        if complete:
            continue
        children = []
        for start, end, key, more in problem.graph.out_edges(node, keys=True, data="frames"):
            added, after = problem.step(state, (start, end, key))
            children.append((len(found) - 1, end, after, frames + more, cost + added))
        waiting += sorted(children, key=lambda child: child[-1], reverse=True)
    return found


class TreePicture:
    """A search's tree, its root at the top: thin grey what no one looked at, blue what was visited.

    A red cross ends a branch that the bound cut, a ring one that waits; the best walk so far is orange.

    Parameters
    ----------
    tree : from `grow_tree`.
    places : shape (T, 2), where to draw the walks' ends; by default spread out, and down by their frames.
    ax : axes; new ones by default.
    """

    def __init__(self, tree: SearchTree, *, places: ArrayLike | None = None, ax: Axes | None = None) -> None:
        self.tree = tree
        self.ax = ax or plt.figure(figsize=(9, 3.6), layout="constrained").add_subplot()
        self.places = _spread(tree) if places is None else np.asarray(places, float)
        self.ax.add_collection(self._bundle(np.arange(1, len(tree.parent)), UNSEEN, 0.7))
        self.visited = self._bundle([], COLOURS["left"], 1.4)
        self.pending = self._bundle([], QUIET, 0.9)
        self.cut = self._bundle([], COLOURS["right"], 0.9)
        self.best = self._bundle([], PATH, 3.0)
        (self.crosses,) = self.ax.plot([], [], "x", color=COLOURS["right"], markersize=4.5)
        (self.rings,) = self.ax.plot([], [], "o", color=QUIET, mfc="white", markersize=4)
        for bundle in (self.pending, self.cut, self.visited, self.best):
            self.ax.add_collection(bundle)
        self.ax.autoscale_view()
        if places is None:
            self.ax.invert_yaxis()
            self.ax.set(xticks=[], ylabel="frames ahead")
            self.ax.spines[["top", "right", "bottom"]].set_visible(False)

    def after(self, visits: int | None = None) -> list[Artist]:
        """Show the search after so many visits, by default at its end, and give the artists that moved."""
        tree, visits = self.tree, self.tree.visits if visits is None else visits
        met, cut, best = tree.visit < visits, tree.cut(visits), tree.best(visits)
        pending = met[tree.parent] & (tree.parent >= 0) & ~met & ~cut
        self.visited.set_segments(self._lines(np.flatnonzero(met & (tree.parent >= 0))))
        self.cut.set_segments(self._lines(np.flatnonzero(cut)))
        self.pending.set_segments(self._lines(np.flatnonzero(pending)))
        self.best.set_segments(self._lines(tree.line(best)[1:] if best >= 0 else []))
        self.crosses.set_data(*self.places[cut].T)
        self.rings.set_data(*self.places[pending].T)
        return [self.pending, self.cut, self.visited, self.best, self.crosses, self.rings]

    def _lines(self, walks: ArrayLike) -> list[Array]:
        """Draw each of some walks' last edges as a line between two places."""
        ends = np.asarray(walks, int)
        return list(np.stack([self.places[self.tree.parent[ends]], self.places[ends]], axis=1))

    def _bundle(self, walks: ArrayLike, colour: str, width: float) -> LineCollection:
        return LineCollection(self._lines(walks), colors=colour, linewidths=width, capstyle="round")


def _spread(tree: SearchTree) -> Array:
    """Give each leaf a column of its own, and each other walk the middle of those that go on from it."""
    columns = np.full((len(tree.parent), 2), [np.inf, -np.inf])  # the first and the last below each walk
    leaf = np.ones(len(tree.parent), bool)
    leaf[tree.parent[1:]] = False
    columns[leaf] = np.arange(leaf.sum())[:, None]
    for walk in range(len(columns) - 1, 0, -1):
        above, below = columns[tree.parent[walk]], columns[walk]
        above[:] = min(above[0], below[0]), max(above[1], below[1])
    return np.stack([columns.mean(axis=1), tree.frames], axis=1)
