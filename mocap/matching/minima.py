"""The local minima of a distance grid: pairs of windows that are more similar than all their neighbours.

A grid that does not fit into memory is divided into blocks, which workers process one at a time. Two searches
find the same minima:

1. *By products*: all distances of a block are computed by matrix products, and searched by `local_minima`.
2. *By the bound* of `lower_bound`: only the distances of near pairs are computed, by `near_pairs`. All other
   entries are above the threshold, and therefore higher than any minimum.

`find_minima` chooses the second search if there are many windows and few near pairs.
"""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import one_blas_thread, run_in_order
from mocap.body.planar import from_ground
from mocap.errors import MocapError
from mocap.matching.distance_grids import EQUAL, tiled_distances
from mocap.matching.lower_bound import (
    Directions,
    projections,
    sample_directions,
    squared_length,
    squared_reach,
)
from mocap.matching.near_pairs import (
    Leaves,
    cut_into_leaves,
    is_sparse,
    near_pairs,
    pair_distances,
    sort_by_diagonal,
)
from mocap.matching.prepared_clouds import Cloud, Floats, window_vectors
from mocap.matching.tuned import TUNED

AT_ONCE = 1024  # pairs aligned at a time, to limit the memory

# Offsets (rows, columns) from an entry to its neighbours, in row-major order: the first four precede it.
PRECEDING = ((-1, -1), (-1, 0), (-1, 1), (0, -1))
NEIGHBOURS = PRECEDING + tuple((-row, -column) for row, column in reversed(PRECEDING))


def local_minima(grid: ArrayLike, below: float = np.inf, *, equal: float = EQUAL) -> Indices:
    """Find the entries below a threshold that are lower than all eight neighbours [KGP02, 3.2].

    Entries beyond the border are infinite. Of equal neighbours, the first in row-major order counts as the
    lower one. A plateau therefore has at least one minimum, and no two of its minima are neighbours.

    Parameters
    ----------
    grid : shape (n, m).
    below : the threshold, in the unit of the grid.
    equal : the tolerance for equal neighbours, in the unit of the grid. The default 1e-12 is for the rounding
        of a `distance_grid`: if a body stands still or a clip repeats itself, distances differ only by that.

    Returns
    -------
    Rows and columns, shape (N, 2), in row-major order.

    Raises
    ------
    MocapError : for a grid that does not have two dimensions, or contains NaN.

    Examples
    --------
    >>> local_minima(np.array([[3, 2, 3], [2, 1, 2], [0, 2, 2]]), below=2).tolist()
    [[2, 0]]

    Notebook: 00-quickstart
    """
    values = np.asarray(grid)
    if values.ndim != 2:
        raise MocapError(f"A grid has two dimensions, got shape {values.shape}.")
    if values.size and np.isnan(values.min()):
        raise MocapError(f"The grid holds NaN at {np.argwhere(np.isnan(values))[0].tolist()}.")
    padded = np.pad(values.astype(np.result_type(values, np.float32), copy=False), 1, constant_values=np.inf)
    rows, columns = np.divmod(np.flatnonzero(values < below), values.shape[1])

    def neighbours(entries: Indices, down: int, right: int) -> NDArray[Any]:
        return np.asarray(padded[rows[entries] + 1 + down, columns[entries] + 1 + right])

    lowest = _lowest(values[rows, columns], neighbours, equal)
    return np.stack([rows[lowest], columns[lowest]], axis=-1)


def _lowest(
    values: NDArray[Any], neighbours: Callable[[Indices, int, int], NDArray[Any]], equal: float
) -> Indices:
    """Find the entries that are lower than all eight neighbours.

    Parameters
    ----------
    values : shape (N,), of the entries.
    neighbours : a function of entries, rows and columns that returns the values at this offset from them.
    equal : as for `local_minima`.

    Returns
    -------
    Indices of the lowest entries, in ascending order.
    """
    lowest = np.arange(len(values))
    for down, right in NEIGHBOURS:
        entries = values[lowest]
        beside_entries = neighbours(lowest, down, right)
        is_earlier = (down, right) < (0, 0)
        is_lower = entries < beside_entries - equal if is_earlier else entries <= beside_entries + equal
        lowest = lowest[is_lower]  # the first neighbour rules out most entries
    return lowest


