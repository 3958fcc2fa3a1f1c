"""The local minima of a distance grid: pairs of windows that are more alike than all their neighbours."""

import numpy as np
from numpy.typing import ArrayLike

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
    for r, c in ((r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)):
        own, beside = values[rows, columns], padded[rows + 1 + r, columns + 1 + c]
        lower = own < beside if (r, c) < (0, 0) else own <= beside  # most are out after the first neighbour
        rows, columns = rows[lower], columns[lower]
    return np.stack([rows, columns], axis=-1)
