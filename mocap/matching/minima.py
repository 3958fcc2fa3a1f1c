"""The local minima of a distance grid: pairs of windows that are more alike than all their neighbours."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Indices
from mocap.errors import MocapError


def local_minima(grid: ArrayLike, below: float = np.inf) -> Indices:
    """Find the entries under a threshold that are lower than all eight neighbours [KGP02, 3.2].

    Entries beyond the border count as infinite. Of neighbours that are exactly equal, the first in reading
    order counts as the lower one. So a plateau has one minimum or more, and no two of them side by side.

    Parameters
    ----------
    grid : shape (n, m).
    below : only entries under this value, in the grid's unit.

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
    left = _lowest(values[rows, columns], lambda at, r, c: padded[rows[at] + 1 + r, columns[at] + 1 + c])
    return np.stack([rows[left], columns[left]], axis=-1)


def _lowest(values: NDArray[Any], beside: Callable[[Indices, int, int], NDArray[Any]]) -> Indices:
    """Find the entries that are lower than all eight neighbours, as indices.

    `beside` gives for some entries the neighbours that lie so many rows and columns further. Most entries are
    out after the first neighbour, so each step looks only at those that are left.
    """
    left = np.arange(len(values))
    for row, column in ((r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)):
        neighbour = beside(left, row, column)
        before = (row, column) < (0, 0)
        left = left[values[left] < neighbour if before else values[left] <= neighbour]
    return left


def listed_minima(pairs: Indices, values: NDArray[Any]) -> Indices:
    """Find the local minima of a grid of which only some entries are listed, as by `local_minima`.

    Parameters
    ----------
    pairs : rows and columns, shape (2, N), each pair once; entries that are not listed count as infinite.
    values : shape (N,).

    Returns
    -------
    Which of the pairs are minima, as indices in reading order.

    Examples
    --------
    >>> listed_minima(np.array([[0, 0, 7], [0, 1, 2]]), np.array([3.0, 2.0, 5.0]))
    array([1, 2])
    """
    rows, columns = pairs
    width = columns.max(initial=0) + 3  # the entries beside a row's ends are those of no other row
    keys = rows * width + columns
    order = np.argsort(keys)
    keys, sorted_values = keys[order], np.append(values[order], np.inf)

    def beside(left: Indices, row: int, column: int) -> NDArray[Any]:
        wanted = keys[left] + row * width + column
        at = np.searchsorted(keys, wanted)
        return np.where(np.append(keys, -1)[at] == wanted, sorted_values[at], np.inf)

    return np.asarray(order[_lowest(sorted_values[:-1], beside)])
