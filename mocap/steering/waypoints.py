"""Keyframing at a high level: what kind of motion, where, and when [KGP02, 5.3]."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath, spline
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.beam_search import Beam
from mocap.steering.path_following import Followed, follow_path
from mocap.steering.path_objective import Prices, Wishes


class Waypoint(NamedTuple):
    """A place (x, z) in metres, the label of the motion from there on, "" for any, and when to be there.

    Notebook: 08-path-synthesis
    """

    x: float
    z: float
    label: str = ""
    seconds: float | None = None


class Arrival(NamedTuple):
    """How a waypoint was met: how many metres off, when, and how late (nan where no time was asked for)."""

    off: float
    seconds: float
    late: float


class WaypointWalk(NamedTuple):
    """A walk by waypoints, and how each of them was met."""

    followed: Followed
    arrivals: list[Arrival]


def through_waypoints(
    graph: MotionGraph | CompiledGraph,
    waypoints: Sequence[Waypoint],
    *,
    beam: Beam | None = None,
    prices: Prices | None = None,
) -> WaypointWalk:
    """Walk through some places, in the manner and at the times asked for.

    The path between is a spline. Where a time cannot be kept at the speeds that the clips have, the walk
    comes as near to it as it can, and `arrivals` tells how late it is.

    Parameters
    ----------
    graph : pruned.
    waypoints : two or more; times count from the start of the motion.
    beam, prices : as for `steering.follow_path`; `prices.late` is what lateness costs.

    Raises
    ------
    NoWalk, MocapError : as there.

    Notebook: 08-path-synthesis
    """
    points = np.array([(point.x, point.z) for point in waypoints], float).reshape(-1, 2)
    path = spline(points)
    along = _metres(path, points)
    labels = [(place, point.label) for place, point in zip(along, waypoints, strict=True)]
    times = [(place, p.seconds) for place, p in zip(along, waypoints, strict=True) if p.seconds is not None]
    if times and waypoints[0].seconds is None:
        times.insert(0, (0.0, 0.0))
    if any(seconds == 0 for place, seconds in times if place > 0):
        raise MocapError("Only the first waypoint can be asked for at 0 s.")
    wishes = Wishes(labels=labels, times=times)
    followed = follow_path(graph, path, wishes, beam=beam, prices=prices)
    return WaypointWalk(followed, [_arrival(followed, a, p) for a, p in zip(along, waypoints, strict=True)])


def _metres(path: GroundPath, points: Array) -> list[float]:
    """Find how far along its path each waypoint is, each past the one before."""
    found, first = [0], 0
    for point in points[1:-1]:
        off = np.hypot(*(path.points[first:] - point).T)
        near = np.flatnonzero(off < off.min() + 0.02)[0]  # where the path comes there first
        first += int(near)
        found.append(first)
    return [*path.along[found].tolist(), path.length]


def _arrival(followed: Followed, along: float, point: Waypoint) -> Arrival:
    frame = min(int(np.searchsorted(followed.along, along)), len(followed.along) - 1)
    seconds = frame / followed.graph.clips[0].fps
    off = float(np.hypot(*(followed.track[frame] - [point.x, point.z])))
    return Arrival(off, seconds, np.nan if point.seconds is None else seconds - point.seconds)
