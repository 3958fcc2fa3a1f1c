"""A walk that follows a direction: its motion, how it arrives at each point, and what was corrected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices
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
    passing_rotation,
    rotated_about_root,
    wrapped,
)
from mocap.steering.direction_legs import position_of
from mocap.steering.waiting import Hold, held_frames
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
    waited : for how long the body stands there, seconds, nan if no wait is asked for.
    """

    point: DirectedPoint
    second: float
    off: float  # reads: name: public, as `Followed.off`
    turned: float
    late: float
    waited: float = float("nan")


class Piece(NamedTuple):
    """A part of a walk between two frames that are corrected: a leg, or a wait.

    Parameters
    ----------
    start, end : the anchors of its first and last frame, before the body is rotated there.
    rotations : those of the body at both ends, radians, if it is to face another way than clips do.
    through : the anchors of frames between them, in which the walk passes points.
    facing : pairs of a frame between them and the heading of the body there, radians.
    """

    start: Anchor
    end: Anchor
    rotations: tuple[float, float] = (0.0, 0.0)
    through: Sequence[Anchor] = ()
    facing: Sequence[tuple[int, float]] = ()

    @property
    def anchors(self) -> list[Anchor]:
        """All anchors in order."""
        return [self.start, *self.through, self.end]


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
    holds : frames that are added while the body stands, because no clip stands as long.
    waits : for how long the body stands at each point, seconds, nan if no wait is asked for.
    """

    graph: MotionGraph
    direction: Direction
    walk: list[Edge]
    pieces: Sequence[Piece]
    points: Sequence[DirectedPoint]
    passes: Sequence[int]
    stopped: str
    holds: Sequence[Hold] = ()
    waits: Sequence[float] = ()

    def __repr__(self) -> str:
        return f"Directed({self.report()})"

    @cached_property
    def raw(self) -> Motion:
        """The motion before it is corrected, where its first clip is."""
        return self._held(to_motion(self.graph, self.walk))

    def _held(self, motion: Motion) -> Motion:
        """Return the motion of the walk with the frames that are held."""
        return motion.at(held_frames(len(motion), self.holds)) if self.holds else motion

    @property
    def walk_frames(self) -> Indices:
        """The numbers of the frames of the motion that are frames of the walk, and not held."""
        is_held = np.zeros(len(self.raw), bool)
        added_frames = 0
        for hold in self.holds:
            first = hold.frame + added_frames
            is_held[first : first + hold.added] = True
            added_frames += hold.added
        return np.flatnonzero(~is_held)

    @property
    def held_seconds(self) -> float:
        """For how long the body is held in a pose that sways, seconds, because no clip stands as long."""
        return sum(hold.added for hold in self.holds) / self.graph.fps

    @cached_property
    def fitted(self) -> Motion:
        """The motion that meets what is asked for, before the clean-up of its feet."""
        roots = self.raw.root_positions.copy()
        local = self.raw.rotations.copy()
        for piece in self.pieces:
            frames = slice(piece.start.frame, piece.end.frame + 1)
            part = rotated_about_root(self._anchored(piece), self._turns(piece))
            roots[frames] = part.root_positions
            local[frames] = part.rotations
        return replace(self.raw, root_positions=roots, rotations=local)

    def _anchored(self, piece: Piece) -> Motion:
        """Return the motion of a piece that meets its anchors."""
        first = piece.start.frame
        part = self.raw[first : piece.end.frame + 1]
        return fit_to_anchors(part, [anchor._replace(frame=anchor.frame - first) for anchor in piece.anchors])

    def _turns(self, piece: Piece) -> Array:
        """Return the rotation about the root in each frame of a piece, for its ends and its points."""
        part = self._anchored(piece)
        turns = end_rotations(part, *piece.rotations)
        for frame, heading in piece.facing:
            place = frame - piece.start.frame
            error = wrapped(heading - float(headings_in(part[[place]])[0] + turns[place]))
            turns = turns + passing_rotation(part, place, error)
        return turns

    @cached_property
    def corrections(self) -> list[Correction]:
        """The corrections between anchors, except for rotations about the root."""
        parts = [corrections(self.raw, piece.anchors) for piece in self.pieces]
        return [correction for of_piece in parts for correction in of_piece]

    @cached_property
    def turning(self) -> float:
        """The largest angular speed that rotations about the root add to the walk, radians per second."""
        speeds = [0.0]
        for piece in self.pieces:
            if any(piece.rotations) or piece.facing:
                speeds.append(float(np.abs(np.diff(self._turns(piece))).max() * self.raw.fps))
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
        contacts = self._held(to_motion(marked, self.walk)).contacts
        return clean_feet(replace(fitted, contacts=contacts), lowest_heights(marked.clips))

    @cached_property
    def arrivals(self) -> list[Arrived]:
        """How the walk arrives at each point of the direction."""
        track = on_ground(self.fitted.root_positions)
        facing = headings_in(self.fitted[list(self.passes)])
        listed = []
        waits = self.waits or [np.nan] * len(self.points)
        for point, frame, angle, waited in zip(self.points, self.passes, facing, waits, strict=True):
            second = frame / self.raw.fps
            turned = np.nan if point.heading is None else wrapped(angle - point.heading)
            late = np.nan if point.t is None else second - point.t
            distance = float(abs(track[frame] - position_of(point)))
            listed.append(Arrived(point, second, distance, turned, late, waited))
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
        line += f", held for {self.held_seconds:.1f} s while it stands" if self.holds else ""
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
    """Warn if a walk is late or early at a point, off it, or has another heading or wait than asked."""
    delay = f"The walk arrives {abs(arrival.late):.1f} s"
    if arrival.late > LATE:
        warn(f"{delay} later than asked {place}: no clips walk so fast.")
    if arrival.late < -LATE:
        warn(f"{delay} sooner than asked {place}: no clips walk so slowly or stand so long.")
    if abs(arrival.turned) > TILTED:
        angle = np.degrees(abs(arrival.turned))
        warn(f"The body is {angle:.0f}° from the heading asked for {place}: no clips turn so.")
    if arrival.off > OFF:
        warn(f"The walk is {100 * arrival.off:.0f} cm off {place}: no clips turn so sharply.")
    if abs(arrival.waited - arrival.point.wait) > LATE:
        wait = f"A wait of {arrival.point.wait:.1f} s lasts {arrival.waited:.1f} s {place}"
        warn(f"{wait}: the clips there stand so long, or the next time asks for it.")
