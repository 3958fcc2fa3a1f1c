"""Find a walk along a path on the ground [KGP02, 5.1], and measure how well it follows the path."""

import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, from_ground
from mocap.errors import MocapError, MocapWarning, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph, walk_track
from mocap.graphs.components import reached
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.beam_search import Beam, Found, find_walk
from mocap.steering.path_objective import Prices, Route, Wishes, least_progress, make_route
from mocap.steering.search_states import States, start_states
from mocap.synthesis.walk_to_motion import to_motion

ASTRAY = 0.15  # metres from the path at which a walk has left it
NEAR = 0.04  # metres from the path on average, at most, for a path that is followed well
SEAMS = 1.0  # transitions per second, at most, for a path that is followed well
AGAIN = 1.25  # a repeated search multiplies or divides the price of a seam by this


class Departure(NamedTuple):
    """A stretch where a walk is off its path: its start and end along the path, and the worst distance.

    Examples
    --------
    >>> Departure(start=2.0, end=2.5, worst=0.2).end
    2.5
    """

    start: float
    end: float
    worst: float


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
    """

    graph: MotionGraph
    path: GroundPath
    walk: list[Edge]
    place: PlanarTransform
    track: Array
    along: Array
    off: Array
    off_at_length: Array
    unlabelled: NDArray[np.bool_]
    found: Found

    def motion(self, *, name: str = "walk", clean: bool = False) -> Motion:
        """Turn the walk into a motion along the path; `clean` as for `synthesis.to_motion`."""
        return to_motion(self.graph, self.walk, name=name, place=self.place, clean=clean)

    @property
    def seconds(self) -> float:
        """The duration of the motion."""
        return len(self.off) / self.graph.clips[0].fps

    @property
    def seams_per_second(self) -> float:
        """Transitions per second of motion."""
        kinds = [self.graph.graph.edges[edge]["kind"] for edge in self.walk]
        return kinds.count("transition") / self.seconds

    @property
    def excess(self) -> float:
        """The largest of mean distance / 4 cm, worst distance / 15 cm, and seams per second / 1."""
        return float(max(self.off.mean() / NEAR, self.off.max() / ASTRAY, self.seams_per_second / SEAMS))

    @property
    def progress(self) -> float:
        """The part of the path that was walked, 1 for all of it."""
        return float(min(1.0, self.along[-1] / self.path.length))

    @property
    def departures(self) -> list[Departure]:
        """The stretches more than 15 cm off the path."""
        astray = np.concatenate([[False], self.off > ASTRAY, [False]])
        starts, ends = np.flatnonzero(np.diff(astray)).reshape(-1, 2).T
        return [
            Departure(float(self.along[a]), float(self.along[b - 1]), float(self.off[a:b].max()))
            for a, b in zip(starts, ends, strict=True)
        ]

    def report(self) -> str:
        """Say in one line how well the walk follows the path."""
        line = (
            f"{self.seconds:.1f} s along {self.progress:.0%} of {self.path.length:.1f} m, "
            f"{100 * self.off.mean():.1f} cm off on average, {100 * self.off.max():.1f} cm at worst "
            f"({100 * self.off_at_length.mean():.1f} cm at equal arc length), "
            f"{self.seams_per_second:.2f} seams per second"
        )
        if self.unlabelled.any():
            line += f", {self.unlabelled.sum() / self.graph.clips[0].fps:.1f} s without the label asked for"
        return line + (f"; {self.found.stopped}: the best so far" if self.found.stopped else "")


def follow_path(  # noqa: PLR0913 (where, what for, and how thoroughly)
    graph: MotionGraph | CompiledGraph,
    path: GroundPath,
    wishes: Wishes | None = None,
    *,
    beam: Beam | None = None,
    prices: Prices | None = None,
    tries: int = 3,
) -> Followed:
    """Find a walk whose root, seen from above, follows a path.

    The search is a beam search; its time is linear in the path's length. No single price of a seam suits all
    paths. So where seams are too frequent, or the walk is too far off (`Followed.excess` above 1), the search
    is repeated with a wider beam, and with the price of a seam times or divided by 1.25. The best walk is
    taken. Where no clip turns as the path does, the walk cuts the corner and returns; a warning says where.

    Parameters
    ----------
    graph : pruned, so that walks do not end; compile it yourself to follow many paths.
    path : where to walk.
    wishes : labels, times and the start.
    beam : how thoroughly to search.
    prices : what deviations cost.
    tries : the largest number of searches; 1 for one search with this beam and these prices.

    Returns
    -------
    The walk, and how well it follows the path.

    Raises
    ------
    NoWalk : for a label that no walk can reach, a start that is not in the graph, or a dead end.
    MocapError : for a path longer than these clips walk in an hour, and wishes that make no sense.

    Warns
    -----
    MocapWarning : where the walk is more than 15 cm off the path.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> followed = follow_path(graph, body.GroundPath([[0, 0], [0, 6]]))
    >>> followed.progress, bool(followed.off.mean() < 0.05)
    (1.0, True)

    Notebook: 08-path-synthesis
    """
    wishes, compiled = wishes or Wishes(), compile_graph(graph)
    if tries < 1:
        raise MocapError(f"A path takes at least one search, got tries={tries}.")
    route = make_route(compiled, path, wishes)
    starts = start_of(compiled, route, wishes)
    _require_labels(compiled, [label for _, label in sorted(wishes.labels)], starts.node)

    def search(beam: Beam, prices: Prices) -> Followed:
        return account(compiled, path, route, find_walk(compiled, route, starts, beam, prices))

    beam = replace(beam or Beam(), width=(beam or Beam()).width_on(route))
    followed = _best_of(search, beam, prices or Prices(), tries)
    if not wishes.others:  # with others it leaves the path to give way
        _warn(followed.departures)
    return followed


def _best_of(search: Callable[[Beam, Prices], Followed], beam: Beam, prices: Prices, tries: int) -> Followed:
    """Search; while `excess` is above 1, search again with a wider beam and another price of a seam."""
    begun = time.monotonic()
    best = last = search(beam, prices)
    for again in range(1, tries):
        if best.excess <= 1 or last.found.stopped:
            return best
        seam = prices.seam * (AGAIN if best.seams_per_second > SEAMS else 1 / AGAIN)
        left = beam.seconds - (time.monotonic() - begun)
        wider = replace(beam, width=round((1 + again / 2) * (beam.width or 0)), seconds=left)
        try:
            last = search(wider, replace(prices, seam=seam))
        except NoWalk:  # the time was over before the first step
            return best
        best = min(best, last, key=lambda walk: (walk.progress < 1, walk.excess))
    return best


def _warn(departures: Sequence[Departure]) -> None:
    """Warn where a walk leaves its path."""
    if departures:
        worst = max(departures, key=lambda d: d.worst)
        warnings.warn(
            f"The walk leaves the path {len(departures)} times, the furthest by {100 * worst.worst:.0f} cm "
            f"at {worst.start:.1f} to {worst.end:.1f} m: no clips turn as it does there.",
            MocapWarning,
            stacklevel=3,
        )


def start_of(graph: CompiledGraph, route: Route, wishes: Wishes) -> States:
    """Start at the first point of the route, at every node or the one asked for, in the route's direction."""
    nodes = np.arange(len(graph.nodes)) if wishes.start is None else np.array([graph.index(wishes.start)])
    first = route.points[: int(0.3 / route.spacing) + 2]
    heading = float(np.angle(first[-1] - first[0])) if wishes.heading is None else wishes.heading
    if not np.isfinite(heading):
        raise MocapError(f"The heading to start in must be a finite number of radians, got {heading}.")
    return start_states(graph, nodes, complex(first[0]), heading)


