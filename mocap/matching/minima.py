"""The local minima of a distance grid: pairs of windows that are more alike than all their neighbours.

A grid that is too large to hold is cut into blocks, one for a worker at a time.
"""

from concurrent.futures import Executor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import run_in_order
from mocap.body.planar import from_ground
from mocap.errors import MocapError
from mocap.matching.distance_grids import EQUAL, Cloud, Floats, tiled_distances

AT_ONCE = 1024  # pairs measured together, to limit the memory
BLOCK = 1280  # windows on a side of a block

# Rows and columns from an entry to its eight neighbours, in reading order: the first four are before it.
NEIGHBOURS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


def local_minima(grid: ArrayLike, below: float = np.inf, *, equal: float = EQUAL) -> Indices:
    """Find the entries under a threshold that are lower than all eight neighbours [KGP02, 3.2].

    Entries beyond the border count as infinite. Of neighbours that are equal, the first in reading order
    counts as the lower one. A plateau therefore has one minimum or more, and no two of them side by side.

    Parameters
    ----------
    grid : shape (n, m).
    below : only entries under this value, in the grid's unit.
    equal : neighbours that differ by no more are equal, in the grid's unit. By default 1e-12, rounding of a
        `distance_grid`: where a body stands still or a clip repeats itself, distances differ by that alone.

    Returns
    -------
    Rows and columns, shape (N, 2), in reading order.

    Raises
    ------
    MocapError : for a grid that is not of two dimensions, or holds NaN.

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
    for down, right in NEIGHBOURS:
        entries = values[rows, columns]
        neighbours = padded[rows + 1 + down, columns + 1 + right]
        is_earlier = (down, right) < (0, 0)
        lower = entries < neighbours - equal if is_earlier else entries <= neighbours + equal
        # The first neighbour already rules out most entries.
        rows = rows[lower]
        columns = columns[lower]
    return np.stack([rows, columns], axis=-1)


def fit(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Array:
    """Align windows j with windows i: the remaining RMS distance, and the transform's angle, x and z.

    In the grid D is a difference of larger numbers. Measured point by point, as here, it is right down to 0.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    i, j : shape (N,), the first frames of their windows.

    Returns
    -------
    Shape (4, N): metres, radians, metres and metres.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> dot = np.array([[[0.0, 1, 0]], [[3, 1.5, 4]]])  # one point that moves
    >>> ready = cloud(dot, np.zeros(1), np.ones(1), 1, np.float64)
    >>> fit(ready, ready, np.array([0]), np.array([1]))[[0, 2, 3], 0]
    array([ 0.5, -3. , -4. ])
    """
    if len(i) > AT_ONCE:
        parts = [slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE)]
        return np.concatenate([fit(a, b, i[part], j[part]) for part in parts], axis=1)
    ground_a, heights_a = _whole_windows(a, i)
    ground_b, heights_b = _whole_windows(b, j)
    angle = np.angle((ground_a * ground_b.conj()).sum((1, 2)))
    residual = ground_a - np.exp(1j * angle)[:, None, None] * ground_b
    square = (np.abs(residual) ** 2).sum((1, 2)) + ((heights_a - heights_b) ** 2).sum((1, 2))
    translation = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.stack([np.sqrt(square), angle, *from_ground(translation).T])


def _whole_windows(cloud: Cloud, starts: Indices) -> tuple[NDArray[Any], Floats]:
    """Return points on the ground and their frames' centroids, (N, k, P + 1), and heights, (N, k, P)."""
    root_weight = cloud.heights.dtype.type(np.sqrt(1 / cloud.window))
    frames = starts[:, None] + np.arange(cloud.window)
    centroids = cloud.paths[starts][..., None]
    ground = np.concatenate([cloud.ground[frames] * root_weight, centroids], axis=2)
    return ground, cloud.heights[frames] * root_weight


class Side(NamedTuple):
    """One side of a block.

    windows : the windows whose minima the block finds.
    cloud : these, and one window more at each end if there is one: the neighbours of the outermost.
    first : the first window of `cloud`.
    """

    windows: range
    cloud: Cloud
    first: int


def find_minima(
    cloud: Cloud, below: float, *, progress: Progress = iter, executor: Executor | None = None
) -> Array:
    """Find the local minima of the distances between all windows of a cloud, above the diagonal.

    Parameters
    ----------
    cloud : all clips one after the other.
    below : only minima whose RMS distance is under this one, metres.
    progress, executor : as for `find_transitions`.

    Returns
    -------
    Shape (6, N): the first window and the second, at least a window's length later; the RMS distance in
    metres; and the angle, x and z of the transform that lays the second on the first.

    Examples
    --------
    A point rises and falls back; its last frame is 1 cm from its first.

    >>> from mocap.matching.distance_grids import cloud as prepare
    >>> points = np.array([[[0, height, 0]] for height in (1.0, 1.3, 1.6, 1.9, 1.01)])
    >>> ready = prepare(points, np.zeros(1), np.ones(1), 1, np.float64)
    >>> find_minima(ready, 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    count = len(cloud.sizes) - cloud.window + 1

    def side(start: int) -> Side:
        windows = range(start, min(start + BLOCK, count))
        first = max(windows.start - 1, 0)
        stop = min(windows.stop + 1, count)
        return Side(windows, cloud.part(slice(first, stop)), first)

    pairs = [(row, column) for row in range(0, count, BLOCK) for column in range(row, count, BLOCK)]
    tasks = ((side(row), side(column), below) for row, column in progress(pairs))
    return np.concatenate(list(run_in_order(_block_minima, tasks, executor)), axis=1)


def _block_minima(a: Side, b: Side, below: float) -> Array:
    """Find the minima of a block, the unit of work of one worker."""
    grid = tiled_distances(a.cloud, b.cloud, upper=a.windows == b.windows)
    i, j = local_minima(grid, below**2).T
    rows = i + a.first
    columns = j + b.first
    kept = (rows >= a.windows.start) & (rows < a.windows.stop)
    kept &= (columns >= b.windows.start) & (columns < b.windows.stop)
    kept &= columns - rows >= a.cloud.window  # no window overlaps itself, and each pair counts once
    fits = fit(a.cloud, b.cloud, i[kept], j[kept])
    return np.concatenate([[rows[kept], columns[kept]], fits])
