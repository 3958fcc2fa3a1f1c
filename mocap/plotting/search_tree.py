"""A search as a tree: every walk that it could try, those that it expanded, those that its bound cut off.

To expand a walk is to lengthen it by every edge that leaves its last node.
"""

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
from mocap.plotting.style import CURVES, PATH, QUIET
from mocap.synthesis.bounded_search import Branch, Problem, State, children

MOST_BRANCHES = 20_000


class SearchTree(NamedTuple):
    """All T walks up to a horizon, the empty walk first, each walk after its parent.

    Parameters
    ----------
    parent : shape (T,), the walk without its last edge; -1 for the empty walk.
    state : the problem's state after each.
    frames, cost : shape (T,), how long each is, and its cost f.
    complete : shape (T,), whether the halting rule or the horizon ends it.
    known : shape (T,), after how many expansions the search has expanded it, or, for a complete walk, has
        found it to be the best so far; infinite where it never does.
    """

    parent: Indices
    state: list[State]
    frames: Indices
    cost: Array
    complete: Mask
    known: Array

    @property
    def expanded(self) -> int:
        """How many walks the search expanded."""
        return int((np.isfinite(self.known) & ~self.complete).sum())

    def best(self, expanded: int) -> int:
        """Find the cheapest complete walk known after so many expansions; -1 before there is one."""
        cost = np.where(self.complete & (self.known <= expanded), self.cost, np.inf)
        return int(cost.argmin()) if np.isfinite(cost).any() else -1

    def cut(self, expanded: int) -> Mask:
        """Mark the walks that the bound has cut off after so many expansions."""
        best = self.best(expanded)
        return self.waiting(expanded) & (self.cost >= (self.cost[best] if best >= 0 else np.inf))

    def waiting(self, expanded: int) -> Mask:
        """Mark the walks that are not known after so many expansions, but whose parents are."""
        met = self.known <= expanded
        return np.asarray(met[self.parent] & (self.parent >= 0) & ~met)


def grow_tree(problem: Problem, node: Hashable, state: State, *, horizon: float = math.inf) -> SearchTree:
    """Try every walk, and note which of them `synthesis.branch_and_bound` expands, and when.

    Parameters
    ----------
    problem, node, state, horizon : as for `branch_and_bound`.

    Raises
    ------
    MocapError : for more than 20 000 walks, too many for a picture.

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
    found: list[tuple[int, State, int, float, bool, float]] = []  # the columns of a tree
    waiting, bound, expanded = [(-1, Branch(0.0, node, state))], math.inf, 0
    while waiting:  # in the order of the search, which the bound does not change
        parent, walk = waiting.pop()
        complete = problem.done(walk.state) or walk.frames >= horizon
        known = math.inf
        if walk.cost < bound and (parent < 0 or math.isfinite(found[parent][-1])):  # the search takes it up
            expanded += not complete
            known, bound = expanded, walk.cost if complete else bound
        found.append((parent, walk.state, walk.frames, walk.cost, complete, known))
        if len(found) > MOST_BRANCHES:
            raise MocapError(f"There are more than {MOST_BRANCHES} walks: look less far ahead.")
        if not complete:
            waiting += [(len(found) - 1, child) for child in children(problem, walk)]
    parents, states, *rest = zip(*found, strict=True)
    return SearchTree(np.array(parents), list(states), *map(np.array, rest))


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
        never, self.expanded, self.pending, self.cut, self.best = [
            LineCollection([], colors=colour, linewidths=width, label=name, capstyle="round")
            for colour, width, name in (
                ("#CCCCCC", 0.7, "never seen"),
                (CURVES[0], 1.6, "expanded"),
                (QUIET, 0.9, None),
                (CURVES[1], 0.9, None),
                (PATH, 3.5, "best so far"),
            )
        ]
        never.set_segments(self._lines(np.arange(1, len(tree.parent))))
        self.ax.add_collection(never)
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
        cut, walk, line = tree.cut(expanded), tree.best(expanded), []
        pending = tree.waiting(expanded) & ~cut
        while walk > 0:
            line.append(walk)
            walk = int(tree.parent[walk])
        self.expanded.set_segments(self._lines(np.flatnonzero((tree.known <= expanded) & (tree.parent >= 0))))
        self.cut.set_segments(self._lines(np.flatnonzero(cut)))
        self.pending.set_segments(self._lines(np.flatnonzero(pending)))
        self.best.set_segments(self._lines(np.array(line[::-1], int)))
        self.crosses.set_data(*self.places[cut].T)
        self.rings.set_data(*self.places[pending].T)
        return [self.pending, self.cut, self.expanded, self.best, self.crosses, self.rings]

    def _lines(self, walks: Indices) -> list[Array]:
        """Give a line for the last edge of each of these walks: the places of its two ends."""
        return list(np.stack([self.places[self.tree.parent[walks]], self.places[walks]], axis=1))


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
