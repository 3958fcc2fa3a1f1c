"""The paper's search for a walk: depth-first branch and bound, with a receding horizon [KGP02, 4.2].

The cost of a walk is the sum f(w) = Σ g([e₁ … e_{i-1}], e_i) over its edges [KGP02, Eq. 8], and g is not
negative. A branch that costs as much as the best complete walk therefore cannot improve on it, and is pruned.
Children with the smallest g are searched first, so that a good complete walk is found early.

The caller defines the `state` of a walk, on which g and the halting rule depend: the walk itself, or sums
over it.
"""

from collections.abc import Callable, Hashable
from typing import Any

import networkx as nx
import numpy as np

from mocap._shared.deadlines import OUT_OF_TIME as OUT_OF_TIME
from mocap._shared.deadlines import Deadline as Deadline
from mocap._shared.records import NamedTuple, dataclass
from mocap._shared.ties import in_order
from mocap.errors import MocapError, NoWalk

# The tolerance for equal costs, in their unit. Of walks with equal costs, the first one found is kept.
EQUAL = 1e-9

State = Any
SearchEdge = tuple[Any, Any, int]
"""The start and end nodes of an edge, of any type, and its key."""
Step = Callable[[State, SearchEdge], tuple[float, State]]
"""g(w, e): a function of a walk's state and the next edge, which returns a cost and the next state."""


@dataclass(frozen=True)
class Problem:
    """A search problem: a graph, a cost, and a halting rule.

    Parameters
    ----------
    graph : any `networkx.MultiDiGraph` with `frames` on its edges.
    step : the function g of the state of a walk and the next edge, which returns the cost of this edge, 0 or
        more, and the next state.
    done : the halting rule, a function that returns whether a walk in a state is complete.

    Examples
    --------
    The walk of least cost that collects 5 points, on a triangle:

    >>> graph = nx.MultiDiGraph()
    >>> _ = graph.add_edges_from([(1, 2), (2, 3), (3, 1), (2, 1)], frames=1)
    >>> problem = Problem(graph, lambda points, edge: (edge[1], points + edge[0]), lambda points: points >= 5)
    >>> branch_and_bound(problem, 1, 0).walk
    [(1, 2, 0), (2, 1, 0), (1, 2, 0), (2, 1, 0)]
    """

    graph: nx.MultiDiGraph
    step: Step
    done: Callable[[State], bool]  # reads: name: notebooks give it by keyword


class SearchResult(NamedTuple):
    """The result of a search: the best walk, its cost and its last state.

    `complete` is whether the walk meets the halting rule or the horizon. `expanded` is the number of walks
    that were extended, `cut` that of walks pruned by the bound. `stopped` is "" if the walk is optimal
    (within each horizon). Otherwise the search ended early for this reason, with the best walk so far.
    """

    walk: list[SearchEdge]
    cost: float
    state: State
    complete: bool
    expanded: int
    cut: int
    stopped: str


class Branch(NamedTuple):
    """A node of the search tree, a walk: its last edge, and its `parent`, the branch without that edge.

    Examples
    --------
    >>> root = Branch(0.0, "a", None)
    >>> Branch(1.0, "b", None, 5, ("a", "b", 0), root).walk()
    [('a', 'b', 0)]
    """

    cost: float
    node: Hashable
    state: State
    frames: int = 0
    edge: SearchEdge | None = None
    parent: "Branch | None" = None

    def walk(self) -> list[SearchEdge]:
        """List the edges of the walk, in order."""
        edges = []
        branch = self
        while branch.edge is not None and branch.parent is not None:
            edges.append(branch.edge)
            branch = branch.parent
        return edges[::-1]


def branch_and_bound(  # noqa: PLR0913 (a problem, a start, and three limits)
    problem: Problem,
    node: Hashable,
    state: State,
    *,
    horizon: float = np.inf,
    budget: float = np.inf,
    deadline: float | Deadline = np.inf,
) -> SearchResult:
    """Find the walk of least cost that is complete, or at least `horizon` frames long [KGP02, Eq. 8].

    Parameters
    ----------
    problem : graph, costs and halting rule.
    node, state : the start node, and the state of an empty walk.
    horizon : the number of frames after which a walk is complete in any case.
    budget : the largest number of walks to extend. Ctrl-C also stops the search.
    deadline : seconds of wall time after which the search stops, or a deadline shared by several searches.

    Returns
    -------
    The best walk. If the search stops before it finds a complete one, the longest walk so far.

    Raises
    ------
    NoWalk : for a node that is not in the graph, and if every walk ends before it is complete.
    MocapError : for a negative cost, for which the bound is not valid, and a deadline that is not above 0.

    Examples
    --------
    The path of least cost from 1 to 3 leads through 2:

    >>> graph = nx.MultiDiGraph()
    >>> graph.add_weighted_edges_from([(1, 2, 1.0), (2, 3, 1.0), (1, 3, 5.0)], frames=1)
    >>> def step(node, edge):
    ...     return graph.edges[edge]["weight"], edge[1]
    >>> found = branch_and_bound(Problem(graph, step, lambda node: node == 3), 1, 1)
    >>> found.walk, found.cost
    ([(1, 2, 0), (2, 3, 0)], 2.0)

    Notebook: 07-walks-and-search
    """
    end = Deadline.of(deadline)
    longest = _root(problem, node, state)
    best: Branch | None = None
    stack = [longest]
    expanded = 0
    cut = 0
    stopped = ""
    try:
        while stack and not stopped:
            branch = stack.pop()
            longest = max(longest, branch, key=lambda branch: branch.frames)
            if _is_cut(branch, best):
                cut += 1
            elif _is_complete(problem, branch, horizon):
                best = branch
            elif expanded >= budget:
                stopped = "out of nodes"
            elif end.is_over:
                stopped = OUT_OF_TIME
            else:
                expanded += 1
                stack += children(problem, branch)  # that of least cost is last, and popped first
    except KeyboardInterrupt:
        stopped = "interrupted"
    if best is None and not stopped:
        raise NoWalk(f"Every walk from node {node} ends too early: prune the graph first.")
    last = best or longest
    return SearchResult(last.walk(), last.cost, last.state, best is not None, expanded, cut, stopped)


