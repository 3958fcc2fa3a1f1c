"""The valleys of a distance grid: cells that are lowest along their row, or along their column."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Mask
from mocap.errors import MocapError


def minima_1d(grid: ArrayLike) -> Mask:
    """Mark the cells of a grid that are no higher than both neighbours in their row, or in their column.

    In the paper: [KG04, minima].

    Where two clips move alike at any pace, the grid has a valley. Its floor consists of such minima [KG04];
    of local minima in two dimensions a valley has only a few.

    Parameters
    ----------
    grid : shape (n, m); cells beyond the border count as infinite, and infinite cells are no minima.

    Returns
    -------
    Shape (n, m), booleans.

    Raises
    ------
    MocapError : for a grid that is not of two dimensions.

    Examples
    --------
    >>> minima_1d([[0, 2, 3, 4], [2, 1, 2, 3], [3, 2, 2, 4]]).astype(int)
    array([[1, 0, 0, 0],
           [0, 1, 1, 1],
           [0, 1, 1, 0]])

    Notebook: 16-match-webs
    """
    cells = np.asarray(grid)
    if cells.ndim != 2:
        raise MocapError(f"A grid has two dimensions, got shape {cells.shape}.")
    marks = np.zeros(cells.shape, bool)
    for values, found in ((cells, marks), (cells.T, marks.T)):
        low = np.ones(values.shape, bool)
        low[:, 1:] = values[:, 1:] <= values[:, :-1]
        low[:, :-1] &= values[:, :-1] <= values[:, 1:]
        found |= low
    return np.asarray(marks & (cells < np.inf))