def listed_minima(pairs: Indices, values: Floats, *, equal: float = EQUAL) -> Indices:
    """Find the local minima of a sparse grid, as `local_minima` does for a dense one.

    Parameters
    ----------
    pairs : rows and columns, shape (2, N), sorted by `sort_by_diagonal`. Entries that are not listed are
        infinite.
    values : shape (N,).
    equal : as for `local_minima`.

    Returns
    -------
    Rows and columns, shape (N, 2), in row-major order.

    Examples
    --------
    >>> listed_minima(np.array([[0, 0, 0], [0, 1, 9]]), np.array([3.0, 2.0, 5.0])).tolist()
    [[0, 1], [0, 9]]
    """
    rows, columns = pairs
    diagonals = columns - rows
    length = rows.max(initial=0) + 3  # of a diagonal, padded so that no key beyond its ends is on another one
    keys = diagonals * length + rows  # ascending
    infinite_end = np.append(values, np.inf)
    no_key = np.append(keys, np.iinfo(keys.dtype).max)

    def neighbours(entries: Indices, down: int, right: int) -> NDArray[Any]:
        wanted = keys[entries] + (right - down) * length + down
        places = np.searchsorted(keys, wanted)
        return np.where(no_key[places] == wanted, infinite_end[places], np.inf)

    lowest = pairs[:, _lowest(values, neighbours, equal)]
    return lowest[:, np.lexsort(lowest[::-1])].T


def fit(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Array:
    """Align windows j with windows i: return the remaining RMS distance and the transform.

    The grid computes D as a difference of larger numbers. Here it is computed point by point, and therefore
    accurate down to 0.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    i, j : shape (N,), the first frames of their windows.

    Returns
    -------
    Shape (4, N): the RMS distance in metres, and the angle (radians), x and z (metres) of the transform.

    Examples
    --------
    >>> from mocap.matching.prepared_clouds import cloud
    >>> dot = np.array([[[0.0, 1, 0]], [[3, 1.5, 4]]])  # one point that moves
    >>> ready = cloud(dot, np.zeros(1), np.ones(1), 1, np.float64)
    >>> fit(ready, ready, np.array([0]), np.array([1]))[[0, 2, 3], 0]
    array([ 0.5, -3. , -4. ])
    """
    if len(i) > AT_ONCE:
        parts = [slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE)]
        return np.concatenate([fit(a, b, i[part], j[part]) for part in parts], axis=1)
    ground_a, heights_a = window_vectors(a, i)
    ground_b, heights_b = window_vectors(b, j)
    angle = np.angle((ground_a * ground_b.conj()).sum((1, 2)))
    residual = ground_a - np.exp(1j * angle)[:, None, None] * ground_b
    square = (np.abs(residual) ** 2).sum((1, 2)) + ((heights_a - heights_b) ** 2).sum((1, 2))
    translation = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.stack([np.sqrt(square), angle, *from_ground(translation).T])


class Side(NamedTuple):
    """One side of a block.

    windows : the windows whose minima belong to the block.
    cloud : these and, if there is one, a further window at each end, the neighbour of the outermost.
    first : the number of the first window in `cloud`.
    leaves : the windows of `cloud`, numbered from 0, for the search by the bound.
    """

    windows: range
    cloud: Cloud
    first: int
    leaves: Leaves | None = None


