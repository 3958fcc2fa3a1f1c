"""What is wished for along a path, and what it costs to go without."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import AHEAD, CompiledGraph
from mocap.graphs.motion_graph import Node

SPACING = 0.02  # metres between the points of a route


@dataclass(frozen=True)
class Wishes:
    """What is asked for beside the path.

    Parameters
    ----------
    labels : (metres, label): from so far along the path on, what kind of motion, as in
        [(0, "walk"), (6, "sneak"), (9, "")]; "" is any kind.
    times : (metres, seconds): when to pass there; between two such places, at a steady pace.
    heading : the direction to start in, radians; by default the path's own.
    start : the node to start at; by default whichever is best.
    least : progress in metres a second that even standing counts as, so that no walk stands for ever.
    others : where others are on the ground in each frame, shape (T, 2) each; at the end they stay.
    apart : metres to keep away from them.

    Notebook: 08-path-synthesis
    """

    labels: Sequence[tuple[float, str]] = ()
    times: Sequence[tuple[float, float]] = ()
    heading: float | None = None
    start: Node | None = None
    least: float = 0.3
    others: Sequence[Array] = ()
    apart: float = 0.8


@dataclass(frozen=True)
class Prices:
    """What counts beside the squared distance from the path, in m² as if in one frame.

    Parameters
    ----------
    seam : a transition.
    match : times the transition's squared distance D: as if the body were off by it for so many frames.
    stray : times the fourth power of the distance in each frame, 1/m²: 100 doubles what 10 cm cost.
    label : a frame without the label asked for.
    late : times the square of the seconds late or early, in each frame.
    crowding : times the square of the metres too near to another, in each frame.

    Notebook: 08-path-synthesis
    """

    seam: float = 0.3
    match: float = 30.0
    stray: float = 100.0
    label: float = 0.1
    late: float = 0.2
    crowding: float = 1.0


@dataclass(frozen=True, eq=False)
class Route:
    """What is wished for along a path, at n points evenly spaced.

    Parameters
    ----------
    points : shape (n,), where to be, as complex z + ix.
    spacing : metres of path from point to point.
    label : shape (n,), the number of the label to bear there, -1 for any.
    clock : shape (n,), when to be there, in seconds; nan for any time.
    least : progress in metres a second that even standing counts as; [KGP02, 5.1] calls it γ.
    others : shape (K, T), where K others are in each frame, to be kept away from by `apart` metres.
    """

    points: Points
    spacing: float
    label: Indices
    clock: Array
    least: float = 0.1
    others: Points = field(default_factory=lambda: np.empty((0, 1), complex))
    apart: float = 0.8

    @property
    def length(self) -> float:
        """Metres from the first point to the last."""
        return (len(self.points) - 1) * self.spacing

    def at(self, along: Array) -> Points:
        """Give the points so many metres along; past the end the last one [KGP02, 5.1]."""
        place = np.clip(along / self.spacing, 0, len(self.points) - 1)
        before = np.minimum(place.astype(np.intp), len(self.points) - 2)
        start = self.points[before]
        return np.asarray(start + (place - before) * (self.points[before + 1] - start))

    def near(self, along: Array) -> Points:
        """Give the sample before, which is quicker."""
        return np.asarray(self.points[self.point(along)])

    def point(self, along: Array) -> Indices:
        """Find the number of the sample before; past the end the last."""
        place = np.maximum(along / self.spacing, 0)
        return np.minimum(place.astype(np.intp), len(self.points) - 1)

    @cached_property
    def ways(self) -> Points:
        """The directions in which the path goes on from its points, of length 1."""
        steps = np.diff(self.points)
        return np.asarray(steps[[*range(len(steps)), -1]] / np.abs(steps[[*range(len(steps)), -1]]))

    @cached_property
    def bare(self) -> bool:
        """Whether nothing but the path itself is wished for."""
        return not len(self.others) and bool((self.label < 0).all() and np.isnan(self.clock).all())


def make_route(graph: CompiledGraph, path: GroundPath, wishes: Wishes) -> Route:
    """Lay out along a path what is wished for there.

    Raises
    ------
    MocapError : for a path longer than these clips walk in an hour, and for wishes that make no sense.
    NoWalk : for a label that the graph lacks.
    """
    _check_length(graph, path)
    if not (np.isfinite(wishes.least) and wishes.least > 0):
        raise MocapError(f"The least progress must be above 0 m/s, got {wishes.least} m/s.")
    for where, what in (*wishes.labels, *wishes.times):
        if not 0 <= where <= path.length:
            raise MocapError(f"'{what}' is asked for {where} m along a path of {path.length:.1f} m.")
    points = path.resampled(SPACING).points
    along = np.linspace(0, path.length, len(points))
    label = np.full(len(points), -1)
    for start, name in sorted(wishes.labels):
        label[along >= start - 1e-9] = graph.label_number(name)
    ground = on_ground(points)
    clock, others = _clock(along, wishes), _together(wishes.others)
    return Route(ground, float(along[1]), label, clock, wishes.least, others, wishes.apart)


def _together(tracks: Sequence[Array]) -> Points:
    """Put the tracks of others into one array (K, T), as long as the longest: who has arrived, stays."""
    frames = np.arange(max(map(len, tracks), default=1))
    stay = [track[np.minimum(frames, len(track) - 1)] for track in tracks]
    return np.array([on_ground(track) for track in stay], complex).reshape(-1, len(frames))


def _check_length(graph: CompiledGraph, path: GroundPath) -> None:
    fastest = float(np.abs(graph.ahead[:, -1] - graph.at).max()) / AHEAD[-1]
    if path.length > 3600 * fastest:
        raise MocapError(
            f"The path is {path.length:.0f} m long, more than these clips walk in an hour "
            f"({3600 * fastest:.0f} m, at {fastest:.2f} m/s): is it in metres?"
        )


def _clock(along: Array, wishes: Wishes) -> Array:
    """Interpolate the times asked for; beyond the first and the last any time will do."""
    if not wishes.times:
        return np.full(len(along), np.nan)
    places, times = np.array(sorted(wishes.times), float).T
    if not (np.isfinite(times).all() and times.min() >= 0 and (np.diff(times) > 0).all()):
        raise MocapError(f"Times must grow along the path from 0 s on, got {times.tolist()}.")
    if (np.diff(places) <= 0).any():
        raise MocapError(f"Two times are asked for in one place: {places.tolist()} m.")
    return np.asarray(np.interp(along, places, times, left=np.nan, right=np.nan))
