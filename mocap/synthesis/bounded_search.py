"""The paper's search for a walk: branch and bound, depth first, a stretch at a time [KGP02, 4.2].

The cost of a walk is the sum f(w) = Σ g([e₁ … e_{i-1}], e_i) over its edges [KGP02, Eq. 8], and g is never
below 0: so once a walk costs as much as the best complete one, no way of going on can better it, and the
branch is cut. Children come in the order of g, that the best complete walk is good early.

What g and the halting rule need to know of the walk so far is a `state` of the caller's own making: the walk
itself, or sums over it.
"""

import math
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any, NamedTuple

import networkx as nx

from mocap.errors import MocapError, NoWalk

State = Any
SearchEdge = tuple[Hashable, Hashable, int]
Step = Callable[[State, SearchEdge], tuple[float, State]]
"""g(w, e): what an edge adds to the cost of a walk in some state, and the state after it."""


@dataclass(frozen=True)
class Problem:
    """What to search for.

    Parameters
    ----------
    graph : any `networkx.MultiDiGraph` with `frames` on its edges.
    step : g: from the state of a walk, and an edge, to the cost, 0 or more, and the next state.
    done : the halting rule: whether a walk in this state is complete.

    Examples
    --------
    The cheapest walk that collects 5 points, on a triangle:

    >>> graph = nx.MultiDiGraph()
    >>> _ = graph.add_edges_from([(1, 2), (2, 3), (3, 1), (2, 1)], frames=1)
    >>> problem = Problem(graph, lambda points, edge: (edge[1], points + edge[0]), lambda points: points >= 5)
    >>> branch_and_bound(problem, 1, 0).walk
    [(1, 2, 0), (2, 1, 0), (1, 2, 0), (2, 1, 0)]
    """

    graph: nx.MultiDiGraph
    step: Step
    done: Callable[[State], bool]


@dataclass(frozen=True)
class Budget:
    """How many walks to expand at most, and for how many seconds to search."""

    nodes: float = math.inf
    seconds: float = math.inf

    def spent(self, nodes: int, begun: float) -> str:
        """Say what a search has run out of that expanded so many and began at a time of `time.monotonic`."""
        if nodes >= self.nodes:
            return "out of nodes"
        return "out of time" if time.monotonic() > begun + self.seconds else ""


class SearchResult(NamedTuple):
    """The best walk found.

    `complete` tells whether the halting rule, or the horizon, was met. `expanded` walks were gone on from,
    `cut` ones were not, by the bound. `stopped` is "" where the walk is proven optimal (within each stretch),
    or tells what ended the search before: then the walk is the best so far.
    """

    walk: list[SearchEdge]
    cost: float
    state: State
    complete: bool
    expanded: int
    cut: int
    stopped: str


class Branch(NamedTuple):
    """A walk under way: its last edge, and the branch that it goes on from."""

    cost: float
    node: Hashable
    state: State
    frames: int = 0
    edge: SearchEdge | None = None
    before: "Branch | None" = None

    def walk(self) -> list[SearchEdge]:
        """List its edges, the first one first."""
        edges, branch = [], self
        while branch.edge is not None and branch.before is not None:
            edges.append(branch.edge)
            branch = branch.before
        return edges[::-1]


def branch_and_bound(
    problem: Problem,
    node: Hashable,
    state: State,
    *,
    horizon: float = math.inf,
    budget: Budget | None = None,
) -> SearchResult:
    """Find the cheapest walk that is done, or at least `horizon` frames long.

    Parameters
    ----------
    problem : graph, costs and halting rule.
    node, state : where the walk starts, and the state of an empty walk.
    horizon : frames to look ahead.
    budget : when to stop; Ctrl-C stops the search, too.

    Raises
    ------
    NoWalk : for a node that the graph lacks, and where every walk ends before it is complete.
    MocapError : where g gives a cost below 0, with which the bound would cut what it must not.

    Notebook: 07-walks-and-search
    """
    if node not in problem.graph:
        raise NoWalk(f"The graph has no node {node}.")
    stack, best, budget, begun = [Branch(0.0, node, state)], None, budget or Budget(), time.monotonic()
    furthest, expanded, cut, stopped = stack[0], 0, 0, ""
    try:
        while stack and not stopped:
            branch = stack.pop()
            furthest = max(furthest, branch, key=lambda b: b.frames)
            if best and branch.cost >= best.cost:
                cut += 1
            elif problem.done(branch.state) or branch.frames >= horizon:
                best = branch
            elif not (stopped := budget.spent(expanded, begun)):
                expanded += 1
                stack += children(problem, branch)  # the cheapest last, to be popped first
    except KeyboardInterrupt:
        stopped = "interrupted"
    if not (best or stopped):
        raise NoWalk(f"Every walk from node {node} ends too early: prune the graph first.")
    last = best or furthest
    return SearchResult(last.walk(), last.cost, last.state, best is not None, expanded, cut, stopped)


def children(problem: Problem, branch: Branch) -> list[Branch]:
    """Go on by every edge, the dearest first.

    Notebook: 07-walks-and-search
    """
    found = []
    for start, end, key, frames in problem.graph.out_edges(branch.node, keys=True, data="frames"):
        cost, state = problem.step(branch.state, (start, end, key))
        if not cost >= 0:
            raise MocapError(f"A cost must be 0 or more, got {cost} for the edge {(start, end, key)}.")
        found.append(
            Branch(branch.cost + cost, end, state, branch.frames + frames, (start, end, key), branch)
        )
    return sorted(found, key=lambda child: child.cost, reverse=True)


def search_ahead(
    problem: Problem,
    node: Hashable,
    state: State,
    *,
    look: tuple[int, int] = (90, 28),
    budget: Budget | None = None,
) -> SearchResult:
    """Search in stretches: find the best walk of n frames, keep its first m, go on from there [KGP02, 4.2].

    The time is linear in the walk's length, and the walk is optimal within each horizon only.

    Parameters
    ----------
    problem, node, state : as for `branch_and_bound`.
    look : n and m, frames; the paper takes 80-120 and 25-30.
    budget : for each stretch; where it runs out, the best walk so far is kept.

    Returns
    -------
    The whole walk; after Ctrl-C, as far as it has come.

    Notebook: 07-walks-and-search
    """
    ahead, keep = look
    if not 1 <= keep <= ahead:
        raise MocapError(f"Of the frames looked ahead some must be kept, got n = {ahead} and m = {keep}.")
    walk: list[SearchEdge] = []
    cost, expanded, cut, stopped = 0.0, 0, 0, ""
    while not problem.done(state) and stopped != "interrupted":
        found = branch_and_bound(problem, node, state, horizon=ahead, budget=budget)
        frames, kept = 0, 0
        while kept < len(found.walk) and frames < keep and not problem.done(state):
            edge = found.walk[kept]
            more, state = problem.step(state, edge)
            cost, frames, kept = cost + more, frames + problem.graph.edges[edge]["frames"], kept + 1
        expanded, cut, stopped = expanded + found.expanded, cut + found.cut, found.stopped or stopped
        if not kept:
            break
        walk, node = walk + found.walk[:kept], found.walk[kept - 1][1]
    return SearchResult(walk, cost, state, problem.done(state), expanded, cut, stopped)
