"""Bands of a distance grid around its diagonal, in which time paths are searched first.

The time path of two clips that do similar things at similar times stays near the diagonal. The cells further
off cost time and memory for nothing: two clips of ten minutes have 324 million pairs of windows, of which 3 %
are within ten seconds of the diagonal. The search is therefore confined to a band, as that of [SC78]. If the
path comes near an edge of the band, the band is doubled there, and the path is searched again.

The values of a band are stored row after row in one array. A band of all columns is a whole grid.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from mocap._shared.arrays import Indices, Mask
from mocap._shared.records import NamedTuple


class Band(NamedTuple):
    """The columns of a grid that a band includes in each row; neither limit ever falls from row to row.

    first : (n,), the first column of a row.
    stop : (n,), the column behind the last one of a row.
    offsets : (n + 1,), the index of the first cell of each row in the array of all cells, and their number.
    columns : the number m of columns of the grid.

    Examples
    --------
    >>> band = band_between(np.array([0, 0, 1]), np.array([2, 3, 3]), 3)
    >>> band.offsets, band.cells(np.array([1, 2]), np.array([2, 1]))
    (array([0, 2, 5, 7]), array([4, 5]))
    """

    first: Indices
    stop: Indices
    offsets: Indices
    columns: int

    @property
    def is_whole(self) -> bool:
        """Whether the band includes all cells of the grid."""
        return bool(self.offsets[-1] == self.columns * len(self.first))

    def includes(self, rows: Indices, columns: Indices) -> Mask:
        """Tell which cells of the grid are in the band."""
        return np.asarray((self.first[rows] <= columns) & (columns < self.stop[rows]))

    def cells(self, rows: Indices, columns: Indices) -> Indices:
        """Return the indices of cells in the array of all cells. The cells must be in the band."""
        return np.asarray(self.offsets[rows] + columns - self.first[rows])

    def place(self, cell: int) -> tuple[int, int]:
        """Return the row and the column of a cell, given its index in the array of all cells."""
        row = int(np.searchsorted(self.offsets, cell, side="right")) - 1
        return row, cell - int(self.offsets[row]) + int(self.first[row])


def band_between(first: Indices, stop: Indices, columns: int) -> Band:
    """Return the band between two limits, shape (n,), of a grid with so many columns."""
    return Band(first, stop, np.append(0, np.cumsum(stop - first)), columns)


def whole_band(rows: int, columns: int) -> Band:
    """Return the band that includes all cells of a grid.

    Examples
    --------
    >>> whole_band(2, 3).is_whole, whole_band(2, 3).place(4)
    (True, (1, 1))
    """
    return band_between(np.zeros(rows, np.intp), np.full(rows, columns), columns)


def diagonal_band(half_widths: Indices, columns: int) -> Band:
    """Return a band around the diagonal of a grid.

    Parameters
    ----------
    half_widths : (n,), the number of columns on either side of the diagonal in each row, at least.
    columns : m.

    Examples
    --------
    >>> band = diagonal_band(np.array([1, 1, 1, 1]), 7)
    >>> band.first, band.stop
    (array([0, 1, 3, 5]), array([2, 4, 6, 7]))
    """
    rows = len(half_widths)
    diagonal = np.linspace(0, columns - 1, rows)
    # A limit that fell would leave cells that no path could enter.
    first = np.minimum.accumulate(np.ceil(diagonal - half_widths)[::-1])[::-1]
    stop = np.maximum.accumulate(np.floor(diagonal + half_widths)) + 1
    first = np.clip(first, 0, columns - 1).astype(np.intp)
    stop = np.clip(stop, 1, columns).astype(np.intp)
    return band_between(first, stop, columns)


def widened(half_widths: Indices, band: Band, path: Indices, margin: int) -> Indices | None:
    """Double the half-widths of a diagonal band wherever a path comes near its edge.

    Parameters
    ----------
    half_widths : (n,), those of the band.
    band : from `diagonal_band`.
    path : cells, shape (N, 2).
    margin : the number of columns at which a path is near an edge. The first and the last column of the grid
        are no edges.

    Returns
    -------
    The half-widths, shape (n,), or None if the path is nowhere near an edge. They are doubled in as many rows
    before and after as the band is wide, in which the path may now leave the old band.

    Examples
    --------
    >>> narrow = np.full(9, 2)
    >>> widened(narrow, diagonal_band(narrow, 9), np.array([[3, 3], [4, 6], [5, 6]]), margin=1)
    array([2, 2, 4, 4, 4, 4, 4, 2, 2])
    """
    rows, columns = path.T
    near_first = (band.first[rows] > 0) & (columns < band.first[rows] + margin)
    near_stop = (band.stop[rows] < band.columns) & (columns >= band.stop[rows] - margin)
    touched = np.unique(rows[near_first | near_stop])
    if not len(touched):
        return None
    is_touched = np.zeros(len(half_widths), bool)
    is_touched[touched] = True
    reach = int(half_widths[touched].max())
    is_near = maximum_filter1d(is_touched.astype(np.int8), 2 * reach + 1, mode="constant") > 0
    return np.where(is_near, 2 * half_widths, half_widths)
