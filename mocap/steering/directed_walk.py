"""A walk that follows a direction: its motion, how it arrives at each point, and what was corrected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from mocap._shared.records import NamedTuple, dataclass
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.editing.bending import LIMIT
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.toes import lowest_heights
from mocap.errors import warn
from mocap.files.directions import DirectedPoint, Direction
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.anchoring import (
    Anchor,
    Correction,
    corrections,
    end_rotations,
    fit_to_anchors,
    headings_in,
    rotate_at_ends,
    wrapped,
)
from mocap.steering.direction_legs import position_of
from mocap.synthesis.walk_to_motion import to_motion, with_footplants

FAST = 1.05  # times the limit of added rotation, above which it is reported
LATE = 0.3  # seconds, beyond which a delay is reported
OFF = 0.1  # metres
TILTED = np.radians(10)  # radians
UNSEEN = np.radians(45)  # radians that steps may be turned in all before a warning
UNSEEN_FRACTION = 0.1  # of the distance travelled by which steps may be longer or shorter before a warning
CORRECTED = 0.01  # metres or radians: a larger correction moves feet, which are cleaned up


class Arrived(NamedTuple):
    """How a walk arrives at a point of its direction.

    Parameters
    ----------
    point : the point.
    second : the time of arrival.
    off : the distance of the root from it, metres.
    turned : the error of the heading, radians, nan if none is asked for.
    late : the delay, seconds, nan if no time is asked for.
    """

    point: DirectedPoint
    second: float
    off: float  # reads: name: public, as `Followed.off`
    turned: float
    late: float


class Piece(NamedTuple):
    """A part of a walk between two frames that are corrected: a leg, or a wait.

    Parameters
    ----------
    start, end : the anchors of its first and last frame, before the body is rotated there.
    rotations : those of the body at both ends, radians, if it is to face another way than clips do.
    """

    start: Anchor
    end: Anchor
    rotations: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Directed:
    """A walk that follows a direction; `direct` shows an example.

    Parameters
    ----------
    graph : the graph with its standing stretches.
    direction : the direction.
    walk : the edges of the walk.
    pieces : its legs and waits, with the positions and headings to be met at their ends.
    points : the points of the direction; those in one place are one.
    passes : the frame in which the walk passes each of them.
    stopped : "", or the reason for which a search ended early.
    """

    graph: MotionGraph
    direction: Direction
    walk: list[Edge]
    pieces: Sequence[Piece]
    points: Sequence[DirectedPoint]
    passes: Sequence[int]
    stopped: str

    def __repr__(self) -> str:
        return f"Directed({self.report()})"

    @cached_property
    def raw(self) -> Motion:
        """The motion before it is corrected, where its first clip is."""
        return to_motion(self.graph, self.walk)

    @cached_property
    def fitted(self) -> Motion:
        """The motion that meets what is asked for, before the clean-up of its feet."""
        roots = self.raw.root_positions.copy()
        local = self.raw.rotations.copy()
        for piece in self.pieces:
            frames = slice(piece.start.frame, piece.end.frame + 1)
            part = rotate_at_ends(self._anchored(piece), *piece.rotations)
            roots[frames] = part.root_positions
            local[frames] = part.rotations
        return replace(self.raw, root_positions=roots, rotations=local)

    def _anchored(self, piece: Piece) -> Motion:
        """Return the motion of a piece that meets its anchors."""
        first = piece.start.frame
        part = self.raw[first : piece.end.frame + 1]
        ends = [anchor._replace(frame=anchor.frame - first) for anchor in (piece.start, piece.end)]
        return fit_to_anchors(part, ends)

    @cached_property
    def corrections(self) -> list[Correction]:
        """The correction in each piece, except for the rotations at its ends."""
        return [corrections(self.raw, [piece.start, piece.end])[0] for piece in self.pieces]

    @cached_property
    def turning(self) -> float:
        """The largest angular speed that the rotations at ends add to the walk, radians per second."""
        speeds = [0.0]
        for piece in self.pieces:
            if any(piece.rotations):
                turn = end_rotations(self._anchored(piece), *piece.rotations)
                speeds.append(float(np.abs(np.diff(turn)).max() * self.raw.fps))
        return max(speeds)

    @property
    def rotated(self) -> list[tuple[str, float]]:
        """The rotations of the body where it "starts" or "stops", which no steps make, in radians.

        They are those of headings of more than 30° to the line, because clips mostly start and stop straight
        ahead.
        """
        ends: list[tuple[str, float]] = []
        for piece in self.pieces:
            ends += zip(("starts", "stops"), piece.rotations, strict=True)
        return [(end, angle) for end, angle in ends if angle]

    def motion(self, *, name: str = "walk", clean: bool | None = None) -> Motion:
        """Return the motion, without foot sliding if `clean` (default: if its steps were corrected)."""
        fitted = replace(self.fitted, name=name)
        if clean is None:
            moved = any(max(part.metres, abs(part.radians)) > CORRECTED for part in self.corrections)
            clean = moved or self.turning > 0
        if not clean:
            return fitted
        marked = with_footplants(self.graph)
        contacts = to_motion(marked, self.walk).contacts
        return clean_feet(replace(fitted, contacts=contacts), lowest_heights(marked.clips))

    @cached_property
    def arrivals(self) -> list[Arrived]:
        """How the walk arrives at each point of the direction."""
        track = on_ground(self.fitted.root_positions)
        facing = headings_in(self.fitted[list(self.passes)])
        listed = []
        for point, frame, angle in zip(self.points, self.passes, facing, strict=True):
            second = frame / self.raw.fps
            turned = np.nan if point.heading is None else wrapped(angle - point.heading)
            late = np.nan if point.t is None else second - point.t
            distance = float(abs(track[frame] - position_of(point)))
            listed.append(Arrived(point, second, distance, turned, late))
        return listed

    @property
    def entered(self) -> float:
        """The largest depth of the root in a disc, metres; 0 if it enters none."""
        track = on_ground(self.fitted.root_positions)
        discs = self.direction.around
        depths = [radius - np.abs(track - complex(z, x)).min() for x, z, radius in discs]
        return float(max([0.0, *depths]))

    def report(self) -> str:
        """Summarise the walk in one line: its duration, the largest errors, and the corrections."""
        last = self.arrivals[-1]
        line = f"{len(self.raw) / self.raw.fps:.1f} s, ends {100 * last.off:.0f} cm from the last point"
        turned = [abs(arrival.turned) for arrival in self.arrivals if np.isfinite(arrival.turned)]
        late = [abs(arrival.late) for arrival in self.arrivals if np.isfinite(arrival.late)]
        line += f", headings within {np.degrees(max(turned)):.0f}°" if turned else ""
        line += f", times within {max(late):.1f} s" if late else ""
        metres = max((part.metres for part in self.corrections), default=0.0)
        angle = max((abs(part.radians) for part in self.corrections), default=0.0)
        line += f"; steps corrected by {100 * metres:.0f} cm and {np.degrees(angle):.0f}° in all"
        line += f", turned by up to {np.degrees(self.turning):.0f}°/s" if self.turning else ""
        return f"{line}; {self.stopped}: the best so far" if self.stopped else line


def warn_of_misses(directed: Directed) -> None:
    """Warn of each point at which the walk is off what is asked for, and of large corrections."""
    for number, arrival in enumerate(directed.arrivals, 1):
        _warn_of_arrival(arrival, f"at point {number} (x = {arrival.point.x:g}, z = {arrival.point.z:g})")
    for part in directed.corrections:
        if abs(part.radians) > UNSEEN or part.metres > OFF + UNSEEN_FRACTION * part.travelled:
            turn = f"{np.degrees(abs(part.radians)):.0f}° and {100 * part.metres:.0f} cm"
            warn(
                f"Steps are corrected by {turn} over {part.travelled:.1f} m: no clips stop or turn as asked."
            )
    if directed.turning > FAST * LIMIT:
        speed = f"{np.degrees(directed.turning):.0f}° per second"
        warn(f"The body is turned by up to {speed}, faster than people turn: leave it more room.")


def _warn_of_arrival(arrival: Arrived, place: str) -> None:
    """Warn if a walk is late or early at a point, or has another heading than asked."""
    delay = f"The walk arrives {abs(arrival.late):.1f} s"
    if arrival.late > LATE:
        warn(f"{delay} later than asked {place}: no clips walk so fast.")
    if arrival.late < -LATE:
        warn(f"{delay} sooner than asked {place}: no clips walk so slowly or stand so long.")
    if abs(arrival.turned) > TILTED:
        angle = np.degrees(abs(arrival.turned))
        warn(f"The body is {angle:.0f}° from the heading asked for {place}: no clips turn so.")
