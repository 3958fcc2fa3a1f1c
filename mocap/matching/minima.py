"""The local minima of a distance grid: pairs of windows that are more alike than all their neighbours.

A grid that is too large to hold is cut into blocks, one for a worker at a time.
"""

from concurrent.futures import Executor

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap._shared.tasks import run_in_order
from mocap.body.planar import from_ground
from mocap.errors import MocapError
from mocap.matching.distance_grids import EQUAL, Cloud, tiled_distances

AT_ONCE = 1024  # pairs measured together, to limit the memory
BLOCK = 1280  # windows on a side of a block


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
    for r, c in ((r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)):
        own, beside = values[rows, columns], padded[rows + 1 + r, columns + 1 + c]
        # Most are out after the first neighbour.
        lower = own < beside - equal if (r, c) < (0, 0) else own <= beside + equal
        rows, columns = rows[lower], columns[lower]
    return np.stack([rows, columns], axis=-1)


def fit(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Array:
    """Lay windows j on windows i: the RMS distance that is left, and the transform's angle, x and z.

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
    root, frames = a.heights.dtype.type(np.sqrt(1 / a.window)), np.arange(a.window)
    ground, heights = [], []  # (N, k, P + 1) and (N, k, P) of each cloud
    for cloud, starts in ((a, i), (b, j)):
        each = starts[:, None] + frames
        ground.append(np.concatenate([cloud.ground[each] * root, cloud.paths[starts][..., None]], axis=2))
        heights.append(cloud.heights[each] * root)
    angle = np.angle((ground[0] * ground[1].conj()).sum((1, 2)))
    left = ground[0] - np.exp(1j * angle)[:, None, None] * ground[1]
    square = (np.abs(left) ** 2).sum((1, 2)) + ((heights[0] - heights[1]) ** 2).sum((1, 2))
    move = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.stack([np.sqrt(square), angle, *from_ground(move).T])


Side = tuple[range, int, Cloud]
"""The windows of a block's side; the first of the cloud, which has one more at each end; and the cloud."""


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
        own, first = range(start, min(start + BLOCK, count)), max(start - 1, 0)
        return own, first, cloud.part(slice(first, min(own.stop + 1, count)))

    pairs = [(row, column) for row in range(0, count, BLOCK) for column in range(row, count, BLOCK)]
    tasks = ((side(row), side(column), below) for row, column in progress(pairs))
    return np.concatenate(list(run_in_order(_block_minima, tasks, executor)), axis=1)


def _block_minima(a: Side, b: Side, below: float) -> Array:
    """Find the minima of a block: what one worker does at a time."""
    (rows, top, first), (columns, left, second) = a, b
    i, j = local_minima(tiled_distances(first, second, upper=rows == columns), below**2).T
    row, column = i + top, j + left
    own = (row >= rows.start) & (row < rows.stop) & (column >= columns.start) & (column < columns.stop)
    own &= column - row >= first.window  # no window overlaps itself, and each pair counts once
    return np.concatenate([[row[own], column[own]], fit(first, second, i[own], j[own])])