def _root(problem: Problem, node: Hashable, state: State) -> Branch:
    """Return the empty walk from a node, or raise `NoWalk` if the graph has no such node."""
    if node not in problem.graph:
        raise NoWalk(f"The graph has no node {node}.")
    return Branch(0.0, node, state)


def _is_cut(branch: Branch, best: Branch | None) -> bool:
    """Return whether the bound prunes a walk, which costs as much as the best complete one."""
    return best is not None and branch.cost >= best.cost - EQUAL


def _is_complete(problem: Problem, branch: Branch, horizon: float) -> bool:
    """Return whether a walk meets the halting rule or the horizon."""
    return problem.done(branch.state) or branch.frames >= horizon


def children(problem: Problem, branch: Branch) -> list[Branch]:
    """Extend a walk by every edge that leaves its node, in descending order of costs.

    In the paper: [KGP02, order]; the last child is searched first.

    Examples
    --------
    >>> graph = nx.MultiDiGraph()
    >>> _ = graph.add_edges_from([(1, 2), (1, 3)], frames=1)
    >>> problem = Problem(graph, lambda state, edge: (edge[1], None), lambda state: False)
    >>> [(child.node, child.cost) for child in children(problem, Branch(0.0, 1, None))]
    [(3, 3.0), (2, 2.0)]
    """
    branches = []
    for start, end, key, frames in problem.graph.out_edges(branch.node, keys=True, data="frames"):
        edge = (start, end, key)
        cost, state = problem.step(branch.state, edge)
        if not cost >= 0:
            raise MocapError(f"A cost must be 0 or more, got {cost} for the edge {edge}.")
        branches.append(Branch(branch.cost + cost, end, state, branch.frames + frames, edge, branch))
    return [branches[number] for number in in_order([-child.cost for child in branches], EQUAL)]


def search_ahead(  # noqa: PLR0913 (a problem, a start, and three limits)
    problem: Problem,
    node: Hashable,
    state: State,
    *,
    look: tuple[int, int] = (90, 28),
    budget: float = np.inf,
    deadline: float = np.inf,
) -> SearchResult:
    """Search with a receding horizon: find the best walk of n frames, keep its first m, repeat [KGP02, 4.2].

    The time is linear in the length of the walk, which is optimal only within each horizon.

    Parameters
    ----------
    problem, node, state : as for `branch_and_bound`.
    look : n and m, frames. The paper uses 80-120 and 25-30.
    budget : the budget of each search. If one is exhausted, its best walk so far is used.
    deadline : seconds of wall time for all searches together.

    Returns
    -------
    The whole walk, or after Ctrl-C or at the deadline the walk so far.

    Raises
    ------
    NoWalk, MocapError : as by `branch_and_bound`, and for n and m without 1 ≤ m ≤ n.

    Examples
    --------
    A short horizon chooses the edge of low cost, whose successor has a high cost:

    >>> graph = nx.MultiDiGraph()
    >>> graph.add_weighted_edges_from([(1, 2, 1), (1, 3, 2), (2, 4, 9), (3, 4, 1)], frames=1)
    >>> def step(node, edge):
    ...     return graph.edges[edge]["weight"], edge[1]
    >>> problem = Problem(graph, step, lambda node: node == 4)
    >>> [search_ahead(problem, 1, 1, look=(frames, 1)).cost for frames in (1, 2)]
    [10.0, 3.0]

    Notebook: 07b-searching-ahead
    """
    ahead, keep = look
    if not 1 <= keep <= ahead:
        raise MocapError(f"Of the frames looked ahead some must be kept, got n = {ahead} and m = {keep}.")
    end = Deadline(deadline)
    walk: list[SearchEdge] = []
    cost = 0.0
    expanded = cut = 0
    stopped = ""
    while not problem.done(state) and stopped not in ("interrupted", OUT_OF_TIME):
        best = branch_and_bound(problem, node, state, horizon=ahead, budget=budget, deadline=end)
        expanded += best.expanded
        cut += best.cut
        stopped = best.stopped or stopped
        if not best.walk:
            break
        frames = 0
        for edge in best.walk:
            if frames >= keep or problem.done(state):
                break
            edge_cost, state = problem.step(state, edge)
            cost += edge_cost
            frames += problem.graph.edges[edge]["frames"]
            walk.append(edge)
        node = walk[-1][1]
    return SearchResult(walk, cost, state, problem.done(state), expanded, cut, stopped)
