"""Round a line where a walk would turn too fast on it, such as a corner, or the cusp of a heart."""

from functools import cached_property

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import maximum_filter1d
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.ground_path import GroundPath
from mocap.editing.path_editing import Ride, moving_frames
from mocap.editing.tuned import TUNED
from mocap.editing.turning import places_on, slowed_frames
from mocap.feet.ankle_targets import bending_bands

FINE = 10  # times as many points as in a rounded line, for distances from it
SEEN = 0.01  # metres: a line that is moved by less is not reported as rounded
JOINED = 0.5  # metres: rounded intervals nearer to each other are reported as one


class RoundedLine(NamedTuple):
    """A line that is rounded where needed, at n points at even distances on the requested line.

    Parameters
    ----------
    path : the rounded line.
    along : shape (n,), metres along the rounded line.
    requested : shape (n,), metres along the requested line.
    moved : shape (n,), metres between the two lines: the larger of the distances from each to the other.

    Examples
    --------
    >>> along = np.array([0, 1, 2, 2.1, 2.25, 2.5, 2.75])
    >>> moved = np.array([0, 0.3, 0.4, 0, 0.2, 0.01, 0.015])
    >>> RoundedLine(GroundPath([[0, 0], [0, 3]]), along, along, moved).roundings  # 25 cm apart is one, 50 not
    [(1.0, 2.25, 0.4), (2.75, 2.75, 0.015)]
    """

    path: GroundPath
    along: Array
    requested: Array
    moved: Array

    @property
    def roundings(self) -> list[tuple[float, float, float]]:
        """The intervals moved by more than 1 cm: start and end, metres along the line, and the distance."""
        rounded = np.flatnonzero(self.moved > SEEN)
        is_gap = (np.diff(rounded) > 1) & (np.diff(self.requested[rounded]) >= JOINED)
        intervals = [part for part in np.split(rounded, np.flatnonzero(is_gap) + 1) if len(part)]
        starts = [float(self.requested[interval[0]]) for interval in intervals]
        ends = [float(self.requested[interval[-1]]) for interval in intervals]
        distances = [float(self.moved[interval].max()) for interval in intervals]
        return list(zip(starts, ends, distances, strict=True))


@dataclass(frozen=True, eq=False)
class _Walk:
    """A walk whose turning rate is limited: its ride, frames per second, and radians per second."""

    ride: Ride
    fps: float
    limit: float

    @cached_property
    def radius(self) -> float:
        """The radius at which the walk turns by the limit, at its slowest, metres."""
        # v₀ q(1/r) / r = limit, with q of `turning`, solved for r.
        longest_step = np.diff(self.ride.along).max(initial=0.0)
        straight = TUNED.corner_ratio * longest_step * self.fps / self.limit
        law = TUNED.bend_radius  # R of the law
        squared = (np.sqrt(law**4 + 4 * straight**4) - law**2) / 2
        return float(max(TUNED.tightest_radius, np.sqrt(squared)))

    def _rates(self, path: GroundPath, along: Array) -> Array:
        """Compute turning rates between frames at metres along a path, (F - 1,), radians per second."""
        return np.diff(moving_frames(path, along).angle) * self.fps

    def too_fast(self, line: GroundPath, metres: Array) -> Indices:
        """Find the points of a line, at `metres` along it, where the walk would turn too fast."""
        along, ratio = places_on(line, self.ride, self.fps, self.limit)
        frames = slowed_frames(ratio)
        numbers = np.arange(len(ratio))
        along = np.interp(frames, numbers, along)
        along = along[along <= metres[-1]]  # a rounded line is shorter
        rates = self._rates(line, along)
        source_along = np.interp(frames[: len(along)], numbers, self.ride.along)
        same_side = np.sign(rates) * self._rates(self.ride.path, source_along)
        is_too_fast = np.abs(rates) > self.limit + np.maximum(same_side, 0)
        return np.unique(np.searchsorted(metres, along[1:][is_too_fast]))


def round_line(path: GroundPath, ride: Ride, fps: float, limit: float) -> RoundedLine:
    """Round a line where a walk on it would turn faster than a limit.

    The line is the smoothest of those near the requested points p_k, a Whittaker-Henderson smoother:
    min Σ |x_k - p_k|² + Σ λ_k |x_{k-1} - 2 x_k + x_{k+1}|², a linear system with five diagonals. λ_k = r_k⁴
    is small at first. Where a frame of the walk turns too fast, the reach r grows, and the line is computed
    again. The walk slows down in bends, and more at corners, as in `turning`. It may turn by the limit, and
    by as much more as it turns there by itself to the same side. A line on which it does is not changed.
    If that is not enough, at corners near each other, or cuts off too much, where the line comes back on
    itself, the line is pursued by a walk that turns by the limit at most, which makes loops.

    Parameters
    ----------
    path : the requested line.
    ride : the path of the walk, and the metres along it in each frame.
    fps : frames per second of the walk.
    limit : the largest turning rate, radians per second, above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.path_editing import ride_of
    >>> walk = sample("walk_straight")
    >>> corner = GroundPath([[0, 0], [0, 5], [6, -3]])
    >>> line = round_line(corner, ride_of(walk), walk.fps, np.radians(60))
    >>> start, end, worst = line.roundings[0]
    >>> round(start), round(end), round(worst, 1)
    (5, 6, 0.5)
    """
    even = path.resampled(TUNED.line_spacing)
    walk = _Walk(ride, fps, limit)
    if not len(walk.too_fast(path, even.along)):
        return RoundedLine(path, even.along, even.along, np.zeros(len(even.points)))
    spacing = path.length / (len(even.points) - 1)
    points, is_slow_enough = _widened(even.points, spacing, walk)
    rounded = _compared(path, even, points, even.along)
    is_cut = rounded.moved.max() > max(TUNED.largest_cut * walk.radius, TUNED.chord)
    if is_slow_enough and not is_cut and rounded.path.length > TUNED.least_length * path.length:
        return rounded
    positions, points = _pursued(even.points, spacing, TUNED.loop_radius * (walk.radius / spacing))
    smooth = _smoothed(points, np.full(len(points), (TUNED.line_reach / spacing) ** 4))
    return _compared(path, even, smooth, spacing * positions)


