"""The path objective: a path, the requests along it, and the price of each deviation from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap._shared.progress import Progress
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import Node
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering.tuned import TUNED


@dataclass(frozen=True)
class PathRequest:
    """Requests for a walk in addition to the path: labels, times, a start, and others to avoid.

    In the paper: [KGP02, labels].

    Parameters
    ----------
    labels : pairs (metres, label): the kind of motion from this arc length of the path, as in
        [(0, "walk"), (6, "sneak"), (9, "")]; "" is any kind.
    times : pairs (metres, seconds): the time at which an arc length of the path is reached, interpolated
        linearly between them.
    start : the node at which the walk starts, by default the best one.
    correction : the fraction by which the arc length s moves, after each macro-edge, to the projection of the
        body on the path. With 0, s is the arc length of the walk, as in [KGP02, Eq. 9].
    others : tracks of other bodies on the ground, shape (T, 2) each, with a row for each frame. A body stays
        at the end of its track.
    apart : the distance to keep from them, metres.
    kept : edges of an earlier walk. Frames of other edges cost `Settings.change` each, so that the walk stays
        as it was where it can.

    Examples
    --------
    Sneak from 6 m along the path, and pass 8 m at 10 s:

    >>> PathRequest(labels=[(6, "sneak")], times=[(0, 0), (8, 10)]).apart
    0.8

    Notebook: 08-path-synthesis
    """

    labels: Sequence[tuple[float, str]] = ()
    times: Sequence[tuple[float, float]] = ()
    start: Node | None = None
    correction: float = 0.5
    others: Sequence[Array] = ()  # reads: name: users give it as a keyword
    apart: float = 0.8  # reads: name: users give it as a keyword
    kept: Sequence[Edge] = ()


@dataclass(frozen=True)
class Settings:
    """The effort of the search, and the prices of deviations from the path and the requests.

    The unit of prices is m², because the cost of a frame at distance d from the path is d². With
    `Settings(seam=0, match=0, stray=0)` only the distance has a cost, as in [KGP02, Eq. 9].

    Parameters
    ----------
    seam : the price of each transition.
    match : factor of D, the squared RMS distance of a transition; 30 is the price of 30 frames at distance √D
        from the path.
    stray : factor of d⁴ in each frame, 1/m²; with 100, the cost of a frame 10 cm off the path is doubled.
    label : the price of each frame without the requested label.
    late : factor of the squared delay (or advance) in seconds, in each frame.
    crowding : factor of the squared shortfall of the distance to another body in metres, in each frame.
    change : the price of each frame of an edge that is not in `PathRequest.kept`, if that is given.
    bend : for walks that are bent onto the path, factor of the squared angular velocity in radians per second
        that bending adds, in each frame.
    width : the beam width, by default 100, or 50 if there are no requests beside the path.
    cell : the size of cells in metres and in radians. Of the walks at one node in one cell, only the best is
        kept.
    rescue : the largest expected cost of a walk that is about to leave the path, m².
    tries : the largest number of searches; 1 for a single search with this width and these prices.
    progress : wraps the iterable of layers, to show a progress bar.
    deadline : seconds of wall time from the call of `follow_path`, after which its searches end. The best
        walk so far is returned, with a warning that reports the length of path that it covers. Measuring and
        bending the walk takes additional time: 0.7 s for a walk of 50 m.

    Examples
    --------
    A higher price results in fewer transitions and a larger distance from the path:

    >>> Settings(seam=1.0).seam
    1.0

    Notebook: 08-path-synthesis
    """

    seam: float = 0.3
    match: float = 30.0
    stray: float = 100.0
    label: float = 0.1
    late: float = 0.2
    crowding: float = 1.0
    change: float = 0.02
    bend: float = 0.05
    width: int | None = None
    cell: float = 0.1
    rescue: float = 1.5
    tries: int = 3
    progress: Progress = iter
    deadline: float = np.inf

    def width_on(self, route: Route) -> int:
        """Return the width, or its default for a route."""
        return self.width or (50 if route.bare else 100)


@dataclass(frozen=True, eq=False)
class Route:
    """A path and the requests along it, sampled at n evenly spaced points.

    Parameters
    ----------
    points : shape (n,), the path on the ground as complex z + ix.
    spacing : the arc length between two points, metres.
    label : shape (n,), the number of the requested label, -1 for any.
    clock : shape (n,), the requested time at a point, seconds, nan for any time.
    request : the requests.
    others : shape (K, T), the positions of K other bodies in each frame.
    smooth, rotations : for walks that are bent onto the path, the graph with smoothed paths of its clips, and
        the rotations of its frames, from `smooth_graph`.
    curvature : for walks that are bent, shape (n,), the curvature of the path, radians per metre.

    Examples
    --------
    >>> route = Route(np.array([0, 1, 2j + 1]), 1.0, np.full(3, -1), np.full(3, np.nan))
    >>> route.length, route.at(np.array([0.5, 9.0])).tolist(), route.bare
    (2.0, [(0.5+0j), (1+2j)], True)
    """

    points: Points
    spacing: float
    label: Indices
    clock: Array
    request: PathRequest = field(default_factory=PathRequest)
    # reads: name: as in `PathRequest`
    others: Points = field(default_factory=lambda: np.empty((0, 1), complex))
    smooth: CompiledGraph | None = None
    rotations: Array = field(default_factory=lambda: np.zeros(0))
    curvature: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def length(self) -> float:
        """The arc length of the path, metres."""
        return (len(self.points) - 1) * self.spacing

    def at(self, along: Array) -> Points:  # reads: name: as of a `GroundPath`
        """Interpolate the path at arc lengths, clamped to its ends [KGP02, 5.1]."""
        place = np.clip(along / self.spacing, 0, len(self.points) - 1)
        piece = np.minimum(place.astype(np.intp), len(self.points) - 2)
        start = self.points[piece]
        return np.asarray(start + (place - piece) * (self.points[piece + 1] - start))

    def point(self, along: Array) -> Indices:
        """Return the index of the last point before each arc length, which is faster than interpolation."""
        place = np.maximum(along / self.spacing, 0)
        return np.minimum(place.astype(np.intp), len(self.points) - 1)

    @cached_property
    def directions(self) -> Points:
        """The directions of the path after each point, unit complex numbers."""
        steps = np.diff(self.points)
        steps = np.append(steps, steps[-1])
        return np.asarray(steps / np.abs(steps))

    @cached_property
    def bare(self) -> bool:
        """Whether there are no requests beside the path."""
        if self.request.kept:
            return False
        return not len(self.others) and bool((self.label < 0).all() and np.isnan(self.clock).all())


def make_route(graph: CompiledGraph, path: GroundPath, request: PathRequest) -> Route:
    """Sample a path and the requests along it as a route.

    Raises
    ------
    MocapError : for a path longer than these clips walk in an hour, and for invalid requests.
    NoWalk : for a label that no clip of the graph has.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> route = make_route(graph, GroundPath([[0, 0], [0, 6]]), PathRequest(labels=[(4, "walk")]))
    >>> route.label[route.point(np.array([3.9, 4.1]))].tolist()
    [-1, 0]
    """
    fastest = float(np.abs(graph.ahead[:, -1] - graph.at).max()) / GRAPH_TUNED.ahead[-1]
    if path.length > 3600 * fastest:
        hour = f"takes these clips more than an hour, at {fastest:.2f} m/s at most"
        raise MocapError(f"A path of {path.length:.0f} m {hour}: is it in metres, and do they walk?")
    for place, requested in (*request.labels, *request.times):
        if not 0 <= place <= path.length:
            raise MocapError(f"'{requested}' is asked for {place} m along a path of {path.length:.1f} m.")
    points = path.resampled(TUNED.route_spacing).points
    along = np.linspace(0, path.length, len(points))
    label = np.full(len(points), -1)
    for start, name in sorted(request.labels):
        label[along >= start - 1e-9] = graph.label_number(name)
    # All tracks are extended to the length of the longest by repeating their last positions.
    frames = np.arange(max(map(len, request.others), default=1))
    tracks = [on_ground(track[np.minimum(frames, len(track) - 1)]) for track in request.others]
    together = np.array(tracks, complex).reshape(-1, len(frames))
    return Route(on_ground(points), float(along[1]), label, _clock(along, request), request, together)


def _clock(along: Array, request: PathRequest) -> Array:
    """Interpolate the requested times, nan (any time) before the first and after the last."""
    if not request.times:
        return np.full(len(along), np.nan)
    places, times = np.array(sorted(request.times), float).T
    if not (np.isfinite(times).all() and times.min() >= 0 and (np.diff(times) > 0).all()):
        raise MocapError(f"Times must grow along the path from 0 s on, got {times.tolist()}.")
    if (np.diff(places) <= 0).any():
        raise MocapError(f"Two times are asked for in one place: {places.tolist()} m.")
    return np.asarray(np.interp(along, places, times, left=np.nan, right=np.nan))
