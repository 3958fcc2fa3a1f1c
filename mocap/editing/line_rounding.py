"""Round a line where a walk would have to turn too fast on it: at a corner, or at the cusp of a heart."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import maximum_filter1d
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body.ground_path import GroundPath
from mocap.editing.path_editing import CHORD, Ride, moving_frames
from mocap.editing.turning import RADIUS, SLOWER, places_on
from mocap.feet.ankle_targets import bending_bands

SPACING = 0.05  # metres between the points of a rounded line
SMOOTH = 0.1  # metres that smoothing reaches everywhere; it moves a circle of 1 m by 0.1 mm

# How a reach grows at a time. With 1.4, a corner is cut by up to a third more than it need be.
GROW = 1.15

# How fast a reach falls with the distance from where it is needed. With 0 it falls at once, and a line swings
# out in a hook before a corner; with 0.1 it falls so slowly that 7 m of line move for a corner, not 4.
FALL = 0.6

WIDEST = 2.5  # times the radius that the limit asks for: no reach is wider
CUT = 1.75  # times that radius: a line that is cut by more goes back on itself, or nearly so
SHORTER = 0.6  # of its length: so much stays at least of a line that is not cut by much more than it need be
LOOP = 1.15  # times the radius: where a bend begins, a walk is faster than further on
AHEAD = 0.6  # times the radius: how far ahead on a line a walk looks that is steered along it
TIGHTEST = 0.2  # metres: no loop is tighter
SLOWEST = 0.5  # of its own pace: at least so fast the point on the line moves on, or the walk might circle it
SEEN = 0.01  # metres: a line that is moved by less is not called rounded
JOINED = 0.5  # metres: rounded stretches nearer to each other count as one


class RoundedLine(NamedTuple):
    """A line that is rounded where needed, at n points that lie evenly on the line asked for.

    `path` is the new line, `along` (n,) the metres along it, `asked` (n,) those along the line asked for, and
    `moved` (n,) how far the one is from the other, metres: the larger of both ways.

    Examples
    --------
    >>> along = np.array([0, 1, 2, 2.1, 2.25, 2.5, 2.75])
    >>> moved = np.array([0, 0.3, 0.4, 0, 0.2, 0.01, 0.015])
    >>> RoundedLine(GroundPath([[0, 0], [0, 3]]), along, along, moved).roundings  # 25 cm apart is one, 50 not
    [(1.0, 2.25, 0.4), (2.75, 2.75, 0.015)]
    """

    path: GroundPath
    along: Array
    asked: Array
    moved: Array

    @property
    def roundings(self) -> list[tuple[float, float, float]]:
        """The stretches moved by more than 1 cm: start, end, metres along the line, and how far at most."""
        far = np.flatnonzero(self.moved > SEEN)
        new = (np.diff(far) > 1) & (np.diff(self.asked[far]) >= JOINED)
        parts = [part for part in np.split(far, np.flatnonzero(new) + 1) if len(part)]
        asked = self.asked.tolist()
        return [(asked[part[0]], asked[part[-1]], float(self.moved[part].max())) for part in parts]


def round_line(path: GroundPath, ride: Ride, fps: float, limit: float) -> RoundedLine:
    """Round a line where a walk on it would turn faster than it may.

    The line is the one nearest to the points p_k asked for, among those that bend little:
    min Σ |x_k - p_k|² + Σ λ_k |x_{k-1} - 2 x_k + x_{k+1}|², a linear system with five diagonals. λ_k = r_k⁴
    is small at first. Where a frame of the walk turns too fast, the reach r grows around it, and the line is
    laid anew. The walk slows down in bends, and more at corners, as `turning` says; it may turn by the limit,
    and by as much more as it turns there by itself to the same side. Else the line stays as it is.
    Where all this is not enough, at one corner upon another, or cuts off too much, where the line comes back
    on itself, a walk is steered along the line, which turns as fast as it may and makes loops.

    Parameters
    ----------
    path : the line asked for.
    ride : of the walk: which way it goes in each frame, and how far.
    fps : its frames per second.
    limit : how fast it may be turned, radians per second, above 0.

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
    even = path.resampled(SPACING)
    asked, spacing = even.points, path.length / (len(even.points) - 1)
    straight = SLOWER * np.diff(ride.along).max(initial=0.0) * fps / limit  # v₀ / limit at its slowest
    # The radius r at which v₀ q(1/r) / r is the limit, in cells.
    radius = max(TIGHTEST, np.sqrt((np.sqrt(RADIUS**4 + 4 * straight**4) - RADIUS**2) / 2)) / spacing
    own = np.diff(moving_frames(ride.path, ride.along).angle) * fps

    def too_fast(line: GroundPath, metres: Array) -> Indices:
        """Find the points of a line where the walk would turn too fast."""
        along, ratio = places_on(line, ride, fps, limit)
        along = along[along <= metres[-1]]  # to round a line makes it shorter
        slower = np.sqrt(ratio[1 : len(along)])
        rate = np.diff(moving_frames(line, along).angle) * fps * slower
        most = limit + np.maximum(np.sign(rate) * own[: len(rate)] * slower, 0)  # to the same side
        return np.unique(np.searchsorted(metres, along[1:][np.abs(rate) > most]))

    if not len(too_fast(path, even.along)):
        return RoundedLine(path, even.along, even.along, np.zeros(len(asked)))
    least = SMOOTH / spacing
    line, slow = _widened(asked, least, WIDEST * radius, too_fast)
    rounded = _measured(path, even, line, even.along)
    cut = rounded.moved.max() > max(CUT * radius * spacing, CHORD)
    if slow and not cut and rounded.path.length > SHORTER * path.length:
        return rounded
    places, points = _steered(asked, spacing, LOOP * radius)
    return _measured(path, even, _smoothed(points, np.full(len(points), least**4)), spacing * places)