def _widened(requested: Array, spacing: float, walk: _Walk) -> tuple[Array, bool]:
    """Smooth a line with a wider and wider reach where a walk turns too fast on it.

    Around such a place the reach grows within a chord. With the distance from there it decreases linearly.

    Parameters
    ----------
    requested : points (n, 2), metres.
    spacing : metres between them.
    walk : the walk.

    Returns
    -------
    The smooth line, (n, 2), and whether the walk turns slowly enough on it.
    """
    reach = np.full(len(requested), TUNED.line_reach / spacing)  # in points
    largest = TUNED.widest_reach * walk.radius / spacing
    slope = TUNED.reach_slope * np.arange(len(requested))
    while True:
        line = _smoothed(requested, reach**4)
        too_fast = walk.too_fast(GroundPath(line), _metres_along(line))
        growing = too_fast[reach[too_fast] < largest]
        if not len(growing):
            return line, not len(too_fast)
        grown = np.zeros(len(reach))
        grown[growing] = TUNED.reach_growth * reach[growing]
        grown = maximum_filter1d(grown, 2 * round(TUNED.chord / TUNED.line_spacing) + 1)
        from_behind = np.maximum.accumulate(grown + slope) - slope
        from_ahead = np.maximum.accumulate((grown - slope)[::-1])[::-1] + slope
        reach = np.maximum(reach, np.maximum(from_ahead, from_behind))


def _compared(path: GroundPath, even: GroundPath, line: Array, positions: Array) -> RoundedLine:
    """Compute the distances between a rounded line and the requested one, at metres along the latter."""
    rounded = GroundPath(line)
    missed = np.interp(positions, even.along, _distances(even.points, rounded))
    moved = np.maximum(_distances(line, path), missed)
    return RoundedLine(rounded, _metres_along(line), positions, moved)


def _distances(points: Array, path: GroundPath) -> Array:
    """Compute the distances of points (n, 2) from a path, (n,), metres."""
    tree = cKDTree(path.resampled(TUNED.line_spacing / FINE).points)
    return np.asarray(tree.query(points)[0])


def _metres_along(points: Array) -> Array:
    """Compute the arc length up to each of n points, (n,), metres."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def _pursued(points: Array, step: float, radius: float) -> tuple[Array, Array]:
    """Pursue a line: walk towards a point ahead on it, in bends no tighter than a radius.

    The curvature towards the goal is that of pure pursuit for small angles (R. C. Coulter, *Implementation of
    the Pure Pursuit Path Tracking Algorithm*, 1992), clipped to the least radius.

    Parameters
    ----------
    points : shape (n, 2), the points of the line.
    step : metres between them, and between two points of the walk.
    radius : the least radius, in steps.

    Returns
    -------
    The position on the line that belongs to each point of the walk, in steps, and these points, metres.

    Examples
    --------
    >>> there_and_back = np.array([[0, 0], [0, 1], [0, 2], [0, 3], [0.1, 2], [0.2, 1]])
    >>> positions, walk = _pursued(there_and_back, step=1.0, radius=1.0)
    >>> positions.tolist(), walk[3:, 1].round(1).tolist()
    ([0.0, 0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 4.5, 5.0], [3.0, 3.5, 3.1, 2.1, 1.5, 1.2])
    """
    last = len(points) - 1
    ahead = max(1, round(TUNED.pursuit_distance * radius))
    point = points[0]
    position = 0.0
    heading = np.arctan2(*(points[1] - point))
    positions = [position]
    walk = [point]
    while position < last:
        start = int(position)
        distances = np.hypot(*(points[start : start + ahead + 1] - point).T)
        nearest = start + float(distances.argmin())
        position = min(max(position + TUNED.pursuit_step, nearest), last)
        to_goal = points[min(int(position) + ahead, last)] - point
        deviation = np.pi - (np.pi + heading - np.arctan2(*to_goal)) % (2 * np.pi)  # in (-π, π]
        rotation = 2 * deviation * step / max(np.hypot(*to_goal), step)
        heading += np.clip(rotation, -1 / radius, 1 / radius)
        point = point + step * np.array([np.sin(heading), np.cos(heading)])
        positions.append(position)
        walk.append(point)
    return np.array(positions), np.array(walk)


def _smoothed(points: Array, weight: Array) -> Array:
    """Solve (I + Dᵀ Λ D) x = p, where D takes second differences; `weight` (n,) is Λ, unused at the ends.

    Examples
    --------
    >>> _smoothed(np.array([[0.0, 0], [0, 3], [0, 0]]), np.full(3, 0.5))[:, 1].round(6).tolist()
    [0.75, 1.5, 0.75]
    """
    if len(points) < 3:
        return points
    return np.asarray(solveh_banded(bending_bands(weight, 1.0), points, lower=True))
