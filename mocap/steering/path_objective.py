"""The path objective: a path, the wishes along it, and the price of each deviation from them."""

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
from mocap.graphs.motion_graph import Node
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering.tuned import TUNED


@dataclass(frozen=True)
class Wishes:
    """What a walk is asked for beside the path.

    In the paper: [KGP02, labels].

    Parameters
    ----------
    labels : (metres, label): the kind of motion from this place on the path, as in
        [(0, "walk"), (6, "sneak"), (9, "")]; "" is any kind.
    times : (metres, seconds): when to pass a place on the path; between two places the pace is steady.
    start : the node to start at; by default the best one.
    slide : the share of the distance to the point of the path abreast of the body by which s moves after each
        hop; 0 keeps s the arc length, as in [KGP02, Eq. 9].
    others : tracks of others on the ground, shape (T, 2) each, one row per frame; each stays at its end.
    apart : metres to keep away from them.

    Examples
    --------
    Sneak from 6 m along the path on, and pass 8 m at 10 s:

    >>> Wishes(labels=[(6, "sneak")], times=[(0, 0), (8, 10)]).apart
    0.8

    Notebook: 08-path-synthesis
    """

    labels: Sequence[tuple[float, str]] = ()
    times: Sequence[tuple[float, float]] = ()
    start: Node | None = None
    slide: float = 0.5
    others: Sequence[Array] = ()  # reads: name: users give it as a keyword
    apart: float = 0.8  # reads: name: users give it as a keyword


@dataclass(frozen=True)
class Settings:
    """How thoroughly to search, and what deviations cost.

    The unit of prices is m², because a frame that is d metres off the path costs d². With
    `Settings(seam=0, match=0, stray=0)` the distance is all that a walk pays for, as in [KGP02, Eq. 9].

    Parameters
    ----------
    seam : the price of each transition.
    match : times D, a transition's cost in m²; 30 is the price of 30 frames that are √D off the path.
    stray : times d⁴ in each frame, 1/m²; with 100, the cost of a frame 10 cm off the path is doubled.
    label : for each frame without the label asked for.
    late : times the square of the seconds late or early, in each frame.
    crowding : times the square of the metres too near to another, in each frame.
    bend : of walks that are laid on the path: times the square of the radians per second by which a frame is
        turned beyond what it turns itself.
    width : walks that stay in each layer; by default 100, or 50 where the path is the only wish.
    alike : walks at one node, in one cell of so many metres and so many radians, stand alike.
    rescue : the largest expected cost of a walk that is about to leave the path, m².
    tries : the largest number of searches; 1 for one search with this width and these prices.
    progress : wraps the layers, to show a bar.
    deadline : seconds of wall time, from the call of `follow_path`, after which its searches end. The best
        walk so far is returned, with a warning that says how much of the path it covers. To measure the walk
        comes on top, and to bend it: 0.7 s for a walk of 50 m.

    Examples
    --------
    Fewer transitions, further from the path:

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
    bend: float = 0.05
    width: int | None = None
    alike: float = 0.1
    rescue: float = 1.5
    tries: int = 3
    progress: Progress = iter
    deadline: float = np.inf

    def width_on(self, route: Route) -> int:
        """Return the width, or its default for a route."""
        return self.width or (50 if route.bare else 100)


@dataclass(frozen=True, eq=False)
class Route:
    """A path and the wishes along it, at n evenly spaced points.

    Parameters
    ----------
    points : shape (n,), the path on the ground as complex z + ix.
    spacing : metres of path from point to point.
    label : shape (n,), the number of the label asked for, -1 for any.
    clock : shape (n,), the time to be there, seconds; nan for any time.
    wishes : the wishes.
    others : shape (K, T), where K others are in each frame.
    own, turns : if walks are bent onto the path, the smooth paths of their clips, from `smooth_graph`.
    curvature : shape (n,), there, how the path bends at each point, radians per metre.

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
    wishes: Wishes = field(default_factory=Wishes)
    # reads: name: as in `Wishes`
    others: Points = field(default_factory=lambda: np.empty((0, 1), complex))
    own: CompiledGraph | None = None  # reads: name: public, and goes with the next renaming
    turns: Array = field(default_factory=lambda: np.zeros(0))
    curvature: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def length(self) -> float:
        """Metres from the first point to the last."""
        return (len(self.points) - 1) * self.spacing

    def at(self, along: Array) -> Points:  # reads: name: as of a `GroundPath`
        """Interpolate the points at some metres along; past the end it is the last point [KGP02, 5.1]."""
        place = np.clip(along / self.spacing, 0, len(self.points) - 1)
        piece = np.minimum(place.astype(np.intp), len(self.points) - 2)
        start = self.points[piece]
        return np.asarray(start + (place - piece) * (self.points[piece + 1] - start))

    def point(self, along: Array) -> Indices:
        """Find the point before each place, which is faster than to interpolate; past the end the last."""
        place = np.maximum(along / self.spacing, 0)
        return np.minimum(place.astype(np.intp), len(self.points) - 1)

    @cached_property
    def directions(self) -> Points:
        """The direction of the path after each point, as complex numbers of length 1."""
        steps = np.diff(self.points)
        steps = np.append(steps, steps[-1])
        return np.asarray(steps / np.abs(steps))

    @cached_property
    def bare(self) -> bool:
        """True if nothing but the path is asked for."""
        return not len(self.others) and bool((self.label < 0).all() and np.isnan(self.clock).all())


