"""A walk along a path, and measures of its quality.

A walk is either played as it was found, or bent onto the path by path editing (`bent_following`).
"""

from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask, Points, runs
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, from_ground
from mocap.editing.bending import Bent
from mocap.graphs.compiled_graph import CompiledGraph, walk_track
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.path_objective import Route
from mocap.steering.path_search import Found
from mocap.steering.tuned import TUNED
from mocap.synthesis.walk_to_motion import to_motion


@dataclass(frozen=True, eq=False)
class Followed:
    """A walk along a path, and its distances from the path. `follow_path` has an example.

    Parameters
    ----------
    graph, path : the graph and the path.
    walk : the edges of the walk.
    transform : the planar transform of the walk's first clip to the start of the path.
    track : shape (F, 2), the root's ground positions (x, z), metres.
    along : shape (F,), metres along the path in each frame.
    off : shape (F,), metres, the distance from the path in each frame. The nearest point of the path is
        searched within 0.5 m of `along`.
    off_at_length : shape (F,), metres from the point of the path at equal arc length, as in [KGP02, Eq. 9].
    unlabelled : shape (F,), the frames without the requested label.
    found : the result of the search.
    bent : the motion bent onto the path, or None. For a bent motion, `walk` and `found` are those of the
        search, `track`, `along` and `off` are those of the bent motion, and `transform` is the identity.
    """

    graph: MotionGraph
    path: GroundPath
    walk: list[Edge]
    transform: PlanarTransform
    track: Array
    along: Array
    off: Array  # reads: name: public, and users read it
    off_at_length: Array
    unlabelled: Mask
    found: Found  # reads: name: public, and users read it
    bent: Bent | None = None

    def __repr__(self) -> str:
        distances = f"{100 * self.off.mean():.1f} cm off on average, {100 * self.off.max():.1f} cm at worst"
        seams = f"{self.seams_per_second:.2f} seams per second"
        part = f"{self.seconds:.1f} s along {self.progress:.0%} of {self.path.length:.1f} m"
        return f"Followed({part}, {distances}, {seams}{', bent' if self.bent else ''})"

    def motion(self, *, name: str = "walk", clean: bool | None = None) -> Motion:
        """Return the motion along the path, without foot sliding if `clean` (default: if bent)."""
        if self.bent:
            return replace(self.bent.laid if clean is False else self.bent.motion, name=name)
        return to_motion(self.graph, self.walk, name=name, start=self.transform, clean=bool(clean))

    @property
    def seconds(self) -> float:
        """The duration of the motion."""
        return len(self.off) / self.graph.fps

    @property
    def seams_per_second(self) -> float:
        """The number of transitions per second of motion."""
        kinds = [self.graph.graph.edges[edge]["kind"] for edge in self.walk]
        return kinds.count("transition") / self.seconds

    @property
    def restless(self) -> float:
        """Seams per second, divided by the limit of a good walk, which is 1, or 0.7 if it is bent."""
        return self.seams_per_second / (TUNED.bent_seam_rate if self.bent else TUNED.seam_rate)

    @property
    def far(self) -> float:  # reads: name: public, and users read it
        """The larger of mean distance / 4 cm and worst distance / 15 cm, or 0 for a bent walk."""
        if self.bent:
            return 0.0
        return float(max(self.off.mean() / TUNED.mean_distance, self.off.max() / TUNED.leaves_path))

    @property
    def excess(self) -> float:
        """The larger of `far` and `restless`, at most 1 for a walk that follows its path well."""
        return max(self.far, self.restless)

    @property
    def progress(self) -> float:
        """The fraction of the path that the walk covers, at most 1."""
        return float(min(1.0, self.along[-1] / self.path.length))

    @property
    def departures(self) -> list[tuple[float, float, float]]:
        """The start, end and worst distance of each stretch more than 15 cm off the path, metres."""
        stretches = []
        for start, stop in runs(self.off > TUNED.leaves_path).tolist():
            worst = self.off[start:stop].max()
            stretches.append((self.along[start], self.along[stop - 1], worst))
        return stretches

    def report(self) -> str:
        """Summarise the distances from the path, the rounding of a bent path, and the seams in one line."""
        line = self.bent.report() + "; " if self.bent else self._distances() + ", "
        line += f"{self.seams_per_second:.2f} seams per second"
        if self.unlabelled.any():
            line += f", {self.unlabelled.sum() / self.graph.fps:.1f} s without the label asked for"
        if self.found.stopped:
            line += f"; {self.found.stopped}: the best so far"
        return line

    def _distances(self) -> str:
        """Format the duration, the fraction of the path that was covered, and the distances from it."""
        covered = f"{self.seconds:.1f} s along {self.progress:.0%} of {self.path.length:.1f} m"
        mean = f"{100 * self.off.mean():.1f} cm off on average"
        worst = f"{100 * self.off.max():.1f} cm at worst"
        at_length = f"{100 * self.off_at_length.mean():.1f} cm at equal arc length"
        return f"{covered}, {mean}, {worst} ({at_length})"


def measure_walk(graph: CompiledGraph, path: GroundPath, route: Route, walk: Found) -> Followed:
    """Measure the distances of a walk from its path, and find the frames without the requested label.

    Parameters
    ----------
    graph : the graph of the walk.
    path : the path.
    route : evenly spaced points of the path.
    walk : the result of a search.
    """
    points, rows = walk_track(graph, walk.edges, walk.rotation, walk.translation)
    label = route.label[route.point(walk.along)]
    is_labelled = graph.bears[label, rows] if graph.label_names else np.zeros(len(rows), bool)
    # reads: statement: one field a line
    return Followed(
        graph.source,
        path,
        [graph.edges[edge] for edge in walk.edges],
        PlanarTransform.from_complex(walk.rotation, walk.translation),
        track=from_ground(points),
        along=walk.along,
        off=_distances_from(route, points, walk.along),
        off_at_length=np.abs(points - route.at(np.cumsum(graph.progress[rows]))),
        unlabelled=(label >= 0) & ~is_labelled,
        found=walk,
    )


def _distances_from(route: Route, points: Points, along: Array) -> Array:
    """Compute the distances (F,) of points from a route, of which only segments near `along` are compared."""
    reach = int(TUNED.reach / route.spacing) + 1
    nearby = (along / route.spacing).astype(np.intp)[:, None] + np.arange(-reach, reach)
    nearby = np.clip(nearby, 0, len(route.points) - 2)  # (F, number of segments)
    offset = points[:, None] - route.points[nearby]
    segment = np.diff(route.points)[nearby]
    fraction = np.clip((offset * segment.conj()).real / np.abs(segment) ** 2, 0, 1)
    return np.asarray(np.abs(offset - fraction * segment).min(axis=1))
