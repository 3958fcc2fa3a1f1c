"""Applications of path following: walks through waypoints, and crowds [KGP02, 5.3].

A crowd is a few characters whose given paths may cross. For a group that stays together and must find a path
among obstacles, see `methods.groups`.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.quantities import described
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.body.ground_path import GroundPath, spline
from mocap.errors import MocapError, warn
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.followed import Followed
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import PathRequest, Settings
from mocap.steering.tuned import TUNED

EQUAL = 1e-6  # metres: distances that differ by less are equal, and the shortest wait is preferred


class Waypoint(NamedTuple):
    """A position (x, z) in metres, the label of the motion after it, and the time of arrival.

    The label "" permits any motion, and None any time.

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
    """The distance `off` from a waypoint, metres, the time of arrival, and its delay `late`, seconds.

    The delay is NaN for a waypoint without a time.
    """

    off: float  # reads: name: users read it
    seconds: float
    late: float


def through_waypoints(
    graph: MotionGraph | CompiledGraph, waypoints: Sequence[Waypoint], *, bend: float = 0.0
) -> tuple[Followed, list[Arrival]]:
    """Find a walk through waypoints, with their labels and at their times [KGP02, 5.3].

    The path between them is a spline. If the clips are too slow or too fast for a time, the walk arrives as
    close to it as possible.

    Parameters
    ----------
    graph : pruned.
    waypoints : two or more. Times count from the start of the motion.
    bend : as for `steering.follow_path`.

    Returns
    -------
    The walk, and the arrival at each waypoint.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, for example if a later waypoint has the time 0 s.
    MocapError : for points that are not waypoints.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> _, arrivals = through_waypoints(graph, [Waypoint(0, 0), Waypoint(0.5, 4, seconds=5.0)])
    >>> [bool(arrival.off < 0.3) for arrival in arrivals]
    [True, True]

    Notebook: 08b-steering
    """
    _require_waypoints(waypoints)
    points = np.array([(point.x, point.z) for point in waypoints], float).reshape(-1, 2)
    path = spline(points)
    passed = [0]  # indices of the points at which the path first passes each waypoint, in their order
    for point in points[1:-1]:
        distances = np.hypot(*(path.points[passed[-1] :] - point).T)
        passed.append(passed[-1] + int(first_least(distances, TUNED.passing)))
    places = [*path.along[passed].tolist(), path.length]
    placed = list(zip(places, waypoints, strict=True))
    labels = [(along, point.label) for along, point in placed]
    times = [(along, point.seconds) for along, point in placed if point.seconds is not None]
    if times and waypoints[0].seconds is None:
        times.insert(0, (0.0, 0.0))
    followed = follow_path(graph, path, PathRequest(labels=labels, times=times), bend=bend)
    arrivals = []
    for along, point in placed:
        frame = min(int(np.searchsorted(followed.along, along)), len(followed.along) - 1)
        distance = float(np.hypot(*(followed.track[frame] - (point.x, point.z))))
        seconds = frame / followed.graph.fps
        late = np.nan if point.seconds is None else seconds - point.seconds
        arrivals.append(Arrival(distance, seconds, late))
    return followed, arrivals


def _require_waypoints(waypoints: object) -> None:
    """Raise for a single waypoint instead of a list, and for points (x, z) in a list."""
    needs = "Waypoints are a list of steering.Waypoint(x, z)"
    if isinstance(waypoints, Waypoint) or not isinstance(waypoints, Iterable):
        raise MocapError(f"{needs}, got {described(waypoints)}: write [Waypoint(0, 0), Waypoint(0, 4)].")
    for waypoint in waypoints:
        if not isinstance(waypoint, Waypoint):
            remedy = "write [Waypoint(x, z) for x, z in points]"
            raise MocapError(f"{needs}, got {described(waypoint)} in it: {remedy}.")


class Crowd(NamedTuple):
    """The walks of K characters, each of which first waits in its first pose for `waits` seconds.

    `nearest` (K, K) is the smallest distance between the roots of each pair, metres, inf on the diagonal.
    """

    walks: list[Followed]
    waits: list[float]
    nearest: Array


