"""Walks that follow a direction: they stand, start, wait, turn and arrive as it says."""

from __future__ import annotations

from collections.abc import Sequence

from mocap.errors import NoWalk
from mocap.files.directions import DirectedPoint, Direction
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, require_graph
from mocap.steering.directed_walk import Directed, warn_of_misses
from mocap.steering.direction_legs import legs_of
from mocap.steering.direction_search import Prices
from mocap.steering.leg_search import LegSearch
from mocap.steering.path_objective import Settings
from mocap.steering.standing import StandingGraph, with_standing
from mocap.steering.walk_plans import WalkPlan


def direct(
    graph: MotionGraph | StandingGraph,
    direction: Direction | Sequence[DirectedPoint],
    *,
    settings: Settings | None = None,
    prices: Prices | None = None,
    kept: Sequence[Edge] = (),
) -> Directed:
    """Find a walk that follows a direction: a line with times, headings, labels, waits and discs to avoid.

    The direction is cut where the walk waits. Each leg is a search along its line, led around the discs and
    turned at its ends where a heading asks for it. Times, headings and the end are priced beside the line
    [KGP02, 4.2]. A wait is a walk through standing stretches, and is held if no clip stands as long. Near a
    point that asks for a heading, the line is a curve in its direction. What a search misses by some
    centimetres and degrees is spread over its steps (`anchoring`).

    Parameters
    ----------
    graph : pruned. Standing stretches that pruning removed are added again. To follow several directions,
        pass `steering.with_standing(graph)`.
    direction : the direction, or its points.
    settings : the effort of the search, and the prices of deviations from the line. By default the beam width
        is 60, and 200 in a second search for a leg that misses what is asked for. Times are priced by
        `Prices.arrival` in place of `late`.
    prices : the prices of what else is asked for.
    kept : edges of an earlier walk, which stays as it was where it can, as `PathRequest.kept`.

    Raises
    ------
    NoWalk : if no clip stands and the direction asks for it, for discs that leave no way, and as for
        `steering.follow_path`.
    MocapError : for an invalid direction.

    Warns
    -----
    MocapWarning : where the walk is more than 10 cm, 10° or 0.3 s off what is asked for, or waits for another
        time than asked.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.files import DirectedPoint, Direction
    >>> names = ("stop_and_go", "walk_straight", "walk_curve_1")
    >>> clips = [body.resample(datasets.sample(name), 30) for name in names]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> points = [DirectedPoint(0, 0), DirectedPoint(0, 5)]
    >>> directed = direct(graph, Direction(points, start="stand", end="stand", facing=0.0))
    >>> last = directed.arrivals[-1]
    >>> last.off < 0.1, abs(last.turned) < 0.17
    (True, True)

    Notebook: 08b-steering
    """
    direction = direction if isinstance(direction, Direction) else Direction(direction)
    standing = graph if isinstance(graph, StandingGraph) else with_standing(require_graph(graph))
    search = LegSearch(standing, direction, settings or Settings(), prices or Prices(), kept)
    plan = WalkPlan(standing, direction, search)
    legs = legs_of(direction)
    for number, leg in enumerate(legs, 1):
        plan.add_leg(leg, legs[number:])
    directed = plan.directed()
    if direction.around and directed.entered > 0:
        depth = f"The nearest walk enters a disc by {100 * directed.entered:.0f} cm"
        raise NoWalk(f"{depth}: no clips turn as the way round it does; leave more room, or add such clips.")
    warn_of_misses(directed)
    return directed
