"""The frame, of all clips, whose pose is most like mine and whose future is most like the one asked for."""

from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from mocap._shared.arrays import Array, Indices, Mask
from mocap.errors import MocapError
from mocap.methods.motion_matching.frame_features import AHEAD, FUTURE, ahead_columns
from mocap.methods.motion_matching.pose_database import PoseDatabase
from mocap.methods.motion_matching.springs import spring, spring_way

TREE_FROM = 20_000  # frames from which a k-d tree is quicker than one product, whose numbers have 32 bits


class Wants(NamedTuple):
    """How a character searches, what it weighs, and how a cut fades.

    `every` seconds it searches; a new command searches at once. `halflife` (s) is that of the spring that
    draws its velocity to the wish, `fade` (s) that of the offset after a cut. `future` multiplies the weight
    of places and directions ahead: more obeys sooner and slides more. `bonus` is by how much, as a squared
    distance of features, another frame must be better than to play on. Frames within `near` seconds of now
    are not found.

    Examples
    --------
    >>> Wants(future=0.5).every
    0.1

    Notebook: 18-motion-matching
    """

    every: float = 0.1
    halflife: float = 0.27
    fade: float = 0.1
    future: float = 1.0
    bonus: float = 0.0
    near: float = 0.2

    def check(self) -> None:
        """Raise MocapError for what makes no sense."""
        for name in ("every", "halflife", "fade"):
            if not (np.isfinite(value := getattr(self, name)) and value > 0):
                raise MocapError(f"'{name}' is a number of seconds above 0, got {value}.")
        for name in ("future", "bonus", "near"):
            if not (np.isfinite(value := getattr(self, name)) and value >= 0):
                raise MocapError(f"'{name}' is a number from 0 on, got {value}.")


class FrameSearch:
    """A search among the usable frames of a database, by one product or by a k-d tree.

    |x - q|² = |x|² - 2 x·q + |q|², so that one product of a matrix with the query compares all frames.

    Parameters
    ----------
    database : T frames.
    future : multiplies the features of the future.
    tree : search by a k-d tree; by default from 20 000 frames on, where it is quicker.
    among : shape (T,), which frames may be found; by default those that are usable.

    Raises
    ------
    MocapError : where no frame may be found.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> table = tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> FrameSearch(table).nearest(table.values[100], now=0, near=6)[0]
    100
    """

    def __init__(
        self,
        database: PoseDatabase,
        *,
        future: float = 1.0,
        tree: bool | None = None,
        among: Mask | None = None,
    ) -> None:
        self.frames: Indices = np.flatnonzero(database.usable if among is None else among)
        if not len(self.frames):
            raise MocapError("No frame of these clips can be found: all are too near the end of their clip.")
        self.scale = np.ones(database.values.shape[1])
        self.scale[FUTURE] = future
        self.values = database.values * self.scale
        tree = len(self.frames) >= TREE_FROM if tree is None else tree
        candidates = self.values[self.frames]
        self.tree = KDTree(candidates) if tree else None
        self.bank = candidates.astype(np.float32)
        self.sizes = (self.bank**2).sum(axis=1)

    def cost(self, query: Array, frame: int) -> float:
        """Measure the squared distance of a frame from a query, (27,)."""
        gap = query * self.scale - self.values[frame]
        return float(gap @ gap)

    def nearest(self, query: Array, now: int, near: int) -> tuple[int, float]:
        """Find the frame nearest to a query, not within `near` frames of now, and its squared distance."""
        query = query * self.scale
        if self.tree is None:
            costs = self.sizes - 2 * (self.bank @ query.astype(np.float32))
            found = self.frames
        else:
            count = min(2 * near + 1, len(self.frames))
            gaps, rows = self.tree.query(query, k=count)
            costs, found = np.atleast_1d(gaps) ** 2, self.frames[np.atleast_1d(rows)]
        costs = np.where(np.abs(found - now) < near, np.inf, costs)
        best = int(costs.argmin())
        if not np.isfinite(costs[best]):
            return -1, np.inf
        frame = int(found[best])
        gap = query - self.values[frame]
        return frame, float(gap @ gap)


def foresee(database: PoseDatabase, now: int, goal: complex, halflife: float) -> Array:
    """Describe the future asked for, (12,) standardised, as the body at frame `now` sees it.

    Springs draw its velocity to `goal` and its facing to the goal's direction; their places and directions
    after 1/3, 2/3 and 1 s are the last twelve features.

    Parameters
    ----------
    database : T frames.
    now : the frame that is playing.
    goal : the velocity asked for, seen from the body: complex z + ix, metres per second; 0 keeps the facing.
    halflife : seconds, of both springs.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> table = tabulate([body.resample(datasets.sample("walk_straight"), 30)])
    >>> ahead = foresee(table, 100, 1.3 + 0j, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    >>> ahead[4:6].round(1)  # after one second she would be 1.2 m ahead
    array([0. , 1.2])

    Notebook: 18-motion-matching
    """
    seen = complex(database.drift[now] * np.exp(-1j * database.heading[now]))
    way = spring_way(seen, goal, halflife, AHEAD)
    facing = spring(0.0, float(database.spin[now]), float(np.angle(goal)) if goal else 0.0, halflife, AHEAD)
    ahead = np.concatenate([ahead_columns(way), ahead_columns(np.exp(1j * facing))])
    return np.asarray((ahead - database.mean[FUTURE]) / database.scale[FUTURE])


def next_frame(search: FrameSearch, query: Array, now: int, *, near: int, staying: float) -> int:
    """Choose the frame to play: another one where it is better than to play on.

    The pose of a query is that of `now`, so that to play on costs only what the future asks.

    Parameters
    ----------
    search : the frames.
    query : shape (27,), the pose now and the future asked for.
    now : the frame that is playing.
    near : frames around now that are not found.
    staying : what to play on costs, a squared distance; infinity where the clip ends.

    Returns
    -------
    A frame's number in the database; `now` to play on.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.motion_matching.pose_database import tabulate
    >>> table = tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> search = FrameSearch(table)
    >>> next_frame(search, table.values[100], 100, near=6, staying=0.0)
    100
    """
    frame, cost = search.nearest(query, now, near)
    return frame if frame >= 0 and cost < staying else now