def _require_labels(graph: CompiledGraph, labels: Sequence[str], starts: Indices) -> None:
    """Raise `NoWalk` unless a walk can reach the labels one after the other."""
    source = graph.source.graph
    nodes = {graph.nodes[start] for start in starts}
    for label in filter(None, labels):
        edges = list(source.out_edges(reached(source, nodes), data=True))
        if not (nodes := {end for _, end, edge in edges if label in edge["labels"]}):
            can = ", ".join(sorted({name for _, _, edge in edges for name in edge["labels"]})) or "none"
            raise NoWalk(f"No walk comes to the label '{label}' from there; it can reach: {can}.")


def account(graph: CompiledGraph, path: GroundPath, route: Route, found: Found) -> Followed:
    """Measure how far a walk is from its path, and find the frames without the label asked for."""
    body, rows = walk_track(graph, found.edges, found.turn, found.move)
    label = route.label[np.minimum(found.along / route.spacing, len(route.points) - 1).astype(np.intp)]
    bears = graph.labels.bears[label, rows] if graph.labels.names else np.zeros(len(rows), bool)
    return Followed(
        graph.source,
        path,
        [graph.edges[edge] for edge in found.edges],
        PlanarTransform.from_complex(found.turn, found.move),
        from_ground(body),
        found.along,
        _distance(route, body, found.along),
        np.abs(body - route.at(np.cumsum(least_progress(graph, route)[rows]))),
        (label >= 0) & ~bears,
        found,
    )


def _distance(route: Route, body: Points, along: Array) -> Array:
    """Measure the distance of the body from the path within 0.5 m of where it should be."""
    reach = int(0.5 / route.spacing) + 1
    near = (along / route.spacing).astype(np.intp)[:, None] + np.arange(-reach, reach)
    start = route.points[np.clip(near, 0, len(route.points) - 2)]  # (F, pieces)
    piece = route.points[np.clip(near, 0, len(route.points) - 2) + 1] - start
    share = ((body[:, None] - start) * piece.conj()).real / np.abs(piece) ** 2
    return np.asarray(np.abs(body[:, None] - start - np.clip(share, 0, 1) * piece).min(axis=1))
