"""Time paths of long clips: only the distances in a band around the diagonal of their grid are computed.

See `time_bands` for the bands, and `time_paths` for the paths. For clips that are shorter than the band is
wide the band is the whole grid, and the path is that of `time_path(distance_grid(...))`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import one_blas_thread, run_in_order, thread_count
from mocap.matching.distance_grids import EQUAL, cloud_distances, tiled_distances
from mocap.matching.prepared_clouds import Cloud, Floats, prepared_windows
from mocap.matching.time_bands import Band, diagonal_band, widened
from mocap.matching.time_paths import least_mean_path, mean_of_cells
from mocap.matching.tuned import TUNED


class BandedPath(NamedTuple):
    """The time path of two clips, and the distances in the band in which it was found.

    path : cells (i, j), shape (N, 2), in ascending order.
    distances : the RMS distance √D at each cell of the band, metres.
    band : the cells of the grid.
    """

    path: Indices
    distances: Floats
    band: Band

    @property
    def mean(self) -> float:
        """The mean distance along the path, metres, as by `path_mean`."""
        return mean_of_cells(self.distances[self.band.cells(*self.path.T)], self.path)

    def interpolated(self, rows: ArrayLike, columns: ArrayLike) -> Array:
        """Interpolate the distances at places in the grid, infinite at places outside the band.

        Places outside the grid are moved to its nearest edge.
        """
        last_row = len(self.band.first) - 1
        last_column = self.band.columns - 1
        row = np.clip(np.asarray(rows, float), 0, last_row)
        column = np.clip(np.asarray(columns, float), 0, last_column)
        above = row.astype(np.intp)
        first_column = column.astype(np.intp)
        below = np.minimum(above + 1, last_row)
        next_column = np.minimum(first_column + 1, last_column)
        row_part = row - above
        column_part = column - first_column
        first_upper = self._at_cells(above, first_column)
        first_lower = self._at_cells(below, first_column)
        upper = first_upper * (1 - column_part) + self._at_cells(above, next_column) * column_part
        lower = first_lower * (1 - column_part) + self._at_cells(below, next_column) * column_part
        return np.asarray(upper * (1 - row_part) + lower * row_part)

    def _at_cells(self, rows: Indices, columns: Indices) -> Array:
        """Return the distances at cells of the grid; outside the band they are larger than any other."""
        is_inside = self.band.includes(rows, columns)
        cells = np.where(is_inside, self.band.cells(rows, columns), 0)
        return np.where(is_inside, self.distances[cells], np.finfo(float).max / 4)


def banded_path(  # noqa: PLR0913 (two clips, and the settings of a path and of a band)
    a: Array, b: Array, *, window: int, slope: int, slack: int, half_width: int, margin: int
) -> BandedPath:
    """Find the path of minimum mean distance of two clips in a band, which widens where the path needs it.

    Parameters
    ----------
    a, b : points of shape (F, P, 3), metres.
    window : the number of frames in a window.
    slope, slack : as for `time_path`.
    half_width : the number of frames on either side of the diagonal at first.
    margin : the number of frames at which a path is so near an edge of the band that the band is doubled
        there, and the path is searched again.

    Raises
    ------
    MocapError : for points that `distance_grid` refuses, and lengths that the slope does not allow.

    Examples
    --------
    >>> pendulum = np.sin(np.arange(60) / 5)[:, None, None] * [[0.0, 0, 0], [0, 1, 0]]
    >>> found = banded_path(pendulum, pendulum, window=5, slope=2, slack=0, half_width=9, margin=2)
    >>> found.path[[0, -1]].tolist(), found.mean, len(found.distances) < 56 * 56
    ([[0, 0], [55, 55]], 0.0, True)
    """
    windows_a, windows_b = prepared_windows(a, b, window=window)
    half_widths = np.full(len(windows_a.sizes), half_width)
    while True:
        band = diagonal_band(half_widths, len(windows_b.sizes))
        distances = np.sqrt(_band_distances(windows_a, windows_b, band))
        path = least_mean_path(distances, band, slope, slack)
        wider = widened(half_widths, band, path, margin)
        if wider is None:
            return BandedPath(path, distances, band)
        half_widths = wider


def _band_distances(a: Cloud, b: Cloud, band: Band) -> Floats:
    """Compute D between the windows of two clouds, for the cells of a band, tile by tile, shape (N,)."""
    zero_below = EQUAL if a.heights.dtype == np.float64 else 0.0
    if band.is_whole:
        return tiled_distances(a, b, mirror=a is b, zero_below=zero_below, jobs=None).ravel()
    tile_rows, tile_columns = TUNED.tile
    values = np.empty(band.offsets[-1], a.heights.dtype)

    def measure_row_of_tiles(top: int) -> None:
        bottom = min(top + tile_rows, len(band.first))
        part_of_a = a.part(slice(top, bottom))
        # The tiles are those of the whole grid, therefore the distances are the same to the last bit.
        begin = band.first[top] // tile_columns * tile_columns
        edges = range(begin, band.stop[bottom - 1], tile_columns)
        parts_of_b = [b.part(slice(edge, min(edge + tile_columns, band.columns))) for edge in edges]
        strip = np.concatenate([cloud_distances(part_of_a, part) for part in parts_of_b], axis=1)
        strip[strip < zero_below] = 0.0
        for row in range(top, bottom):
            columns = slice(band.first[row] - begin, band.stop[row] - begin)
            values[band.offsets[row] : band.offsets[row + 1]] = strip[row - top, columns]

    tasks = [(row,) for row in range(0, len(band.first), tile_rows)]
    threads = thread_count(None) if len(values) > TUNED.small_grid else 1
    with one_blas_thread():
        for _ in run_in_order(measure_row_of_tiles, tasks, None, threads):
            pass
    return values
