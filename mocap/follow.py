"""Walking along a path drawn on the ground [KGP02, 5.1], and how well it went."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap.compiling import AHEAD, CompiledGraph, compile_graph, walk_track
from mocap.errors import MocapError, MocapWarning, NoWalk
from mocap.layered_search import Beam, Found, States, search_layers, start_states
from mocap.motion import Motion
from mocap.motion_graph import MotionGraph, Node
from mocap.paths import GroundPath
from mocap.pruning import reached
from mocap.routes import Prices, Route
from mocap.synthesis import to_motion
from mocap.transforms import PlanarTransform
from mocap.walks import Edge

Array = NDArray[np.float64]
Points = NDArray[np.complex128]
Indices = NDArray[np.intp]

SPACING = 0.02  # metres between the points of a route
ASTRAY = 0.15  # metres from the path at which a walk has left it


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
    """

    labels: Sequence[tuple[float, str]] = ()
    times: Sequence[tuple[float, float]] = ()
    heading: float | None = None
    start: Node | None = None
    least: float = 0.3
    others: Sequence[Array] = ()
    apart: float = 0.8


class Departure(NamedTuple):
    """Where a walk leaves its path: from and to how far along it, and how far at worst, all in metres."""

    start: float
    end: float
    worst: float


@dataclass(frozen=True, eq=False)
class Followed:
    """A walk along a path, and how well it keeps to it.

    Parameters
    ----------
    graph, path : what was walked through, and along.
    walk : its edges.
    place : lays the walk's first clip at the start of the path.
    track : shape (F, 2), where the root is on the ground, (x, z) in metres.
    along : shape (F,), metres of path by frame.
    off : shape (F,), metres from the path by frame: the nearest point of it within half a metre of `along`.
    unlabelled : shape (F,), the frames without the label asked for.
    found : the search's own account.
    """

    graph: MotionGraph
    path: GroundPath
    walk: list[Edge]
    place: PlanarTransform
    track: Array
    along: Array
    off: Array
    unlabelled: NDArray[np.bool_]
    found: Found

    def motion(self, *, name: str = "walk", clean: bool = False) -> Motion:
        """Play the walk where it follows the path; `clean` as for `synthesis.to_motion`."""
        return to_motion(self.graph, self.walk, name=name, place=self.place, clean=clean)

    @property
    def seconds(self) -> float:
        """How long the motion lasts."""
        return len(self.off) / self.graph.clips[0].fps

    @property
    def seams_a_second(self) -> float:
        """Transitions in a second of motion."""
        kinds = [self.graph.graph.edges[edge]["kind"] for edge in self.walk]
        return kinds.count("transition") / self.seconds

    @property
    def progress(self) -> float:
        """The share of the path that was walked, 1 for all of it."""
        return float(min(1.0, self.along[-1] / self.path.length))

    @property
    def departures(self) -> list[Departure]:
        """List the stretches more than 15 cm off the path."""
        astray = np.concatenate([[False], self.off > ASTRAY, [False]])
        starts, ends = np.flatnonzero(np.diff(astray)).reshape(-1, 2).T
        return [
            Departure(float(self.along[a]), float(self.along[b - 1]), float(self.off[a:b].max()))
            for a, b in zip(starts, ends, strict=True)
        ]

    def report(self) -> str:
        """Tell in one line how well the walk keeps to the path."""
        told = (
            f"{self.seconds:.1f} s along {self.progress:.0%} of {self.path.length:.1f} m, "
            f"{100 * self.off.mean():.1f} cm off on average, {100 * self.off.max():.1f} cm at worst, "
            f"{self.seams_a_second:.2f} seams a second"
        )
        if self.unlabelled.any():
            told += f", {self.unlabelled.sum() / self.graph.clips[0].fps:.1f} s without the label asked for"
        return told + (f"; {self.found.stopped}: the best so far" if self.found.stopped else "")


