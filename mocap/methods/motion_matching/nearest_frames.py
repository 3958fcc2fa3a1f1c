"""The frame, of all clips, whose pose is most like mine and whose future is most like the one asked for.

Critically damped springs say what is asked for: with half-life h and y = 2 ln 2 / h a spring from x, at
velocity v, to a goal g is after t seconds at

    x(t) = g + (j₀ + j₁ t) e^(-y t),   j₀ = x - g,   j₁ = v + j₀ y

[Hol20]. At t = h there is left (1 + 2 ln 2) / 4 = 0.597 of a gap at rest, not one half; half is left after
1.211 h.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.errors import MocapError, NoWalk
from mocap.methods.motion_matching.pose_database import AHEAD, FUTURE, PoseDatabase, ahead_columns

PULL = 2 * np.log(2)  # times the half-life: how hard a spring pulls

# Squared distances of standardised features, without unit. Those that differ by less are equal, and the first
# frame is taken, or the one that plays.
EQUAL = 1e-8
CANDIDATES = 8  # nearest frames that a search compares first, four times as many if all of them are excluded

BEHIND = 1e-9  # radians: a goal so nearly straight behind is behind, and reached by a turn to the left

Value = complex | NDArray[Any]  # complex numbers are points on the ground


def spring(start: Value, speed: Value, goal: Value, halflife: float, seconds: ArrayLike) -> NDArray[Any]:
    """Follow a critically damped spring for some seconds [Hol20].

    Parameters
    ----------
    start, speed, goal : where it starts, how fast it moves there, where it is drawn to; any unit.
    halflife : seconds, above 0.
    seconds : when to look; broadcasts with the others.

    Examples
    --------
    >>> spring(1.0, 0.0, 0.0, 0.27, 0.27).round(3)
    np.float64(0.597)

    Notebook: 18-motion-matching
    """
    return np.asarray(goal + fade(start - goal, speed, halflife, seconds)[0])


def spring_way(speed: Value, goal: Value, halflife: float, seconds: ArrayLike) -> NDArray[Any]:
    """Compute the path of a velocity that a spring draws to a goal [ours: the integral of `spring`].

    Parameters
    ----------
    speed, goal : the velocity now, which does not accelerate yet, and the requested velocity.
    halflife, seconds : as for `spring`.

    Examples
    --------
    From rest to 1 m/s; the spring costs 2 / y = 0.39 m of the two:

    >>> spring_way(0.0, 1.0, 0.27, 2.0).round(2)
    np.float64(1.61)

    Notebook: 18-motion-matching
    """
    pull = PULL / halflife
    t = np.asarray(seconds)
    error = speed - goal
    decaying = np.exp(-pull * t) * (2 * error / pull + error * t)
    return np.asarray(2 * error / pull - decaying + goal * t)


def fade(
    offset: Value, speed: Value, halflife: float, seconds: ArrayLike
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Compute an offset and its velocity after some seconds, while a spring draws the offset to 0.

    Examples
    --------
    >>> offset, speed = fade(np.ones(1), np.zeros(1), 0.1, 0.1)
    >>> offset.round(3), speed.round(2)
    (array([0.597]), array([-4.8]))
    """
    pull = PULL / halflife
    t = np.asarray(seconds)
    drift = speed + offset * pull  # j₁
    decay = np.exp(-pull * t)
    return decay * (offset + drift * t), decay * (speed - drift * pull * t)


class Wants(NamedTuple):
    """How a character searches, what it weighs, and how a cut fades.

    `every` seconds it searches; a new command searches at once. `halflife` (s) is that of the spring that
    draws its velocity to the wish, `fade` (s) that of the offset after a cut. `future` multiplies the weight
    of places and directions ahead: more obeys sooner and slides more. `bonus` is by how much, as a squared
    distance of features, another frame must be better than to play on. Frames within `near` seconds of now
    are not found. A `guarded` character cuts only for half the cost, does not return into its last stride,
    and asks for no sharper turn than its clips have: else it glides if no clip has the requested future.

    Examples
    --------
    >>> wants = Wants(future=0.5)
    >>> wants.every, wants.halflife, wants.fade, wants.near
    (0.1, 0.27, 0.1, 0.2)

    Notebook: 18-motion-matching
    """

    every: float = 0.1  # reads: name: users give it as a keyword
    halflife: float = 0.27
    fade: float = 0.1
    future: float = 1.0
    bonus: float = 0.0
    near: float = 0.2  # reads: name: users give it as a keyword
    guarded: bool = True