def walk_crowd(
    graph: MotionGraph | CompiledGraph,
    paths: Sequence[GroundPath],
    *,
    apart: float = 0.8,  # reads: name: users give it as a keyword
) -> Crowd:
    """Find a walk along each path, so that the characters keep a distance from each other [KGP02, 5.3].

    First, each walk is found independently. Then the characters are processed in order. If one comes too near
    to an earlier one, its search is repeated, with a price on each frame that is too near. If this does not
    suffice, it keeps its walk, and waits before it starts until the way is clear. Each character thus gives
    way to all earlier ones. Only the first few search again, because a search takes a second or more: in a
    large crowd, the others wait [ours].

    Parameters
    ----------
    graph : pruned.
    paths : one per character.
    apart : the smallest permitted distance between the roots of any two characters, metres.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`.

    Warns
    -----
    MocapWarning : if two characters still come nearer than `apart`.

    Examples
    --------
    Two paths 9 m apart:

    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> crowd = walk_crowd(graph, [body.GroundPath([[x, 0], [x, 3]]) for x in (0, 9)])
    >>> crowd.waits, bool(crowd.nearest[0, 1] > 8)
    ([0.0, 0.0], True)

    Notebook: 08b-steering
    """
    compiled = compile_graph(graph)
    walks = [follow_path(compiled, path, settings=Settings(width=TUNED.crowd_beam)) for path in paths]
    waits = [0.0] * len(walks)
    tracks = [walk.track for walk in walks]
    detours = 0
    for number, path in enumerate(paths):
        earlier = tracks[:number]
        if not _too_near(_distance(tracks[number], earlier), apart):
            continue
        may_search = detours < TUNED.detours
        given_way = _detour(compiled, path, earlier, apart, 0.0) if may_search else None
        detours += may_search
        if given_way is None or _too_near(_distance(given_way[2], earlier), apart):
            given_way = _wait_for(walks[number], earlier, apart) or _give_way(compiled, path, earlier, apart)
        walks[number], waits[number], tracks[number] = given_way
    nearest = np.array([[_distance(a, [b]) if a is not b else np.inf for b in tracks] for a in tracks])
    if _too_near(nearest.min(initial=np.inf), apart):
        a, b = np.unravel_index(first_least(nearest, EQUAL), nearest.shape)
        distance = f"come as near as {nearest[a, b]:.2f} m, though {apart:.2f} m were asked for"
        warn(f"Characters {a} and {b} {distance}: their paths leave them no room.")
    return Crowd(walks, waits, nearest)


_Waiting = tuple[Followed, float, Array]
"""A walk, the seconds for which the character waits before it, and its track with the wait."""


def _give_way(
    graph: CompiledGraph, path: GroundPath, earlier: Sequence[Array], least_distance: float
) -> _Waiting:
    """Find a walk that keeps away from the tracks of `earlier` characters, with the shortest possible wait.

    If no wait is long enough, the walk with the largest distance is returned, of equal ones that with the
    shortest wait.
    """
    candidates: list[_Waiting] = []
    distances: list[float] = []
    for wait in TUNED.waits:
        candidates.append(_detour(graph, path, earlier, least_distance, wait))
        distances.append(_distance(candidates[-1][2], earlier))
        if not _too_near(distances[-1], least_distance):
            return candidates[-1]
    return candidates[int(first_least(-np.array(distances), EQUAL))]


def _detour(
    graph: CompiledGraph, path: GroundPath, earlier: Sequence[Array], least_distance: float, wait: float
) -> _Waiting:
    """Find a walk after a wait, which leaves its path or slows down near the tracks of earlier characters."""
    free = Settings(rescue=30.0, crowding=60.0, stray=0.0, tries=1, width=3 * TUNED.crowd_beam)
    frames = round(wait * graph.fps)
    tracks = [track[min(frames, len(track) - 1) :] for track in earlier]
    request = PathRequest(others=tracks, apart=1.1 * least_distance)
    walk = follow_path(graph, path, request, settings=free)
    return walk, wait, _after_wait(walk, frames)


def _wait_for(walk: Followed, earlier: Sequence[Array], least_distance: float) -> _Waiting | None:
    """Find the shortest wait after which a walk keeps away from the tracks of earlier characters, if any."""
    step = round(TUNED.wait_step * walk.graph.fps)
    for frames in range(0, max(map(len, earlier)) + step, step):
        track = _after_wait(walk, frames)
        if not _too_near(_distance(track, earlier), least_distance):
            return walk, frames / walk.graph.fps, track
    return None


def _after_wait(walk: Followed, frames: int) -> Array:
    """Return the track of a walk whose first place is repeated for so many frames."""
    return np.concatenate([np.repeat(walk.track[:1], frames, axis=0), walk.track])


def _too_near(distance: float, least_distance: float) -> bool:
    """Return whether a distance is below the least one by more than the tolerance `EQUAL`."""
    return distance < least_distance - EQUAL


def _distance(track: Array, others: Sequence[Array]) -> float:  # reads: name: the tracks of others
    """Return the smallest distance between a track and others, metres. A shorter one is held at its end."""
    distances = [np.inf]
    for other_track in others:
        frames = np.arange(max(len(track), len(other_track)))
        place = track[np.minimum(frames, len(track) - 1)]
        other_place = other_track[np.minimum(frames, len(other_track) - 1)]
        distances.append(float(np.hypot(*(place - other_place).T).min()))
    return min(distances)