def follow_path(
    graph: MotionGraph | CompiledGraph,
    path: GroundPath,
    wishes: Wishes | None = None,
    *,
    beam: Beam | None = None,
    prices: Prices | None = None,
) -> Followed:
    """Find a walk whose root, seen from above, follows a path.

    The search is that of `layered_search`; its time is linear in the path's length. Where no clip turns as
    the path does, the walk cuts the corner and comes back; a warning tells where, and how far off it is.

    Parameters
    ----------
    graph : pruned, so that walks do not end; compile it yourself to follow many paths.
    path : where to walk.
    wishes : labels, times and the start.
    beam : how thoroughly to search.
    prices : how much seams and wishes count against the distance.

    Raises
    ------
    NoWalk : for a label that the graph lacks or that cannot be reached, a start outside it, or a dead end.
    MocapError : for a path longer than these clips walk in an hour, and wishes that make no sense.

    Warns
    -----
    MocapWarning : where the walk is more than 15 cm off the path.
    """
    wishes, compiled = wishes or Wishes(), compile_graph(graph)
    route = make_route(compiled, path, wishes)
    starts = start_of(compiled, route, wishes)
    _require_labels(compiled, [label for _, label in sorted(wishes.labels)], starts["node"])
    found = search_layers(compiled, route, starts, beam or Beam(), prices or Prices())
    followed = account(compiled, path, route, found)
    if (departures := followed.departures) and not wishes.others:  # else it gave way
        worst = max(departures, key=lambda d: d.worst)
        warnings.warn(
            f"The walk leaves the path {len(departures)} times, the furthest by {100 * worst.worst:.0f} cm "
            f"at {worst.start:.1f} to {worst.end:.1f} m: no clips turn as it does there.",
            MocapWarning,
            stacklevel=2,
        )
    return followed


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
        label[along >= start - 1e-9] = _label(graph, name)
    ground = np.asarray(points[:, 1] + 1j * points[:, 0])
    clock, others = _clock(along, wishes), _together(wishes.others)
    return Route(ground, float(along[1]), label, clock, wishes.least, others, wishes.apart)


def _together(tracks: Sequence[Array]) -> Points:
    """Put the tracks of others into one array (K, T), as long as the longest: who has arrived, stays."""
    frames = np.arange(max(map(len, tracks), default=1))
    stay = [track[np.minimum(frames, len(track) - 1)] for track in tracks]
    return np.array([track[:, 1] + 1j * track[:, 0] for track in stay], complex).reshape(-1, len(frames))


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


def _label(graph: CompiledGraph, name: str) -> int:
    """Find a label's number, -1 for any."""
    if name and name not in graph.labels:
        have = ", ".join(graph.labels) or "none"
        raise NoWalk(f"No clip of the graph bears the label '{name}'; there are: {have}.")
    return graph.labels.index(name) if name else -1


def start_of(graph: CompiledGraph, route: Route, wishes: Wishes) -> States:
    """Stand at the start of the route, at every node or the one asked for, about to go the way it leads."""
    nodes = np.arange(len(graph.nodes)) if wishes.start is None else np.array([graph.index(wishes.start)])
    first = route.points[: int(0.3 / route.spacing) + 2]
    heading = float(np.angle(first[-1] - first[0])) if wishes.heading is None else wishes.heading
    if not np.isfinite(heading):
        raise MocapError(f"The heading to start in must be a finite number of radians, got {heading}.")
    return start_states(graph, nodes, complex(first[0]), heading)


def _require_labels(graph: CompiledGraph, labels: Sequence[str], starts: Indices) -> None:
    """Raise `NoWalk` unless the labels can be had one after the other."""
    source = graph.source.graph
    nodes = {graph.nodes[start] for start in starts}
    for label in filter(None, labels):
        edges = list(source.out_edges(reached(source, nodes), data=True))
        if not (nodes := {end for _, end, edge in edges if label in edge["labels"]}):
            can = ", ".join(sorted({name for _, _, edge in edges for name in edge["labels"]})) or "none"
            raise NoWalk(f"No walk comes to the label '{label}' from there; it can reach: {can}.")


def account(graph: CompiledGraph, path: GroundPath, route: Route, found: Found) -> Followed:
    """Measure how far a walk is from its path, and where it lacks its label."""
    body, rows = walk_track(graph, found.edges, found.turn, found.move)
    label = route.label[np.minimum(found.along / route.spacing, len(route.points) - 1).astype(np.intp)]
    bears = graph.bears[label, rows] if graph.labels else np.zeros(len(rows), bool)
    return Followed(
        graph.source,
        path,
        [graph.edges[edge] for edge in found.edges],
        PlanarTransform(float(np.angle(found.turn)), found.move.imag, found.move.real),
        np.stack([body.imag, body.real], axis=1),
        found.along,
        _distance(route, body, found.along),
        (label >= 0) & ~bears,
        found,
    )


def _distance(route: Route, body: Points, along: Array) -> Array:
    """Measure how far the body is from the path within half a metre of where it should be."""
    reach = int(0.5 / route.spacing) + 1
    near = (along / route.spacing).astype(np.intp)[:, None] + np.arange(-reach, reach)
    start = route.points[np.clip(near, 0, len(route.points) - 2)]  # (F, pieces)
    piece = route.points[np.clip(near, 0, len(route.points) - 2) + 1] - start
    share = ((body[:, None] - start) * piece.conj()).real / np.abs(piece) ** 2
    return np.asarray(np.abs(body[:, None] - start - np.clip(share, 0, 1) * piece).min(axis=1))
