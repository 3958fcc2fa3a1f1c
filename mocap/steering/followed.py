"""What was found along a path, and how well it follows the path."""

from dataclasses import dataclass, replace

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, from_ground
from mocap.editing.bending import Bent
from mocap.graphs.compiled_graph import CompiledGraph, walk_track
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.path_objective import Route
from mocap.steering.path_search import Found
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
        return to_motion(self.graph, self.walk, name=name, place=self.place, clean=bool(clean))

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
    body, rows = walk_track(graph, found.edges, found.turn, found.move)
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
    walk, place = [graph.edges[edge] for edge in found.edges], (found.turn, found.move)
    laid = (walk, PlanarTransform.from_complex(*place), from_ground(body), found.along)
    return Followed(graph.source, path, *laid, off, at_length, (label >= 0) & ~bears, found)
