"""Bend a walk to any line, rounded where a walk would turn too fast on it, with feet that stand."""

from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Mask, VectorsLike
from mocap._shared.quantities import check_radians
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath, as_path
from mocap.body.motion import Motion
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.line_rounding import RoundedLine, round_line
from mocap.editing.path_editing import Ride, moving_frames, plants_kept, ride_of
from mocap.editing.pins import with_plants
from mocap.editing.tuned import TUNED
from mocap.editing.turning import SlowedWalk, lean, slow_down
from mocap.errors import MocapError, shortened, warn

LIMIT = TUNED.turning_limit  # radians per second
WARNED = 2 * np.pi  # radians per second: no walk turns faster; on lines that turn fast, walks reach 1.7
LARGEST = 50.0  # radians per second: a larger `limit` is meant in degrees
FINE = 0.01  # metres between the points of a line from which distances are computed
LONGEST_CUT = 3.0  # times the path of a walk, and `SLACK` more: no rounding makes a line so much shorter
SLACK = 10.0  # metres
LISTED = 3  # rounded intervals that a report lists
TOLERANCE = 1e-6  # metres, for the end of a line


@dataclass(frozen=True, eq=False)
class Bent:
    """A walk bent to a line, and its distances from the line; `bend` shows an example.

    Parameters
    ----------
    motion : F frames, after the clean-up.
    laid : the same before the clean-up.
    path : the requested line.
    line : the line that is walked, rounded where needed.
    ride : the path of the slowed walk before it was bent, and the metres along it in each frame.
    walked : shape (F,), metres along the line that is walked.
    """

    motion: Motion
    laid: Motion
    path: GroundPath
    line: RoundedLine
    ride: Ride
    walked: Array

    def __repr__(self) -> str:
        line = f"{self.along[-1] / self.path.length:.0%} of {self.path.length:.1f} m"
        return f"Bent({self.motion!r}, {line}, {100 * self.off.mean():.1f} cm off on average)"

    # reads: name: public, as `Followed.off`
    @cached_property
    def off(self) -> Array:
        """Distances of the root from the requested line, (F,), metres; sway alone makes 1 to 2 cm."""
        line = cKDTree(_reached(self.path, self.ride).resampled(FINE).points)
        return np.asarray(line.query(self.motion.root_positions[:, [0, 2]])[0])

    @cached_property
    def along(self) -> Array:
        """Metres along the requested line in each frame, shape (F,)."""
        return np.interp(self.walked, self.line.along, self.line.requested)

    @cached_property
    def rounded(self) -> Mask:
        """Whether the line is rounded at the position of each frame, shape (F,)."""
        parts = [(start <= self.along) & (self.along <= end) for start, end, _ in self.line.roundings]
        return np.asarray(np.any([np.zeros(len(self.along), bool), *parts], axis=0))

    @cached_property
    def turned(self) -> Array:
        """Turning rate of the line minus that of the walk by itself, shape (F - 1,), radians per second.

        The limit of `bend` is for the turning rate of the line, so that a walk that turns by itself to the
        other side is turned by more.
        """
        source = moving_frames(self.ride.path, self.ride.along)
        target = moving_frames(self.line.path, self.walked)
        return np.diff(np.asarray(target.angle) - source.angle) * self.motion.fps

    def report(self) -> str:
        """Describe in a sentence the distances from the line, its rounded intervals, and the turning rate."""
        counted = ~self.rounded if not self.rounded.all() else self.rounded
        distances = 100 * self.off[counted]
        fastest = np.degrees(np.abs(self.turned).max(initial=0.0))
        reached = f"{self.along[-1] / self.path.length:.0%} of {self.path.length:.1f} m"
        length = f"{self.motion.duration:.1f} s along {reached}"
        deviation = f"{distances.mean():.1f} cm off on average, {distances.max():.1f} cm at worst"
        plants = f"{plants_kept(self.motion, self.laid):.0%} of the plants kept"
        turned = f"turned by up to {fastest:.0f}° per second"
        return f"{length}, {deviation}{self._rounded_places()}; {turned}, {plants}"

    def _rounded_places(self) -> str:
        """List the rounded intervals, and the distances between both lines; "" if there are none."""
        roundings = self.line.roundings
        if not roundings:
            return ""
        parts = [f"{a:.1f} to {b:.1f} m by up to {100 * distance:.0f} cm" for a, b, distance in roundings]
        rest = f" and {len(roundings) - LISTED} more" if len(roundings) > LISTED else ""
        elsewhere = "" if self.rounded.all() else " elsewhere"
        return f"{elsewhere}, rounded at {', '.join(parts[:LISTED])}{rest}"


