"""Path synthesis as the paper does it: branch and bound with the cost of Eq. 9 [KGP02, 5.1]."""

import numpy as np

from mocap.body.ground_path import GroundPath
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.followed import Followed, account
from mocap.steering.path_following import start_of
from mocap.steering.path_objective import Route, Wishes, least_progress, make_route
from mocap.steering.path_search import Found
from mocap.synthesis.bounded_search import Budget, Problem, SearchEdge, search_ahead
from mocap.synthesis.ground_walks import GroundWalks, Stand


class PathCost(GroundWalks):
    """g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖² [KGP02, Eq. 9]; a walk ends when P' is as long as P.

    `cost` and `done` are the `step` and the `done` of a `synthesis.Problem`.
    """

    def __init__(self, graph: CompiledGraph, route: Route) -> None:
        super().__init__(graph)
        self.route, self.progress = route, least_progress(graph, route)

    def cost(self, stand: Stand, edge: SearchEdge) -> tuple[float, Stand]:
        """Give the cost of an edge after a walk that stands so, and where it leads."""
        points, after = self.step(stand, edge)
        along = stand.along + np.cumsum(self.progress[self.rows(edge)])
        off = np.abs(points - self.route.at(along))
        return float((off**2).sum()), after._replace(along=float(along[-1]))

    def done(self, stand: Stand) -> bool:
        """Say whether the walk has reached the end of the path."""
        return stand.along >= self.route.length


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
    stand = Stand(complex(start.turn[0]), complex(start.move[0]))
    walks = PathCost(compiled, route)
    problem = Problem(compiled.source.graph, walks.cost, walks.done)
    result = search_ahead(problem, compiled.nodes[int(start.node[0])], stand, look=look, budget=budget)
    if not result.walk:
        raise NoWalk(f"The search was {result.stopped} before its first step.")
    edges = np.array([walks.number[edge] for edge in result.walk])
    along = np.cumsum(np.concatenate([walks.progress[walks.rows(edge)] for edge in result.walk]))
    counts = result.expanded, result.cut, result.stopped
    found = Found(edges, stand.turn, stand.move, along, result.cost, *counts)
    return account(compiled, path, route, found)