def make_route(graph: CompiledGraph, path: GroundPath, wishes: Wishes) -> Route:
    """Lay out a path and the wishes along it as a route.

    Raises
    ------
    MocapError : for a path longer than these clips walk in an hour, and for wishes that make no sense.
    NoWalk : for a label that no clip of the graph has.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> route = make_route(graph, GroundPath([[0, 0], [0, 6]]), Wishes(labels=[(4, "walk")]))
    >>> route.label[route.point(np.array([3.9, 4.1]))].tolist()
    [-1, 0]
    """
    fastest = float(np.abs(graph.ahead[:, -1] - graph.at).max()) / GRAPH_TUNED.ahead[-1]
    if path.length > 3600 * fastest:
        hour = f"takes these clips more than an hour, at {fastest:.2f} m/s at most"
        raise MocapError(f"A path of {path.length:.0f} m {hour}: is it in metres, and do they walk?")
    for place, wish in (*wishes.labels, *wishes.times):
        if not 0 <= place <= path.length:
            raise MocapError(f"'{wish}' is asked for {place} m along a path of {path.length:.1f} m.")
    points = path.resampled(TUNED.route_spacing).points
    along = np.linspace(0, path.length, len(points))
    label = np.full(len(points), -1)
    for start, name in sorted(wishes.labels):
        label[along >= start - 1e-9] = graph.label_number(name)
    # The tracks of others, as long as the longest; others stay at their end.
    frames = np.arange(max(map(len, wishes.others), default=1))
    tracks = [on_ground(track[np.minimum(frames, len(track) - 1)]) for track in wishes.others]
    together = np.array(tracks, complex).reshape(-1, len(frames))
    return Route(on_ground(points), float(along[1]), label, _clock(along, wishes), wishes, together)


def _clock(along: Array, wishes: Wishes) -> Array:
    """Interpolate the times asked for; nan (any time) before the first and after the last."""
    if not wishes.times:
        return np.full(len(along), np.nan)
    places, times = np.array(sorted(wishes.times), float).T
    if not (np.isfinite(times).all() and times.min() >= 0 and (np.diff(times) > 0).all()):
        raise MocapError(f"Times must grow along the path from 0 s on, got {times.tolist()}.")
    if (np.diff(places) <= 0).any():
        raise MocapError(f"Two times are asked for in one place: {places.tolist()} m.")
    return np.asarray(np.interp(along, places, times, left=np.nan, right=np.nan))
