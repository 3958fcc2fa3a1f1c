"""Lay a walk on a line: any line, rounded where it turns faster than a walk should, with feet that stand."""

from dataclasses import replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Mask, VectorsLike
from mocap._shared.quantities import check_radians
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath, as_path
from mocap.body.motion import Motion
from mocap.editing.edits import raised
from mocap.editing.line_rounding import RoundedLine, round_line
from mocap.editing.path_editing import Ride, moving_frames, plants_kept, ride_of
from mocap.editing.pins import with_plants
from mocap.editing.toes import lowest_allowed
from mocap.editing.turning import lean, slow_down
from mocap.errors import MocapError, shortened, warn
from mocap.feet.footskate import clean_up

LIMIT = float(np.radians(100))  # per second: the fastest that a walk is turned; people reach 90° to 110°
WILD = 2 * np.pi  # per second: faster than anybody who walks turns; walks on lines that turn fast reach 100°
FASTEST = 50.0  # radians per second: a larger `limit` is meant in degrees
FINE = 0.01  # metres between the points of a line from which distances are measured
MOST = 3  # stretches that a report lists


@dataclass(frozen=True, eq=False)
class Bent:
    """A walk laid on a line, and how well it keeps to it; `bend` shows an example.

    Parameters
    ----------
    motion : F frames, with clean feet.
    laid : the same before the clean-up.
    path : the line asked for.
    line : the line that is walked: rounded where needed.
    ride : of the walk, slowed, before it was laid there.
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
        """Metres of the root from the line asked for, shape (F,); the sway alone is 1 to 2 cm on average."""
        line = cKDTree(_reached(self.path, self.ride).resampled(FINE).points)
        return np.asarray(line.query(self.motion.root_positions[:, [0, 2]])[0])

    @cached_property
    def along(self) -> Array:
        """Metres along the line asked for in each frame, shape (F,)."""
        return np.interp(self.walked, self.line.along, self.line.asked)

    @cached_property
    def rounded(self) -> Mask:
        """Whether the line is rounded where the walk is in each frame, shape (F,)."""
        parts = [(start <= self.along) & (self.along <= end) for start, end, _ in self.line.roundings]
        return np.asarray(np.any([np.zeros(len(self.along), bool), *parts], axis=0))

    @cached_property
    def turned(self) -> Array:
        """How fast the walk is turned beyond what it turns by itself, shape (F - 1,), radians per second."""
        source = moving_frames(self.ride.path, self.ride.along)
        target = moving_frames(self.line.path, self.walked)
        return np.diff(np.asarray(target.angle) - source.angle) * self.motion.fps

    def report(self) -> str:
        """Say how well the walk keeps to the line, and where the line was rounded and by how much."""
        as_asked = ~self.rounded if not self.rounded.all() else self.rounded
        distances = 100 * self.off[as_asked]
        fastest = np.degrees(np.abs(self.turned).max(initial=0.0))
        reached = f"{self.along[-1] / self.path.length:.0%} of {self.path.length:.1f} m"
        length = f"{self.motion.duration:.1f} s along {reached}"
        deviation = f"{distances.mean():.1f} cm off on average, {distances.max():.1f} cm at worst"
        plants = f"{plants_kept(self.motion, self.laid):.0%} of the plants kept"
        turned = f"turned by up to {fastest:.0f}° per second"
        return f"{length}, {deviation}{self._rounded_places()}; {turned}, {plants}"

    def _rounded_places(self) -> str:
        """Say where the line was rounded, and by how much; nothing if it was not."""
        roundings = self.line.roundings
        if not roundings:
            return ""
        parts = [f"{a:.1f} to {b:.1f} m by up to {100 * gap:.0f} cm" for a, b, gap in roundings]
        rest = f" and {len(roundings) - MOST} more" if len(roundings) > MOST else ""
        elsewhere = "" if self.rounded.all() else " elsewhere"
        return f"{elsewhere}, rounded at {', '.join(parts[:MOST])}{rest}"


def bend(
    motion: Motion, path: GroundPath | VectorsLike, *, limit: float = LIMIT, ride: Ride | None = None
) -> Bent:
    """Lay a walk on a line, and clean up its feet [Gle01, 5].

    Its own path is taken off and the line put in its place [Gle01]. Ours is that it slows down and leans in
    where the line bends more than its own path, as people do, goes more slowly yet at corners, and that the
    line is rounded where it would still turn too fast. So a captured turn on its own way stays as it is. The
    walk starts where the line starts.

    Parameters
    ----------
    motion : its plants are marked where it has none.
    path : the line, where on the ground it shall be walked, or its points (x, z), metres.
    limit : the fastest that the walk is turned, radians per second; faster only where it turns by itself.
    ride : of the motion, where its path is known better than by `ride_of(motion)`.

    Returns
    -------
    The new motion, as far along the line as the walk is long, and what was measured.

    Raises
    ------
    MocapError : for a motion that goes nowhere, legs that cannot be found, and a limit that is not above 0.

    Warns
    -----
    MocapWarning : for plants that are let go, as by `feet.clean_up`, and for a motion that hardly goes on, so
        that it is turned by more than 360° per second.

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
    check_radians(limit, "limit", largest=FASTEST)
    if not limit > 0:
        raise MocapError(f"A walk is turned by more than 0 radians per second, got limit={limit}.")
    motion = with_plants(motion)
    ride = ride or ride_of(motion)
    line = round_line(_reached(path, ride), ride, motion.fps, limit)
    slowed, *timing = slow_down(motion, ride, line.path, limit)
    walked = timing[1]
    frames = max(2, int(np.searchsorted(walked, line.path.length + 1e-6)))
    slowed = slowed[:frames]
    ridden, walked, angle = (values[:frames] for values in timing)
    target = moving_frames(line.path, walked)
    flat = (target @ moving_frames(ride.path, ridden).inverse()).apply_motion(slowed)
    laid, held = lean(flat, np.asarray(target.angle), angle)
    cleaned = raised(clean_up(laid, held=held), lowest_allowed(slowed))
    bent = Bent(cleaned, laid, path, line, replace(ride, along=ridden), walked)
    fastest = np.abs(bent.turned).max(initial=0.0)
    if fastest > max(WILD, 2 * limit):
        cause = "where it stands, or goes to and fro, its way turns at once; bend a walk that goes on"
        warn(f"'{shortened(motion.name)}' is turned by up to {np.degrees(fastest):.0f}° per second: {cause}.")
    return bent


def _reached(path: GroundPath, ride: Ride) -> GroundPath:
    """Leave out what lies so far along a line that the walk does not come there, however it is rounded.

    Examples
    --------
    >>> [_reached(GroundPath([[0, 0], [0, far]]), Ride(GroundPath([[0, 0], [0, 2]]), np.arange(3.0)))
    ...  for far in (15, 99)]
    [GroundPath(2 points, 15.0 m), GroundPath(2 points, 16.0 m)]
    """
    longest = 3 * ride.path.length + 10.0
    if path.length <= longest:
        return path
    return GroundPath(np.vstack([path.points[path.along < longest], path.at(longest)]))
