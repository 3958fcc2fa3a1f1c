"""Pairs of windows that the lower bound leaves, and their distances.

1. *Leaves.* Windows are cut in half across the direction in which their projections vary most, and the halves
   again, until a leaf has few windows. Leaves whose boxes are farther apart than the reach have no near pair.
2. *Near pairs.* All pairs of two near leaves are compared by one small product of matrices.
3. *Distances.* Near pairs lie in runs along the diagonals of the grid, as motions that are alike stay alike
   for a while. The pairs (i, j) and (i + 1, j + 1) share all pairs of frames but one, which are multiplied
   once.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from mocap._shared.arrays import Indices
from mocap._shared.records import NamedTuple
from mocap.matching.distance_grids import Cloud, Floats
from mocap.matching.lower_bound import (
    Directions,
    Singles,
    projections,
    sample_windows,
    squared_length,
    squared_reach,
)
from mocap.matching.tuned import TUNED


class Leaves(NamedTuple):
    """Windows with their projections, leaf by leaf.

    windows : (n,), which windows, in the order of the leaves.
    places : (n, d), their projections.
    starts : (L + 1,), where leaves start in this order, and the end of the last one.
    low, high : (L, d), the corners of each leaf's box.
    """

    windows: Indices
    places: Singles
    starts: Indices
    low: Singles
    high: Singles

    def leaf(self, number: int) -> slice:
        """Return where a leaf is in `windows` and `places`."""
        return slice(self.starts[number], self.starts[number + 1])


def cut_into_leaves(windows: Indices, places: Singles) -> Leaves:
    """Cut windows into leaves.

    Parameters
    ----------
    windows : shape (n,), their numbers.
    places : shape (n, d), their projections.

    Examples
    --------
    >>> line = np.arange(300, dtype=np.float32)[::-1, None]
    >>> leaves = cut_into_leaves(np.arange(300), line)
    >>> leaves.starts.tolist(), leaves.low[:, 0].tolist()
    ([0, 75, 150, 225, 300], [0.0, 75.0, 150.0, 225.0])
    """
    parts = _halves(places, np.arange(len(windows)))
    starts = np.cumsum([0, *map(len, parts)])
    order = np.concatenate([np.empty(0, np.intp), *parts])
    ordered = places[order]
    low = np.minimum.reduceat(ordered, starts[:-1])
    high = np.maximum.reduceat(ordered, starts[:-1])
    return Leaves(windows[order], ordered, starts, low, high)


def _halves(places: Singles, members: Indices) -> list[Indices]:
    """Cut members in half where they vary most, and each half again, down to leaves."""
    if len(members) <= TUNED.leaf:
        return [members] if len(members) else []
    own_places = places[members]
    values = own_places[:, own_places.var(axis=0).argmax()]
    middle = len(members) // 2
    order = np.argpartition(values, middle)
    lower = np.sort(order[:middle])  # in the order of time, for quick look-up
    upper = np.sort(order[middle:])
    return _halves(places, members[lower]) + _halves(places, members[upper])


def near_pairs(a: Leaves, b: Leaves, reach: float, *, shift: int, at_most: float) -> Indices | None:
    """Find the pairs of windows whose projections are within reach.

    Parameters
    ----------
    a, b : the windows of the first and of the second ones.
    reach : of `squared_reach`, m².
    shift : only pairs whose second window is at least so much later than the first.
    at_most : pairs; if there are more, the search ends.

    Returns
    -------
    Windows of a and of b, shape (2, N); None if there are more than `at_most`.

    Examples
    --------
    >>> line = np.array([[0.0], [5], [0.5], [5.25]], np.float32)
    >>> leaves = cut_into_leaves(np.arange(4), line)
    >>> near_pairs(leaves, leaves, 1.0, shift=1, at_most=99).tolist()
    [[0, 1], [2, 3]]
    """
    squares_a = np.vecdot(a.places, a.places)[:, None]
    squares_b = np.vecdot(b.places, b.places)[:, None]
    # One product makes |p|² + |p'|² - 2 p p'.
    rows = np.hstack([a.places, squares_a, np.ones_like(squares_a)])
    columns = np.hstack([-2 * b.places, np.ones_like(squares_b), squares_b]).T.copy()
    parts = [np.empty((2, 0), np.intp)]
    count = 0
    for first, second in _near_leaves(a, b, reach):
        leaf_a = a.leaf(first)
        leaf_b = b.leaf(second)
        squares = rows[leaf_a] @ columns[:, leaf_b]
        entries = np.flatnonzero(squares <= np.float32(reach))
        if len(entries):
            row, column = np.divmod(entries, squares.shape[1])
            pairs = np.stack([a.windows[leaf_a][row], b.windows[leaf_b][column]])
            parts.append(pairs[:, pairs[1] - pairs[0] >= shift])
            count += parts[-1].shape[1]
        if count > at_most:
            return None
    return np.concatenate(parts, axis=1)


def _near_leaves(a: Leaves, b: Leaves, reach: float) -> list[list[int]]:
    """List the pairs of leaves whose boxes are within reach."""
    pairs = []
    for first in range(len(a.low)):
        gaps = np.maximum(b.low - a.high[first], a.low[first] - b.high)
        squares = (np.maximum(gaps, 0) ** 2).sum(axis=1)
        pairs += [[first, second] for second in np.flatnonzero(squares <= reach).tolist()]
    return pairs


def sort_by_diagonal(pairs: Indices) -> Indices:
    """Sort pairs (2, N) by their diagonal j - i, and along it.

    Examples
    --------
    >>> sort_by_diagonal(np.array([[4, 1, 5, 0], [6, 1, 7, 9]])).tolist()
    [[1, 4, 5, 0], [1, 6, 7, 9]]
    """
    i, j = pairs
    diagonals = j - i
    lowest = diagonals.min(initial=0)
    length = i.max(initial=0) + 1
    keys = (diagonals - lowest) * length + i
    keys.sort()
    diagonals, i = np.divmod(keys, length)
    return np.stack([i, i + diagonals + lowest])


def pair_distances(a: Cloud, b: Cloud, pairs: Indices) -> Floats:
    """Measure D of pairs, as `cloud_distances` does for all.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    pairs : shape (2, N), first frames of the windows, sorted as by `sort_by_diagonal`.

    Returns
    -------
    Shape (N,), m², never negative.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> pair_distances(ready, ready, np.array([[0], [1]]))
    array([0.5])
    """
    distances = np.empty(pairs.shape[1], a.heights.dtype)
    for first in range(0, len(distances), TUNED.pairs_together):
        part = slice(first, first + TUNED.pairs_together)
        distances[part] = _distances_of_runs(a, b, *pairs[:, part])
    return distances


def _distances_of_runs(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Floats:
    """Measure D of pairs, with each pair of frames of a run multiplied once."""
    window = a.window
    step = np.diff(i, prepend=i[0] - window)
    is_same_diagonal = np.diff(j - i, prepend=j[0] - i[0]) == 0
    continues = is_same_diagonal & (step < window)
    fresh = np.where(continues, step, window)  # pairs of frames that the pair before does not have
    ends = np.cumsum(fresh)
    starts = ends - window
    frames_a = np.repeat(i - starts, fresh) + np.arange(ends[-1])
    frames_b = frames_a + np.repeat(j - i, fresh)

    ground = np.vecdot(a.ground[frames_a], b.ground[frames_b])
    heights = np.vecdot(a.heights[frames_a], b.heights[frames_b])
    weights = a.frame_weights.astype(heights.dtype)
    overlap = np.abs(_window_sums(ground, starts, weights) + np.vecdot(a.paths[i], b.paths[j]))
    overlap += _window_sums(heights, starts, weights)
    return np.asarray(np.maximum(a.sizes[i] + b.sizes[j] - 2 * overlap, 0))


def _window_sums(products: NDArray[np.inexact], starts: Indices, weights: Floats) -> NDArray[np.inexact]:
    """Add up the weighted products of the frames of each window."""
    return np.asarray(sliding_window_view(products, len(weights))[starts] @ weights)


def is_sparse(cloud: Cloud, directions: Directions, below: float) -> bool:
    """Judge by a sample of windows whether few pairs are within reach of each other.

    Examples
    --------
    Windows that are all the same are all near each other.

    >>> from mocap.matching.distance_grids import cloud as prepare
    >>> from mocap.matching.lower_bound import sample_directions
    >>> still = prepare(np.ones((30, 2, 3)), np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> is_sparse(still, sample_directions(still), 0.04)
    False
    """
    starts = sample_windows(cloud, TUNED.pair_sample)
    places = projections(cloud, starts, directions)
    reach = squared_reach(cloud, below, squared_length(places))
    if not np.isfinite(reach):
        return False
    squares = np.vecdot(places, places)
    is_near = squares[:, None] + squares - 2 * (places @ places.T) <= reach
    is_apart = np.abs(starts[:, None] - starts) >= cloud.window
    return bool(np.count_nonzero(is_near & is_apart) <= TUNED.sparse * np.count_nonzero(is_apart))