def _widened(
    asked: Array, least: float, most: float, too_fast: Callable[[GroundPath, Array], Indices]
) -> tuple[Array, bool]:
    """Lay the line anew with a wider reach where it is too fast; say whether it is slow enough at the end.

    A reach grows within a chord of such a place; further away it falls with a slope.
    """
    reach, fall = np.full(len(asked), least), FALL * np.arange(len(asked))
    while True:
        line = _smoothed(asked, reach**4)
        near = too_fast(GroundPath(line), _metres(line))
        grows = near[reach[near] < most]
        if not len(grows):
            return line, not len(near)
        grown = np.zeros(len(reach))
        grown[grows] = GROW * reach[grows]
        grown = maximum_filter1d(grown, 2 * round(CHORD / SPACING) + 1)
        after = np.maximum.accumulate(grown + fall) - fall
        before = np.maximum.accumulate((grown - fall)[::-1])[::-1] + fall
        reach = np.maximum(reach, np.maximum(after, before))


def _measured(path: GroundPath, even: GroundPath, line: Array, places: Array) -> RoundedLine:
    """Measure how far a line is from the one asked for, and that from the line."""

    def far(points: Array, goal: GroundPath) -> Array:
        return np.asarray(cKDTree(goal.resampled(SPACING / 10).points).query(points)[0])

    rounded = GroundPath(line)
    missed = np.interp(places, even.along, far(even.points, rounded))
    return RoundedLine(rounded, _metres(line), places, np.maximum(far(line, path), missed))


def _metres(line: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def _steered(points: Array, step: float, radius: float) -> tuple[Array, Array]:
    """Walk along a line, always towards a point ahead on it, and never in a tighter bend than `radius` cells.

    Gives where on the line each point of the walk belongs, in cells of `step` metres, and the points.

    Examples
    --------
    >>> there_and_back = np.array([[0, 0], [0, 1], [0, 2], [0, 3], [0.1, 2], [0.2, 1]])
    >>> places, points = _steered(there_and_back, step=1.0, radius=1.0)
    >>> places.tolist(), points[3:, 1].round(1).tolist()
    ([0.0, 0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 4.5, 5.0], [3.0, 3.5, 3.1, 2.1, 1.5, 1.2])
    """
    last, ahead = len(points) - 1, max(1, round(AHEAD * radius))
    here, at = points[0], 0.0
    heading = np.arctan2(*(points[1] - here))
    places, found = [at], [here]
    while at < last:
        window = points[int(at) : int(at) + ahead + 1]
        at = min(max(at + SLOWEST, int(at) + float(np.hypot(*(window - here).T).argmin())), last)
        goal = points[min(int(at) + ahead, last)] - here
        off = np.pi - (np.pi + heading - np.arctan2(*goal)) % (2 * np.pi)  # in (-π, π]
        turn = 2 * off * step / max(np.hypot(*goal), step)
        heading += np.clip(turn, -1 / radius, 1 / radius)
        here = here + step * np.array([np.sin(heading), np.cos(heading)])
        places.append(at)
        found.append(here)
    return np.array(places), np.array(found)


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
