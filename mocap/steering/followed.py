"""What was found along a path: as it is, or laid on any line, and how well it follows [Gle01].

A walk from the graph turns only where its clips turn; path editing can turn it further. So a search for a
walk that is bent asks by how much it must be turned beyond what it turns by itself, not how far it strays.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, runs
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, PlanarTransform, from_ground, heading, on_ground
from mocap.editing.bending import Bent, bend
from mocap.editing.line_rounding import round_line
from mocap.editing.path_editing import Ride, moving_frames, ride_of
from mocap.editing.turning import places_on
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph, walk_track
from mocap.graphs.edge_tables import Edge, clip_rows
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.path_objective import Route, Wishes, make_route
from mocap.steering.path_search import SLOWEST, Found, too_slow
from mocap.synthesis.walk_to_motion import to_motion

ASTRAY = 0.15  # metres from the path at which a walk has left it
NEAR = 0.04  # metres from the path on average, at most, for a path that is followed well
SEAMS, BENT_SEAMS = 1.0, 0.7  # transitions per second, at most, of such a walk, and of one that is bent


@dataclass(frozen=True, eq=False)
class Followed:
    """A walk along a path, and how well it follows the path; `follow_path` shows an example.

    Parameters
    ----------
    graph, path : the graph and the path.
    walk : its edges.
    place : lays the walk's first clip at the start of the path.
    track : shape (F, 2), where the root is on the ground, (x, z) in metres.
    along : shape (F,), metres along the path in each frame.
    off : shape (F,), metres from the path in each frame: from its nearest point within 0.5 m of `along`.
    off_at_length : shape (F,), metres from the point of the path at equal arc length, as in [KGP02, Eq. 9].
    unlabelled : shape (F,), the frames without the label asked for.
    found : the result of the search.
    bent : how the walk was laid on the path, or None. If it was, `walk` and `found` are of the search, and
        `track`, `along` and `off` of the motion on the path; `place` is the identity, as none lays it there.
    """

    graph: MotionGraph
    path: GroundPath
    walk: list[Edge]
    place: PlanarTransform
    track: Array
    along: Array
    off: Array
    off_at_length: Array
    unlabelled: Mask
    found: Found
    bent: Bent | None = None

    def motion(self, *, name: str = "walk", clean: bool | None = None) -> Motion:
        """Give the motion along the path, its feet cleaned if `clean` says so; by default if it is bent."""
        if self.bent:
            return replace(self.bent.laid if clean is False else self.bent.motion, name=name)
        return to_motion(self.graph, self.walk, name=name, start=self.place, clean=bool(clean))

    @property
    def seconds(self) -> float:
        """The duration of the motion."""
        return len(self.off) / self.graph.fps

    @property
    def seams_per_second(self) -> float:
        """Transitions per second of motion."""
        kinds = [self.graph.graph.edges[edge]["kind"] for edge in self.walk]
        return kinds.count("transition") / self.seconds

    @property
    def restless(self) -> float:
        """Seams per second / 1, or / 0.7 if it is bent."""
        return self.seams_per_second / (BENT_SEAMS if self.bent else SEAMS)

    @property
    def far(self) -> float:
        """The larger of mean distance / 4 cm and worst distance / 15 cm; 0 if it is bent."""
        return 0.0 if self.bent else float(max(self.off.mean() / NEAR, self.off.max() / ASTRAY))

    @property
    def excess(self) -> float:
        """The larger of how `far` and how `restless` it is."""
        return max(self.far, self.restless)

    @property
    def progress(self) -> float:
        """The part of the path that was walked, 1 for all of it."""
        return float(min(1.0, self.along[-1] / self.path.length))

    @property
    def departures(self) -> list[tuple[float, float, float]]:
        """The stretches more than 15 cm off the path: starts and ends along it, worst distances."""
        stretches = runs(self.off > ASTRAY).tolist()
        return [(self.along[a], self.along[b - 1], self.off[a:b].max()) for a, b in stretches]

    def report(self) -> str:
        """Say in one line how well the walk follows the path; if it is bent, also where that was rounded."""
        line = (
            f"{self.seconds:.1f} s along {self.progress:.0%} of {self.path.length:.1f} m, "
            f"{100 * self.off.mean():.1f} cm off on average, {100 * self.off.max():.1f} cm at worst "
            f"({100 * self.off_at_length.mean():.1f} cm at equal arc length), "
        )
        line = f"{self.bent.report()}; " if self.bent else line
        line += f"{self.seams_per_second:.2f} seams per second"
        if self.unlabelled.any():
            line += f", {self.unlabelled.sum() / self.graph.fps:.1f} s without the label asked for"
        return line + (f"; {self.found.stopped}: the best so far" if self.found.stopped else "")


def account(graph: CompiledGraph, path: GroundPath, route: Route, found: Found) -> Followed:
    """Measure how far a walk is from its path, and find the frames without the label asked for."""
    body, rows = walk_track(graph, found.edges, found.rotation, found.translation)
    label = route.label[route.point(found.along)]
    bears = graph.bears[label, rows] if graph.label_names else np.zeros(len(rows), bool)
    # The distance is that from the path within 0.5 m of where the body should be, shape (F, pieces).
    reach = int(0.5 / route.spacing) + 1
    near = (found.along / route.spacing).astype(np.intp)[:, None] + np.arange(-reach, reach)
    near = np.clip(near, 0, len(route.points) - 2)
    away, piece = body[:, None] - route.points[near], np.diff(route.points)[near]
    share = np.clip((away * piece.conj()).real / np.abs(piece) ** 2, 0, 1)
    off = np.abs(away - share * piece).min(axis=1)
    at_length = np.abs(body - route.at(np.cumsum(graph.progress[rows])))
    walk, place = [graph.edges[edge] for edge in found.edges], (found.rotation, found.translation)
    laid = (walk, PlanarTransform.from_complex(*place), from_ground(body), found.along)
    return Followed(graph.source, path, *laid, off, at_length, (label >= 0) & ~bears, found)


# Metres, and a share of the line: how far the search goes on beyond its end; the rest is cut.
FURTHER = (0.5, 0.02)


@lru_cache(maxsize=2)  # to find it again makes following a line of 17 m a fifth slower
def own_paths(graph: CompiledGraph) -> tuple[CompiledGraph, Array]:
    """Put the path of every edge in the place of the way of the root, which sways about it.

    The path is that of `editing.ride_of`, so that the sway of the body is no turning. In a transition both
    clips' headings are blended as their poses are; the difference of the two is turned through as well.

    Returns
    -------
    The graph, whose `ground`, `step` and `going` are those of the paths; and by how many radians each of its
    frames turns along them, (T,).

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_circle"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> own, turns = own_paths(graph)
    >>> len(turns) == len(own.step) == len(graph.step)
    True
    """
    clips = graph.source.clips
    heads, along, *place = np.concatenate([_ride(clip) for clip in clips], axis=1)
    points = on_ground(np.stack(place, axis=1))
    steps = np.diff(along, prepend=along[0])
    steps[np.cumsum([0, *map(len, clips[:-1])])] = 0.0
    starts, weight = graph.first, 1 - graph.alpha
    here, there = clip_rows(clips, graph.here), clip_rows(clips, graph.there)
    other = heads[there] + np.angle(graph.rotation)[graph.of]
    apart = (other - heads[here] + np.pi) % (2 * np.pi) - np.pi
    head = heads[here] + np.where(weight > 0, weight * apart, 0.0)
    turns = np.diff(head, prepend=0.0)
    turns[starts] = head[starts] - heads[clip_rows(clips, graph.here[starts] - np.array([0, 1]))]
    step = graph.alpha * steps[here] + weight * steps[there]
    laid = graph.rotation[graph.of] * points[there] + graph.translation[graph.of]
    ground = graph.alpha * points[here] + weight * laid
    going = heads[clip_rows(clips, np.array(graph.nodes))]
    return replace(graph, ground=ground, step=step, going=going), turns


def own_ride(own: CompiledGraph, edges: Indices) -> Ride:
    """Join the paths of the clips that a walk plays to one path, and say where on it each frame is.

    The graph is that of `own_paths`.

    A spline through the whole walk would be too slow where a seam leads from a bend to the left into one to
    the right: the walk strays from its own path there, and from a line on which it is laid, by up to 10 cm.
    """
    points, _ = walk_track(own, edges, 1.0, 0.0)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    return Ride(GroundPath(from_ground(points)), along)


def _ride(clip: Motion) -> Array:
    """Give the heading of a clip's path, the metres along it, and its x and z, (4, F).

    Of a clip that stands it is how the body faces and where it is.
    """
    try:
        ride = ride_of(clip)
    except MocapError:
        x, _, z = clip.root_positions.T
        return np.stack([np.unwrap(heading(clip.rotations[:, 0])), np.zeros(len(clip)), x, z])
    frames = moving_frames(ride.path, ride.along)
    return np.stack([np.asarray(frames.angle), ride.along, *ride.path.at(ride.along).T])


def plan_bending(
    graph: CompiledGraph, path: GroundPath, wishes: Wishes, limit: float
) -> tuple[Route, Callable[[Found], Followed]]:
    """Round a path for the usual pace of some clips, and lay out the wishes along it.

    Parameters
    ----------
    graph, path, wishes : as for `follow_path`.
    limit : the fastest that a walk is turned, radians per second.

    Returns
    -------
    The route, which is rounded, so that the search reckons with what can be turned, and goes a little
    further; and how to lay a walk that was found on the path.

    Raises
    ------
    MocapError : for a limit that is not above 0, and wishes that make no sense.
    NoWalk : for a label that no clip of the graph has, and clips that only stand.
    """
    if not limit > 0:
        raise MocapError(f"A walk is bent by more than 0 radians per second, got bend={limit}.")
    make_route(graph, path, wishes)  # which refuses what is too long, and what is asked for off the path
    own, turns = own_paths(graph)
    walks = own.step[own.step * graph.fps > SLOWEST]
    if not len(walks):
        raise too_slow(graph)
    # Straight on, at the clips' usual pace, and far enough for shorter steps.
    steady = np.arange(0.0, 2 * path.length + 2.0, float(np.median(walks)))
    pace = Ride(GroundPath(np.array([[0.0, 0.0], [0.0, steady[-1]]])), steady)
    line = round_line(path, pace, graph.fps, limit)

    def rounded(where: float) -> float:
        return float(np.interp(where, line.asked, line.along))

    labels = [(rounded(where), label) for where, label in wishes.labels]
    times = [(rounded(where), seconds) for where, seconds in wishes.times]
    wishes = replace(wishes, labels=labels, times=times, slide=0.0)
    points = line.path.points
    way = points[-1] - points[-2]
    # A slower walk, or one that turns by itself, needs less rounding, so that its line is longer.
    further = FURTHER[0] + (1 + FURTHER[1]) * max(path.length, line.path.length) - line.path.length
    longer = GroundPath(np.vstack([points, points[-1] + further * way / np.hypot(*way)]))
    along, ratio = places_on(longer, pace, graph.fps, limit)
    route = _in_own_metres(make_route(graph, longer, wishes), longer, along, ratio, steady)
    return replace(route, own=own, turns=turns), partial(_lay, graph, path, wishes, limit)


def _in_own_metres(route: Route, path: GroundPath, there: Array, ratio: Array, steady: Array) -> Route:
    """Space a route by the metres and the seconds that a walk takes before it is slowed for the bends."""
    most = float(np.interp(path.length, there, steady))
    own = np.linspace(0.0, most, len(route.points))
    along, slower = (np.interp(own, steady, some) for some in (there, np.sqrt(ratio)))
    point = route.point(along)
    clock = route.clock[point]
    late = np.nancumsum(np.diff(clock, prepend=clock[:1]) * slower)
    clock = np.where(np.isnan(clock), np.nan, late + np.nanmin([*clock, np.inf]))
    angle = np.asarray(moving_frames(path, along).angle)
    points, label, bends = on_ground(path.at(along)), route.label[point], np.gradient(angle, own)
    return replace(route, points=points, spacing=own[1], label=label, clock=clock, curvature=bends)


def _lay(graph: CompiledGraph, path: GroundPath, wishes: Wishes, limit: float, found: Found) -> Followed:
    """Lay a walk that was found on the path, and measure how well it follows."""
    walk = [graph.edges[edge] for edge in found.edges]
    ride = own_ride(own_paths(graph)[0], found.edges)
    bent = bend(to_motion(graph.source, walk), path, limit=limit, ride=ride)
    played = np.searchsorted(ride.along, bent.ride.along[-1])
    walk = walk[: int(np.searchsorted(np.cumsum(graph.frames[found.edges]), played)) + 1]
    track = bent.motion.root_positions[:, [0, 2]]
    at_length = np.hypot(*(track - path.at(bent.walked)).T)
    unlabelled = np.zeros(len(track), bool)
    for where, label in sorted(wishes.labels):
        there = bent.walked >= where
        bears = bent.motion.labels.get(label, np.zeros(len(track), bool))
        unlabelled[there] = bool(label) & ~bears[there]
    place = (graph.source, path, walk, IDENTITY)
    return Followed(*place, track, bent.along, bent.off, at_length, unlabelled, found, bent)
