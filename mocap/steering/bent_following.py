"""Walks that are bent onto a path by path editing [Gle01]: the route of the search, and the bent walk.

A walk through the graph turns only as its clips turn. Path editing rotates it further. Therefore a search for
a walk to be bent prices the rotation beyond that of its clips, not the distance from the path.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, on_ground
from mocap.editing.bending import bend
from mocap.editing.line_rounding import RoundedLine, round_line
from mocap.editing.path_editing import Ride, moving_frames
from mocap.editing.turning import places_on
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering.followed import Followed
from mocap.steering.path_objective import PathRequest, Route, make_route
from mocap.steering.path_search import Found, too_slow
from mocap.steering.smooth_paths import path_of_walk, smooth_graph
from mocap.steering.tuned import TUNED
from mocap.synthesis.walk_to_motion import to_motion


def plan_bending(
    graph: CompiledGraph, path: GroundPath, request: PathRequest, limit: float
) -> tuple[Route, Callable[[Found], Followed]]:
    """Prepare a search for a walk to be bent: its route, and the function that bends the walk.

    Parameters
    ----------
    graph, path, request : as for `follow_path`.
    limit : the highest additional angular speed of a bent walk, radians per second.

    Returns
    -------
    route : the path, rounded for the usual pace of the clips, so that the search does not expect rotations
        beyond the limit. It is slightly longer than the path.
    bend_walk : a function that bends a walk from the search onto the path and measures it.

    Raises
    ------
    MocapError : for a limit that is not above 0, and invalid requests.
    NoWalk : for a label that no clip of the graph has, and clips in which the body only stands.
    """
    if not limit > 0:
        raise MocapError(f"A walk is bent by more than 0 radians per second, got bend={limit}.")
    make_route(graph, path, request)  # refuses a path that is too long, and requests that are not on it
    smooth, rotations = smooth_graph(graph)
    walking_steps = smooth.step[smooth.step * graph.fps > TUNED.slowest]
    if not len(walking_steps):
        raise too_slow(graph)
    # A straight walk at the clips' usual pace, long enough for shorter steps.
    walked = np.arange(0.0, 2 * path.length + 2.0, float(np.median(walking_steps)))
    pace = Ride(GroundPath(np.array([[0.0, 0.0], [0.0, walked[-1]]])), walked)
    line = round_line(path, pace, graph.fps, limit)
    rounded_request = _rounded_request(request, line)
    # A slower walk, or one whose clips turn, needs less rounding, so that its line is longer.
    longest = max(path.length, line.path.length)
    extra = TUNED.overrun + (1 + TUNED.overrun_fraction) * longest - line.path.length
    route_path = _extended(line.path, extra)
    along, ratio = places_on(route_path, pace, graph.fps, limit)
    route = make_route(graph, route_path, rounded_request)
    route = _spaced_by_walk(route, route_path, along, ratio, walked)
    route = replace(route, smooth=smooth, rotations=rotations)
    return route, partial(_bend_walk, graph, path, rounded_request, limit)


def _rounded_request(request: PathRequest, line: RoundedLine) -> PathRequest:
    """Map the labels and times of requests from metres along a path to metres along the rounded path."""

    def rounded(metres: float) -> float:
        return float(np.interp(metres, line.requested, line.along))

    labels = [(rounded(metres), label) for metres, label in request.labels]
    times = [(rounded(metres), seconds) for metres, seconds in request.times]
    return replace(request, labels=labels, times=times, correction=0.0)


def _extended(path: GroundPath, metres: float) -> GroundPath:
    """Extend a path by some metres in the direction of its last segment."""
    points = path.points
    segment = points[-1] - points[-2]
    return GroundPath(np.vstack([points, points[-1] + metres * segment / np.hypot(*segment)]))


def _spaced_by_walk(route: Route, path: GroundPath, along: Array, ratio: Array, walked: Array) -> Route:
    """Space a route evenly in the metres and seconds of a walk before it is slowed down for bends.

    Parameters
    ----------
    route : the route along the path.
    path : the path.
    along : shape (F,), metres along the path in each frame of a straight walk at the usual pace.
    ratio : shape (F,), as from `places_on`. The duration of a frame is multiplied by 1/√ratio.
    walked : shape (F,), metres of the straight walk before it is slowed down.
    """
    length = float(np.interp(path.length, along, walked))
    spaced = np.linspace(0.0, length, len(route.points))
    route_along = np.interp(spaced, walked, along)
    pace = np.interp(spaced, walked, np.sqrt(ratio))
    number = route.point(route_along)
    clock = route.clock[number]
    elapsed = np.nancumsum(np.diff(clock, prepend=clock[:1]) * pace)
    clock = np.where(np.isnan(clock), np.nan, elapsed + np.nanmin([*clock, np.inf]))
    points = on_ground(path.at(route_along))
    label = route.label[number]
    curvature = np.gradient(np.asarray(moving_frames(path, route_along).angle), spaced)
    return replace(route, points=points, spacing=spaced[1], label=label, clock=clock, curvature=curvature)


def _bend_walk(
    graph: CompiledGraph, path: GroundPath, request: PathRequest, limit: float, walk: Found
) -> Followed:
    """Bend a walk from the search onto the path, and measure its distance from the path."""
    edges = [graph.edges[edge] for edge in walk.edges]
    smooth, _ = smooth_graph(graph)
    ride = path_of_walk(smooth, walk.edges)
    bent = bend(to_motion(graph.source, edges), path, limit=limit, ride=ride)
    played_frames = np.searchsorted(ride.along, bent.ride.along[-1])
    last_edge = int(np.searchsorted(np.cumsum(graph.frames[walk.edges]), played_frames))
    track = bent.motion.root_positions[:, [0, 2]]
    # reads: statement: one field a line
    return Followed(
        graph.source,
        path,
        edges[: last_edge + 1],
        IDENTITY,
        track=track,
        along=bent.along,
        off=bent.off,
        off_at_length=np.hypot(*(track - path.at(bent.walked)).T),
        unlabelled=_unlabelled(bent.motion, bent.walked, request),
        found=walk,
        bent=bent,
    )


def _unlabelled(motion: Motion, walked: Array, request: PathRequest) -> Mask:
    """Mark the frames without the requested label, as a function of the metres walked."""
    unlabelled = np.zeros(len(motion), bool)
    for start, label in sorted(request.labels):
        is_asked = walked >= start
        is_labelled = motion.labels.get(label, np.zeros(len(motion), bool))
        unlabelled[is_asked] = bool(label) & ~is_labelled[is_asked]
    return unlabelled
