"""Near pairs: the pairs of windows that the lower bound does not rule out, and their distances.

1. *Leaves.* As in a k-d tree, windows are divided at the median of the coordinate in which their projections
   vary most, recursively, until a leaf has few windows. Two leaves have no near pair if the distance of their
   bounding boxes is larger than the reach.
2. *Near pairs.* All pairs of windows in two near leaves are compared by one small matrix product.
3. *Distances.* Near pairs form runs along the diagonals of the grid, because similar motions remain similar
   for a while. The pairs (i, j) and (i + 1, j + 1) share all pairs of frames but one, and a shared pair of
   frames is multiplied once.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from mocap._shared.arrays import Indices
from mocap._shared.records import NamedTuple
from mocap.matching.lower_bound import (
    Directions,
    Singles,
    projections,
    sample_windows,
    squared_length,
    squared_reach,
)
from mocap.matching.prepared_clouds import Cloud, Floats
from mocap.matching.tuned import TUNED


class Leaves(NamedTuple):
    """Windows with their projections, sorted by leaf.

    windows : (n,), the numbers of the windows.
    projections : (n, d), their projections.
    starts : (L + 1,), the index of the first window of each leaf, and the end of the last leaf.
    low, high : (L, d), the corners of the bounding box of each leaf.
    """

    windows: Indices
    projections: Singles
    starts: Indices
    low: Singles
    high: Singles

    def leaf(self, number: int) -> slice:
        """Return the slice of a leaf in `windows` and `projections`."""
        return slice(self.starts[number], self.starts[number + 1])


def cut_into_leaves(windows: Indices, projected: Singles) -> Leaves:
    """Divide windows into leaves by their projections.

    Parameters
    ----------
    windows : shape (n,), their numbers.
    projected : shape (n, d), their projections.

    Examples
    --------
    >>> line = np.arange(300, dtype=np.float32)[::-1, None]
    >>> leaves = cut_into_leaves(np.arange(300), line)
    >>> leaves.starts.tolist(), leaves.low[:, 0].tolist()
    ([0, 75, 150, 225, 300], [0.0, 75.0, 150.0, 225.0])
    """
    parts = _halves(projected, np.arange(len(windows)))
    starts = np.cumsum([0, *map(len, parts)])
    order = np.concatenate([np.empty(0, np.intp), *parts])
    ordered = projected[order]
    low = np.minimum.reduceat(ordered, starts[:-1])
    high = np.maximum.reduceat(ordered, starts[:-1])
    return Leaves(windows[order], ordered, starts, low, high)


def _halves(projected: Singles, members: Indices) -> list[Indices]:
    """Divide members at the median of the coordinate of largest variance, recursively, down to leaves."""
    if len(members) <= TUNED.leaf:
        return [members] if len(members) else []
    coordinates = projected[members]
    values = coordinates[:, coordinates.var(axis=0).argmax()]
    middle = len(members) // 2
    order = np.argpartition(values, middle)
    lower = np.sort(order[:middle])  # in the order of time, for fast access
    upper = np.sort(order[middle:])
    return _halves(projected, members[lower]) + _halves(projected, members[upper])


def near_pairs(a: Leaves, b: Leaves, reach: float, *, shift: int, at_most: float) -> Indices | None:
    """Find the pairs of windows whose projections are within reach.

    Parameters
    ----------
    a, b : the first and the second windows of the pairs.
    reach : the largest squared distance, from `squared_reach`, m².
    shift : the smallest number of frames from the first window of a pair to the second.
    at_most : the largest number of pairs. If there are more, the search ends.

    Returns
    -------
    Windows of a and of b, shape (2, N); None if there are more than `at_most` pairs.

    Examples
    --------
    >>> line = np.array([[0.0], [5], [0.5], [5.25]], np.float32)
    >>> leaves = cut_into_leaves(np.arange(4), line)
    >>> near_pairs(leaves, leaves, 1.0, shift=1, at_most=99).tolist()
    [[0, 1], [2, 3]]
    """
    squares_a = np.vecdot(a.projections, a.projections)[:, None]
    squares_b = np.vecdot(b.projections, b.projections)[:, None]
    # A single product of these computes |p|² + |p'|² - 2 p p'.
    rows = np.hstack([a.projections, squares_a, np.ones_like(squares_a)])
    columns = np.hstack([-2 * b.projections, np.ones_like(squares_b), squares_b]).T.copy()
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
    """List the pairs of leaves whose bounding boxes are within reach."""
    pairs = []
    for first in range(len(a.low)):
        separations = np.maximum(b.low - a.high[first], a.low[first] - b.high)
        squares = (np.maximum(separations, 0) ** 2).sum(axis=1)
        pairs += [[first, second] for second in np.flatnonzero(squares <= reach).tolist()]
    return pairs


def sort_by_diagonal(pairs: Indices) -> Indices:
    """Sort pairs (2, N) by their diagonal j - i, then by i.

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
    """Compute D for some pairs of windows, as `cloud_distances` does for all.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    pairs : shape (2, N), first frames of the windows, sorted by `sort_by_diagonal`.

    Returns
    -------
    Shape (N,), m², not negative.

    Examples
    --------
    >>> from mocap.matching.prepared_clouds import cloud
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
    """Compute D of pairs. Each pair of frames in a run along a diagonal is multiplied once."""
    window = a.window
    step = np.diff(i, prepend=i[0] - window)
    is_same_diagonal = np.diff(j - i, prepend=j[0] - i[0]) == 0
    continues = is_same_diagonal & (step < window)
    new_frames = np.where(continues, step, window)  # pairs of frames not shared with the previous pair
    ends = np.cumsum(new_frames)
    starts = ends - window
    frames_a = np.repeat(i - starts, new_frames) + np.arange(ends[-1])
    frames_b = frames_a + np.repeat(j - i, new_frames)

    ground = np.vecdot(a.ground[frames_a], b.ground[frames_b])
    heights = np.vecdot(a.heights[frames_a], b.heights[frames_b])
    weights = a.frame_weights.astype(heights.dtype)
    overlap = np.abs(_window_sums(ground, starts, weights) + np.vecdot(a.paths[i], b.paths[j]))
    overlap += _window_sums(heights, starts, weights)
    return np.asarray(np.maximum(a.sizes[i] + b.sizes[j] - 2 * overlap, 0))


def _window_sums(products: NDArray[np.inexact], starts: Indices, weights: Floats) -> NDArray[np.inexact]:
    """Sum the weighted products of the frames of each window."""
    return np.asarray(sliding_window_view(products, len(weights))[starts] @ weights)


def is_sparse(cloud: Cloud, directions: Directions, below: float) -> bool:
    """Estimate from a sample of windows whether few pairs are within reach.

    Examples
    --------
    All pairs of windows of a constant pose are near:

    >>> from mocap.matching.prepared_clouds import cloud as prepare
    >>> from mocap.matching.lower_bound import sample_directions
    >>> still = prepare(np.ones((30, 2, 3)), np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> is_sparse(still, sample_directions(still), 0.04)
    False
    """
    starts = sample_windows(cloud, TUNED.pair_sample)
    projected = projections(cloud, starts, directions)
    reach = squared_reach(cloud, below, squared_length(projected))
    if not np.isfinite(reach):
        return False
    squares = np.vecdot(projected, projected)
    is_near = squares[:, None] + squares - 2 * (projected @ projected.T) <= reach
    is_apart = np.abs(starts[:, None] - starts) >= cloud.window
    return bool(np.count_nonzero(is_near & is_apart) <= TUNED.sparse * np.count_nonzero(is_apart))