def bend(
    motion: Motion, path: GroundPath | VectorsLike, *, limit: float = LIMIT, ride: Ride | None = None
) -> Bent:
    """Bend a walk to a line, and clean up its feet [Gle01, 5].

    The walk is taken relative to its own path, and put on the line [Gle01]. Ours is that it slows down and
    leans in where the line bends more than its own path, as people do, and more at corners, and that the line
    is rounded where the walk would still turn too fast. So a captured turn on its own path is not changed.
    The walk starts where the line starts.

    Parameters
    ----------
    motion : F frames; its footplants are marked where it has none.
    path : the line on the ground, or its points (x, z), metres.
    limit : the largest turning rate on the line, radians per second; a walk that turns by itself may add as
        much to the same side.
    ride : the path of the motion, if it is known better than by `ride_of(motion)`.

    Returns
    -------
    The new motion, as far along the line as the walk is long, and its distances from the line.

    Raises
    ------
    MocapError : for a motion that does not travel, legs that are not found, and a limit that is not above 0.

    Warns
    -----
    MocapWarning : for footplants that are released, as by `feet.clean_up`, and for a motion that hardly
        travels, so that it turns by more than 360° per second.

    Examples
    --------
    >>> from mocap.body import GroundPath
    >>> from mocap.datasets import sample
    >>> bent = bend(sample("walk_straight")[:600], GroundPath([[0, 0], [0, 2], [2, 4]]))
    >>> print(bent.report())  # doctest: +ELLIPSIS
    3.9 s along 100% of 4.8 m, 1.5 cm off on average, 2.7 cm at worst; turned by up to 91° per second, ...
    >>> zigzag = GroundPath([[0, 0], [2, 0.5], [0, 1], [2, 1.5], [0, 2], [2, 2.5]])
    >>> print(bend(sample("walk_straight")[:600], zigzag).report())
    7.2 s along 42% of 10.3 m, 1.5 cm off on average, 3.1 cm at worst elsewhere, rounded at 1.9 to 2.8 m by
    up to 36 cm, 4.0 to 4.8 m by up to 37 cm, 6.0 to 6.9 m by up to 35 cm and 2 more; turned by up to 100°
    per second, 100% of the plants kept

    Notebook: 12-path-editing
    """
    path = as_path(path)
    check_radians(limit, "limit", largest=LARGEST)
    if not limit > 0:
        raise MocapError(f"A walk is turned by more than 0 radians per second, got limit={limit}.")
    motion = with_plants(motion)
    ride = ride or ride_of(motion)
    line = round_line(_reached(path, ride), ride, motion.fps, limit)
    slowed = slow_down(motion, ride, line.path, limit)
    frames = max(2, int(np.searchsorted(slowed.along, line.path.length + TOLERANCE)))
    slowed = SlowedWalk._make(values[:frames] for values in slowed)
    target = moving_frames(line.path, slowed.along)
    source = moving_frames(ride.path, slowed.source_along)
    upright = (target @ source.inverse()).apply_motion(slowed.motion)
    laid, held = lean(upright, np.asarray(target.angle), slowed.lean)
    cleaned = clean_feet(laid, original=slowed.motion, held=held)
    bent = Bent(cleaned, laid, path, line, replace(ride, along=slowed.source_along), slowed.along)
    fastest = np.abs(bent.turned).max(initial=0.0)
    if fastest > max(WARNED, 2 * limit):
        cause = "where it stands, or goes to and fro, its way turns at once; bend a walk that goes on"
        warn(f"'{shortened(motion.name)}' is turned by up to {np.degrees(fastest):.0f}° per second: {cause}.")
    return bent


def _reached(path: GroundPath, ride: Ride) -> GroundPath:
    """Cut a line behind the part that a walk reaches, even after rounding.

    Examples
    --------
    >>> ride = Ride(GroundPath([[0, 0], [0, 2]]), np.arange(3.0))
    >>> [_reached(GroundPath([[0, 0], [0, metres]]), ride) for metres in (15, 99)]
    [GroundPath(2 points, 15.0 m), GroundPath(2 points, 16.0 m)]
    """
    longest = LONGEST_CUT * ride.path.length + SLACK
    if path.length <= longest:
        return path
    return GroundPath(np.vstack([path.points[path.along < longest], path.at(longest)]))
