"""Path synthesis as the paper does it: branch and bound with the cost of Eq. 9 [KGP02, 5.1]."""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import ranges
from mocap.body.ground_path import GroundPath
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.beam_search import Found
from mocap.steering.followed import Followed, account
from mocap.steering.path_following import start_of
from mocap.steering.path_objective import Route, Wishes, least_progress, make_route
from mocap.synthesis.bounded_search import Budget, Problem, SearchEdge, search_ahead


class PathState(NamedTuple):
    """A walk's state: its clip is placed by p ↦ turn · p + move, and it is `along` metres along its path."""

    turn: complex
    move: complex
    along: float


class PathCost:
    """g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖² [KGP02, Eq. 9]; a walk ends when P' is as long as P.

    `cost` and `done` are the `step` and the `done` of a `synthesis.Problem`.
    """

    def __init__(self, graph: CompiledGraph, route: Route) -> None:
        self.graph, self.route = graph, route
        self.number: dict[SearchEdge, int] = {edge: number for number, edge in enumerate(graph.edges)}
        self.step = least_progress(graph, route)

    def cost(self, state: PathState, edge: SearchEdge) -> tuple[float, PathState]:
        """Give the cost of an edge after a walk in this state, and the next state."""
        graph, e = self.graph, self.number[edge]
        rows = slice(graph.tracks.first[e], graph.tracks.first[e] + graph.frames[e])
        along = state.along + np.cumsum(self.step[rows])
        off = np.abs(state.turn * graph.tracks.ground[rows] + state.move - self.route.at(along))
        turn, move = state.turn * graph.turn[e], state.move + state.turn * graph.move[e]
        return float((off**2).sum()), PathState(turn, move, float(along[-1]))

    def done(self, state: PathState) -> bool:
        """Say whether the walk has reached the end of the path."""
        return state.along >= self.route.length


def follow_as_2002(
    graph: MotionGraph | CompiledGraph,
    path: GroundPath,
    wishes: Wishes,
    *,
    look: tuple[int, int] = (90, 28),
    budget: Budget | None = None,
) -> Followed:
    """Follow a path by the paper's branch and bound, to compare with `follow_path` [KGP02, Eq. 9].

    Parameters
    ----------
    graph, path : as for `steering.follow_path`.
    wishes : give a `start`, else the walk starts at the first node; labels and times are ignored.
    look : n and m, the frames to look ahead and the frames to keep; as for `synthesis.search_ahead`.
    budget : of each stretch of the search.

    Returns
    -------
    The walk, and how well it follows the path.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, and where the budget ends before the first step.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> path, wishes = body.GroundPath([[0, 0], [0, 1]]), Wishes(start=(0, 10))
    >>> followed = follow_as_2002(graph, path, wishes, budget=Budget(nodes=100))
    >>> followed.progress, followed.found.stopped
    (1.0, 'out of nodes')

    Notebook: 08-path-synthesis
    """
    compiled = compile_graph(graph)
    route = make_route(compiled, path, wishes)
    start = start_of(compiled, route, wishes)
    state = PathState(complex(start.turn[0]), complex(start.move[0]), 0.0)
    cost = PathCost(compiled, route)
    problem = Problem(compiled.source.graph, cost.cost, cost.done)
    node = compiled.nodes[int(start.node[0])]
    result = search_ahead(problem, node, state, look=look, budget=budget)
    if not result.walk:
        raise NoWalk(f"The search was {result.stopped} before its first step.")
    edges = np.array([cost.number[edge] for edge in result.walk])
    rows = ranges(compiled.tracks.first[edges], compiled.frames[edges])
    along = np.cumsum(cost.step[rows])
    found = Found(
        edges, state.turn, state.move, along, result.cost, result.expanded, result.cut, result.stopped
    )
    return account(compiled, path, route, found)
