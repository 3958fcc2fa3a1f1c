"""High-level keyframing: a walk through waypoints, each with a place, a label and a time [KGP02, 5.3]."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath, spline
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.followed import Followed
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings, Wishes


class Waypoint(NamedTuple):
    """A place (x, z) in metres, the label of the motion from there on, and the time to be there.

    The label "" stands for any motion, None for any time.

    Examples
    --------
    >>> Waypoint(0.0, 4.0, "sneak", seconds=5.0)
    Waypoint(x=0.0, z=4.0, label='sneak', seconds=5.0)

    Notebook: 08b-steering
    """

    x: float
    z: float
    label: str = ""
    seconds: float | None = None


class Arrival(NamedTuple):
    """How a waypoint was met: metres `off`, the time, and how many seconds `late` (nan without a time)."""

    off: float
    seconds: float
    late: float


class WaypointWalk(NamedTuple):
    """A walk through waypoints, and how each of them was met."""

    followed: Followed
    arrivals: list[Arrival]


def through_waypoints(
    graph: MotionGraph | CompiledGraph,
    waypoints: Sequence[Waypoint],
    *,
    settings: Settings | None = None,
    bend: float = 0.0,
) -> WaypointWalk:
    """Find a walk through waypoints, with their labels and at their times [KGP02, 5.3].

    The path between them is a spline. Where the clips are too slow or too fast for a time, the walk comes as
    near to it as it can, and `arrivals` gives the delay.

    Parameters
    ----------
    graph : pruned.
    waypoints : two or more; times count from the start of the motion.
    settings, bend : as for `steering.follow_path`; `Settings.late` is the price of a delay.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, and for a later waypoint at 0 s.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> found = through_waypoints(graph, [Waypoint(0, 0), Waypoint(0.5, 4, seconds=5.0)])
    >>> [bool(arrival.off < 0.3) for arrival in found.arrivals]
    [True, True]

    Notebook: 08b-steering
    """
    points = np.array([(point.x, point.z) for point in waypoints], float).reshape(-1, 2)
    path = spline(points)
    placed = list(zip(_places_along(path, points), waypoints, strict=True))
    labels = [(along, point.label) for along, point in placed]
    times = [(along, point.seconds) for along, point in placed if point.seconds is not None]
    if times and waypoints[0].seconds is None:
        times.insert(0, (0.0, 0.0))
    if any(seconds == 0 for along, seconds in times if along > 0):
        raise MocapError("Only the first waypoint can be asked for at 0 s.")
    followed = follow_path(graph, path, Wishes(labels=labels, times=times), settings=settings, bend=bend)
    arrivals = []
    for along, point in placed:
        frame = min(int(np.searchsorted(followed.along, along)), len(followed.along) - 1)
        off, seconds = float(np.hypot(*(followed.track[frame] - point[:2]))), frame / followed.graph.fps
        arrivals.append(Arrival(off, seconds, np.nan if point.seconds is None else seconds - point.seconds))
    return WaypointWalk(followed, arrivals)


def _places_along(path: GroundPath, points: Array) -> list[float]:
    """Find the metres along the path at which it passes each waypoint, in their order."""
    found, first = [0], 0
    for point in points[1:-1]:
        off = np.hypot(*(path.points[first:] - point).T)
        near = np.flatnonzero(off < off.min() + 0.02)[0]  # the first pass of several
        first += int(near)
        found.append(first)
    return [*path.along[found].tolist(), path.length]