def find_minima(
    cloud: Cloud,
    below: float,
    *,
    progress: Progress = iter,
    executor: Executor | None = None,
    jobs: int | None = None,
) -> Array:
    """Find the local minima of the distances between all windows of a cloud, above the diagonal.

    Parameters
    ----------
    cloud : all clips, concatenated.
    below : the largest RMS distance of a minimum, metres.
    progress, executor, jobs : as for `find_transitions`.

    Returns
    -------
    Shape (6, N). The rows are the first window, the second window (at least a window's length later), the RMS
    distance in metres, and angle, x and z of the transform that aligns the second with the first.

    Examples
    --------
    A point rises and falls back to within 1 cm of its first frame:

    >>> from mocap.matching.prepared_clouds import cloud as prepare
    >>> points = np.array([[[0, height, 0]] for height in (1.0, 1.3, 1.6, 1.9, 1.01)])
    >>> ready = prepare(points, np.zeros(1), np.ones(1), 1, np.float64)
    >>> find_minima(ready, 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    with one_blas_thread():
        bound = _choose_bound(cloud, below)
        size = TUNED.wide_block if bound else TUNED.block
        count = len(cloud.sizes) - cloud.window + 1
        starts = range(0, count, size)
        cuts = ((cloud, range(start, min(start + size, count)), bound) for start in starts)
        sides = dict(zip(starts, run_in_order(_side, cuts, None, jobs), strict=True))
        reach = _reach(cloud, below, sides.values()) if bound else 0.0

        pairs = [(row, column) for row in starts for column in range(row, count, size)]
        tasks = ((sides[row], sides[column], below, reach) for row, column in progress(pairs))
        minima = list(run_in_order(_block_minima, tasks, executor, jobs))
    return np.concatenate(minima, axis=1)


def _choose_bound(cloud: Cloud, below: float) -> Directions | None:
    """Return directions for the search by the bound, or None if the search by products is faster."""
    if np.count_nonzero(np.isfinite(cloud.sizes)) <= TUNED.few_windows:
        return None
    directions = sample_directions(cloud)
    return directions if is_sparse(cloud, directions, below) else None


def _side(cloud: Cloud, windows: range, bound: Directions | None) -> Side:
    """Prepare one side of blocks: a range of windows of a cloud."""
    first = max(windows.start - 1, 0)
    stop = min(windows.stop + 1, len(cloud.sizes) - cloud.window + 1)
    part = cloud.part(slice(first, stop))
    if bound is None:
        return Side(windows, part, first)
    whole_windows = np.flatnonzero(np.isfinite(part.sizes))
    return Side(windows, part, first, cut_into_leaves(whole_windows, projections(part, whole_windows, bound)))


def _reach(cloud: Cloud, below: float, sides: Iterable[Side]) -> float:
    """Return the squared reach of the projections in the leaves of all sides."""
    longest = max(squared_length(side.leaves.projections) for side in sides if side.leaves)
    return squared_reach(cloud, below, longest)


def _block_minima(a: Side, b: Side, below: float, reach: float) -> Array:
    """Find the minima of a block, the unit of work of one worker."""
    with one_blas_thread():  # a worker may be another process
        pairs = _near_pairs(a, b, reach)
        if pairs is not None:
            distances = pair_distances(a.cloud, b.cloud, pairs)
            is_low = distances < below**2
            return _fits(a, b, listed_minima(pairs[:, is_low], distances[is_low]))
        blocks = [(row, column) for row in _cut(a) for column in _cut(b) if row.first <= column.first]
        return np.concatenate([_minima_by_products(row, column, below) for row, column in blocks], axis=1)


def _near_pairs(a: Side, b: Side, reach: float) -> Indices | None:
    """Find the near pairs of a block, sorted by diagonal; None if the block is searched by products."""
    if a.leaves is None or b.leaves is None:
        return None
    # The neighbours of two windows that do not overlap may overlap by two frames.
    shift = a.cloud.window - 2 - (b.first - a.first)
    at_most = TUNED.sparse * len(a.windows) * len(b.windows)
    pairs = near_pairs(a.leaves, b.leaves, reach, shift=shift, at_most=at_most)
    return None if pairs is None else sort_by_diagonal(pairs)


def _cut(side: Side) -> Iterator[Side]:
    """Divide a side into the smaller sides of blocks that are searched by products."""
    end = side.first + len(side.cloud.sizes)
    for start in range(side.windows.start, side.windows.stop, TUNED.block):
        windows = range(start, min(start + TUNED.block, side.windows.stop))
        first = max(start - 1, side.first)
        stop = min(windows.stop + 1, end)
        yield Side(windows, side.cloud.part(slice(first - side.first, stop - side.first)), first)


def _minima_by_products(a: Side, b: Side, below: float) -> Array:
    """Find the minima of a block by computing all its distances."""
    grid = tiled_distances(a.cloud, b.cloud, upper=a.windows == b.windows)
    return _fits(a, b, local_minima(grid, below**2))


def _fits(a: Side, b: Side, minima: Indices) -> Array:
    """Select the minima that belong to a block, not to a neighbouring one, and align their windows."""
    i, j = minima.T
    rows = i + a.first
    columns = j + b.first
    kept = (rows >= a.windows.start) & (rows < a.windows.stop)
    kept &= (columns >= b.windows.start) & (columns < b.windows.stop)
    kept &= columns - rows >= a.cloud.window  # windows do not overlap, and each pair counts once
    fits = fit(a.cloud, b.cloud, i[kept], j[kept])
    return np.concatenate([[rows[kept], columns[kept]], fits])
