"""A search as a tree: every walk that it could try, those that it expanded, those that its bound cut off.

To expand a walk is to lengthen it by every edge that leaves its last node.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices, Mask
from mocap.errors import MocapError
from mocap.plotting.style import CURVES, PATH, QUIET
from mocap.synthesis.bounded_search import Problem, SearchEdge, State, branch_and_bound

Watched = tuple[State, tuple[SearchEdge, ...]]  # a problem's state, and the walk that leads to it

MOST_BRANCHES = 20_000
UNSEEN = "#CCCCCC"


class SearchTree(NamedTuple):
    """All T walks up to a horizon, the empty walk first, each walk after its parent.

    Parameters
    ----------
    parent : shape (T,), the walk without its last edge; -1 for the empty walk.
    edge : the last edge of each.
    state : the problem's state after each.
    frames, cost : shape (T,), how long each is, and its cost f.
    complete : shape (T,), whether the halting rule or the horizon ends it.
    known : shape (T,), after how many expansions the search has expanded it, or, for a complete walk, has
        found it to be the best so far; T where it never does.
    """

    parent: Indices
    edge: list[SearchEdge | None]
    state: list[State]
    frames: Indices
    cost: Array
    complete: Mask
    known: Indices

    @property
    def expanded(self) -> int:
        """How many walks the search expanded."""
        return int(((self.known < len(self.known)) & ~self.complete).sum())

    def best(self, expanded: int) -> int:
        """Find the cheapest complete walk known after so many expansions; -1 before there is one."""
        cost = np.where(self.complete & (self.known <= expanded), self.cost, np.inf)
        return int(cost.argmin()) if np.isfinite(cost).any() else -1

    def cut(self, expanded: int) -> Mask:
        """Mark the walks that the bound has cut off after so many expansions."""
        best = self.best(expanded)
        bound = self.cost[best] if best >= 0 else np.inf
        return self.waiting(expanded) & (self.cost >= bound)

    def waiting(self, expanded: int) -> Mask:
        """Mark the walks that are not known after so many expansions, but whose parents are."""
        met = self.known <= expanded
        return np.asarray(met[self.parent] & (self.parent >= 0) & ~met)

    def line(self, walk: int) -> list[int]:
        """List the walks from the empty one to this one, each the parent of the next."""
        line = [walk]
        while (walk := int(self.parent[walk])) >= 0:
            line.append(walk)
        return line[::-1]


def grow_tree(problem: Problem, node: Hashable, state: State, *, horizon: float = math.inf) -> SearchTree:
    """Try every walk, and note which of them `synthesis.branch_and_bound` expands, and when.

    Parameters
    ----------
    problem, node, state, horizon : as for `branch_and_bound`.

    Raises
    ------
    MocapError : for more than 20 000 walks, too many for a picture.
    NoWalk : as `branch_and_bound` does.

    Examples
    --------
    >>> import networkx as nx
    >>> graph = nx.MultiDiGraph([(1, 1), (1, 1)])
    >>> nx.set_edge_attributes(graph, 1, "frames")
    >>> second_costs = Problem(graph, lambda _, edge: (edge[2], None), lambda _: False)  # g is the edge's key
    >>> tree = grow_tree(second_costs, 1, None, horizon=3)
    >>> len(tree.cost), tree.expanded  # all walks of at most 3 edges; those that were lengthened
    (15, 3)

    Notebook: 07-walks-and-search
    """
    taken: list[tuple[SearchEdge, ...]] = []

    def done(watched: Watched) -> bool:
        taken.append(watched[1])  # the search asks this of every walk that it takes up and does not cut
        return problem.done(watched[0])

    def step(watched: Watched, edge: SearchEdge) -> tuple[float, Watched]:
        cost, after = problem.step(watched[0], edge)
        return cost, (after, (*watched[1], edge))

    watching = Problem(problem.graph, step, done)
    found = _every_walk(watching, node, (state, ()), horizon)
    taken.clear()
    branch_and_bound(watching, node, (state, ()), horizon=horizon)
    parent, watched, frames, cost, complete = zip(*found, strict=True)
    states, walks = zip(*watched, strict=True)
    return SearchTree(
        np.array(parent),
        [walk[-1] if walk else None for walk in walks],
        list(states),
        np.array(frames),
        np.array(cost, float),
        np.array(complete),
        _known(walks, taken, dict(zip(walks, complete, strict=True))),
    )


def _known(
    walks: Sequence[tuple[SearchEdge, ...]],
    taken: list[tuple[SearchEdge, ...]],
    complete: dict[tuple[SearchEdge, ...], bool],
) -> Indices:
    """Say after how many expansions each walk is known, from the order in which the search took them up."""
    known, expanded = {}, 0
    for walk in taken:
        expanded += not complete[walk]
        known[walk] = expanded
    return np.array([known.get(walk, len(walks)) for walk in walks])


def _every_walk(
    problem: Problem, node: Hashable, state: State, horizon: float
) -> list[tuple[int, State, int, float, bool]]:
    """List all walks without a bound, depth first, cheap ones first: parent, state, frames, f, complete."""
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
    """A search's tree, its root at the top: expanded walks are green, walks that it never saw thin and grey.

    A cross ends a walk that the bound cut off, a ring a walk that waits; the best walk so far is orange.

    Parameters
    ----------
    tree : from `grow_tree`.
    places : shape (T, 2), where to draw the walks' ends; by default beside each other, and down by frames.
    ax : axes; new ones by default.

    Examples
    --------
    >>> import networkx as nx
    >>> from mocap import plotting
    >>> graph = nx.MultiDiGraph([(1, 1), (1, 1)])
    >>> nx.set_edge_attributes(graph, 1, "frames")
    >>> second_costs = Problem(graph, lambda _, edge: (edge[2], None), lambda _: False)  # g is the edge's key
    >>> picture = TreePicture(grow_tree(second_costs, 1, None, horizon=3))
    >>> plotting.show(picture.after(expanded=2), alt="Eight walks of three edges; two walks are expanded.")
    Picture('Eight walks of three edges; two walks are expanded.')

    Notebook: 07-walks-and-search
    """

    def __init__(self, tree: SearchTree, *, places: ArrayLike | None = None, ax: Axes | None = None) -> None:
        self.tree = tree
        self.ax = ax or plt.figure(figsize=(9, 3.6), layout="constrained").add_subplot()
        self.places = _spread(tree) if places is None else np.asarray(places, float)
        self.ax.add_collection(self._bundle(np.arange(1, len(tree.parent)), UNSEEN, 0.7, "never seen"))
        self.expanded = self._bundle([], CURVES[0], 1.6, "expanded")
        self.pending = self._bundle([], QUIET, 0.9)
        self.cut = self._bundle([], CURVES[1], 0.9)
        self.best = self._bundle([], PATH, 3.5, "best so far")
        (self.crosses,) = self.ax.plot([], [], "x", color=CURVES[1], markersize=4.5, label="cut by the bound")
        (self.rings,) = self.ax.plot([], [], "o", color=QUIET, mfc="white", markersize=4, label="waiting")
        for bundle in (self.pending, self.cut, self.expanded, self.best):
            self.ax.add_collection(bundle)
        self.ax.autoscale_view()
        if places is None:
            self.ax.invert_yaxis()
            self.ax.set(xticks=[], ylabel="frames ahead")
            self.ax.spines[["top", "right", "bottom"]].set_visible(False)

    def after(self, expanded: int | None = None) -> list[Artist]:
        """Show the search after so many expansions, by default all, and return the artists that moved."""
        tree, expanded = self.tree, self.tree.expanded if expanded is None else expanded
        met, cut, best = tree.known <= expanded, tree.cut(expanded), tree.best(expanded)
        pending = tree.waiting(expanded) & ~cut
        self.expanded.set_segments(self._lines(np.flatnonzero(met & (tree.parent >= 0))))
        self.cut.set_segments(self._lines(np.flatnonzero(cut)))
        self.pending.set_segments(self._lines(np.flatnonzero(pending)))
        self.best.set_segments(self._lines(tree.line(best)[1:] if best >= 0 else []))
        self.crosses.set_data(*self.places[cut].T)
        self.rings.set_data(*self.places[pending].T)
        return [self.pending, self.cut, self.expanded, self.best, self.crosses, self.rings]

    def _lines(self, walks: ArrayLike) -> list[Array]:
        """Give a line for the last edge of each of these walks: the places of its two ends."""
        ends = np.asarray(walks, int)
        return list(np.stack([self.places[self.tree.parent[ends]], self.places[ends]], axis=1))

    def _bundle(self, walks: ArrayLike, colour: str, width: float, name: str | None = None) -> LineCollection:
        lines = self._lines(walks)
        return LineCollection(lines, colors=colour, linewidths=width, label=name, capstyle="round")


def _spread(tree: SearchTree) -> Array:
    """Give each leaf a column of its own, and each other walk the middle of the leaves below it."""
    columns = np.full((len(tree.parent), 2), [np.inf, -np.inf])  # the first and the last below each walk
    leaf = np.ones(len(tree.parent), bool)
    leaf[tree.parent[1:]] = False
    columns[leaf] = np.arange(leaf.sum())[:, None]
    for walk in range(len(columns) - 1, 0, -1):
        above, below = columns[tree.parent[walk]], columns[walk]
        above[:] = min(above[0], below[0]), max(above[1], below[1])
    return np.stack([columns.mean(axis=1), tree.frames], axis=1)