class FrameSearch:
    """A search among the usable frames of a database, by a k-d tree.

    Parameters
    ----------
    database : T frames.
    future : multiplies the features of the future.
    label : which frames may be found; "" for all that are usable.

    Raises
    ------
    NoWalk : for a label that no clip has.
    MocapError : where no frame may be found.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> table = tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> [FrameSearch(table).nearest(table.values[100], lambda f: f >= first)[0] for first in (0, 101)]
    [100, 101]
    >>> FrameSearch(table).scale.max(), FrameSearch(table, future=3.0).scale.max()
    (np.float64(1.0), np.float64(3.0))
    """

    def __init__(self, database: PoseDatabase, *, future: float = 1.0, label: str = "") -> None:
        labels = database.motion.labels
        if label and label not in labels:
            available = ", ".join(labels) or "none"
            raise NoWalk(f"No clip has the label '{label}'; there are: {available}.")
        self.frames = np.flatnonzero(database.usable & labels[label] if label else database.usable)
        if not len(self.frames):
            raise MocapError(f"No frame '{label}' can be found: all are too near the end of their clip.")
        self.scale = np.ones(database.values.shape[1])
        self.scale[FUTURE] = future
        self.values = database.values * self.scale
        self.tree = cKDTree(self.values[self.frames])

    def cost(self, query: Array, frame: int) -> float:
        """Compute the squared distance of a frame from a query, (27,)."""
        difference = query * self.scale - self.values[frame]
        return float(difference @ difference)

    def nearest(self, query: Array, allowed: Callable[[Indices], Mask]) -> tuple[int, float]:
        """Find the allowed frame nearest to a query, and its squared distance, by a k-d tree.

        Parameters
        ----------
        query : shape (27,), standardised.
        allowed : says of frame numbers (N,) which may be found.

        Returns
        -------
        The frame, of those at equal distances the first, and its squared distance; -1 and infinity if no
        usable frame is allowed.
        """
        scaled = query * self.scale
        count = min(CANDIDATES, len(self.frames))
        while True:
            _, rows = self.tree.query(scaled, np.arange(1, count + 1))
            frames = self.frames[rows]
            candidates = np.sort(frames[allowed(frames)])
            costs = ((self.values[candidates] - scaled) ** 2).sum(axis=1)
            is_complete = count == len(self.frames)
            farthest = self.cost(query, int(frames[-1]))
            if len(costs) and (is_complete or farthest > costs.min() + EQUAL):
                best = int(candidates[first_least(costs, EQUAL)])
                return best, self.cost(query, best)
            if is_complete:
                return -1, np.inf
            count = min(4 * count, len(self.frames))


def foresee(database: PoseDatabase, frame: int, goal: complex, halflife: float) -> Array:
    """Compute the requested future, (12,) standardised, as the body sees it in a frame.

    Springs draw its velocity to `goal` and its facing to the goal's direction; their places and directions
    after 1/3, 2/3 and 1 s are the last twelve features.

    Parameters
    ----------
    database : T frames.
    frame : the frame that is playing.
    goal : the requested velocity, seen from the body: complex z + ix, metres per second; 0 keeps the facing.
    halflife : seconds, of both springs.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> table = tabulate([body.resample(datasets.sample("walk_straight"), 30)])
    >>> ahead = foresee(table, 100, 1.3 + 0j, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    >>> ahead[4:6].round(1)  # after one second she would be 1.2 m ahead
    array([0. , 1.3])

    Asked to go to the left, she comes there in a bend, 0.8 m to the left, and then faces to the left:

    >>> ahead = foresee(table, 100, 1.3j, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    >>> places, directions = ahead.reshape(2, 3, 2).round(2).tolist()
    >>> places, directions
    ([[0.13, 0.34], [0.45, 0.46], [0.85, 0.5]], [[0.72, 0.69], [0.97, 0.22], [1.0, 0.06]])

    Notebook: 18-motion-matching
    """
    velocity = complex(database.drift[frame] * np.exp(-1j * database.heading[frame]))
    positions = spring_way(velocity, goal, halflife, AHEAD)
    facing = spring(0.0, float(database.spin[frame]), bearing_of(goal), halflife, AHEAD)
    ahead = np.concatenate([ahead_columns(positions), ahead_columns(np.exp(1j * facing))])
    return np.asarray((ahead - database.mean[FUTURE]) / database.scale[FUTURE])


def bearing_of(goal: complex) -> float:
    """Return the direction of a velocity seen from the body, radians; 0 for a body that should stand.

    Examples
    --------
    To the right, and straight behind, which is reached by a turn to the left:

    >>> round(bearing_of(-1j), 2), round(bearing_of(-1 + 0j), 2), round(bearing_of(-1 - 1e-12j), 2)
    (-1.57, 3.14, 3.14)

    Notebook: 18-motion-matching
    """
    bearing = float(np.angle(goal)) if goal else 0.0
    bearing += 2 * np.pi if bearing < BEHIND - np.pi else 0.0
    return bearing
