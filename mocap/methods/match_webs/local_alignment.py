"""Local alignment in a distance grid: long paths of similar frames of two clips.

Costs are negative for frames that are more similar than a limit, and positive for others. A path may begin in
any cell, and ends in the cell with the lowest sum [SW81]. It therefore follows similar frames, and crosses
others as long as its sum stays negative. The dynamic programme is that of `matching.time_paths`, except that
any cell may begin a path:

    A[j] = 2 c + min(0, M₋[j - 1]),    all other states as there.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.progress import Progress
from mocap._shared.ties import in_order
from mocap.matching import distance_grids
from mocap.matching.distance_grids import tiled_distances
from mocap.matching.prepared_clouds import Cloud, Floats
from mocap.matching.time_paths import origins, path_sums, trace
from mocap.methods.match_webs.tuned import TUNED

# Metres: distances of windows that differ by no more are equal. Rounding errors are about 1e-13 m.
EQUAL = 1e-9
# Metres: sums along a path, or their means, that differ by less are equal. The first path found is preferred.
RANKS = 1e-6


def minima_1d(grid: ArrayLike) -> Mask:
    """Mark one-dimensional minima: cells no higher than both neighbours in their row, or in their column.

    In the paper: [KG04, minima].

    If two clips are similar, at any pace, the grid has a valley. Its floor consists of one-dimensional minima
    [KG04], but it has only a few local minima in two dimensions.

    Parameters
    ----------
    grid : shape (n, m), metres. Cells beyond the border count as infinite, and infinite cells are not minima.
        Differences of a nanometre are ignored.

    Returns
    -------
    Shape (n, m), booleans.

    Examples
    --------
    >>> minima_1d([[0, 2, 3, 4], [2, 1, 2, 3], [3, 2, 2, 4]]).astype(int)
    array([[1, 0, 0, 0],
           [0, 1, 1, 1],
           [0, 1, 1, 0]])
    >>> minima_1d([[0, np.inf, np.inf, np.inf]]).tolist()
    [[True, False, False, False]]

    Notebook: 16-match-webs
    """
    cells = np.asarray(grid)
    padded = np.pad(cells.astype(np.result_type(cells, np.float32), copy=False), 1, mode="edge")
    padded += EQUAL
    in_rows = padded[1:-1]
    in_columns = padded[:, 1:-1]
    lowest_in_row = (cells <= in_rows[:, :-2]) & (cells <= in_rows[:, 2:])
    lowest_in_column = (cells <= in_columns[:-2]) & (cells <= in_columns[2:])
    return np.asarray((lowest_in_row | lowest_in_column) & (cells < np.inf))


# reads: name: users give `least` as a keyword
def local_paths(costs: ArrayLike, *, slope: int = 2, least: int = 1) -> Iterator[Indices]:
    """Find paths of low cost that may begin and end in any cell of a grid [KG04, chains and bridges].

    [KG04] uses three passes: find chains of one-dimensional minima, select those that are long enough, and
    bridge the gaps between their ends. A single pass of local alignment replaces them [ours].

    Parameters
    ----------
    costs : shape (n, m). A cell adds its cost once for each frame by which it advances the path. Infinite
        cells are never crossed.
    slope : largest number of consecutive steps down, or to the right.
    least : the smallest number of frames by which a path advances in each of the two clips.

    Yields
    ------
    Paths of cells, shape (N, 2), in ascending order of their sums. Of the paths that begin in one cell, only
    the best is yielded. Paths may run side by side: `local_alignment.apart` keeps the distinct ones.

    Examples
    --------
    >>> costs = np.ones((4, 5))
    >>> costs[[0, 1, 2], [1, 2, 4]] = -1
    >>> next(local_paths(costs)).tolist()
    [[0, 1], [1, 2], [1, 3], [2, 4]]

    The path advances two frames in the first clip, and three in the second:

    >>> [len(list(local_paths(costs, least=least))) for least in (2, 3)]
    [1, 0]

    Notebook: 16-match-webs
    """
    grid = np.asarray(costs)
    columns = grid.shape[1]
    sums = path_sums(grid, np.ones(grid.shape, bool), slope=slope)
    totals = sums.totals.ravel()
    beginnings = origins(sums).ravel()
    cells = np.flatnonzero(totals < 0)
    best = np.zeros(len(totals), totals.dtype)  # the lowest sum of all paths that begin in a cell
    np.minimum.at(best, beginnings[cells], totals[cells])
    is_best = totals[cells] <= best[beginnings[cells]] + sums.equal
    ends = cells[is_best]
    _, firsts = np.unique(beginnings[ends], return_index=True)
    ends = ends[firsts]  # the first of several with equal sums
    advance = np.array(np.divmod(ends, columns)) - np.divmod(beginnings[ends], columns)
    ends = ends[advance.min(axis=0) >= least]
    for end in ends[in_order(totals[ends], RANKS)]:
        yield trace(sums, divmod(int(end), columns))


# reads: name: notebook 16 shows this function, and calls it
def apart(paths: Iterable[NDArray[Any]], *, near: int) -> list[NDArray[Any]]:
    """Select distinct paths, of which at most half is near the paths selected before.

    Parameters
    ----------
    paths : in descending order of quality. Each has shape (N, 2) or more columns, of which the first two are
        the rows and columns of cells of one grid.
    near : the largest difference in columns of two cells of a row that are near each other.

    Examples
    --------
    >>> down = np.stack([np.arange(4), np.arange(4)], axis=1)
    >>> kept = apart([down + [0, columns] for columns in (0, 1, 2, -1, -2)], near=1)
    >>> [path[0].tolist() for path in kept]
    [[0, 0], [0, 2], [0, -2]]


    Notebook: 16-match-webs
    """
    covered = set[int]()
    offsets = np.arange(-near, near + 1)
    kept = []
    for path in paths:
        cells = (path[:, :2] @ [1 << 32, 1]).astype(np.int64)  # one number for each cell
        if 2 * len(covered.intersection(cells.tolist())) <= len(cells):
            kept.append(path)
            covered.update((cells[:, None] + offsets).ravel().tolist())
    return kept


OVERLAP = 300  # windows that two parts of a long clip share, 10 s: longer queries are not found across them
DISTANCE = 2  # column of a path with the RMS distances, after the columns of its windows


def find_paths(cloud: Cloud, starts: Indices, below: float, progress: Progress) -> list[Array]:
    """Find the paths above the diagonal, each of shape (K, 3) with two windows and their RMS distance.

    Parameters
    ----------
    cloud : all windows of the clips, clip by clip.
    starts : first window of each clip, and the end of the last clip.
    below : the mean distance that a path may have, metres.
    progress : as for `build_web`.
    """
    rows = pieces(starts.tolist(), TUNED.part_rows, OVERLAP)
    columns = pieces(starts.tolist(), TUNED.part_columns, OVERLAP)
    # No path is below the diagonal.
    pairs = [(row, column) for row in rows for column in columns if column.stop > row.start]
    tiles = [(row, slice(max(row.start, column.start), column.stop)) for row, column in pairs]
    paths: list[Array] = []
    for tile in progress(tiles):
        paths += _paths_in_tile(cloud, tile, below)
    if np.diff(starts).max() > TUNED.part_rows:  # two parts of one clip may have found the same path
        sums = [float((path[:, DISTANCE] - below).sum()) for path in paths]
        paths = apart((paths[number] for number in in_order(sums, RANKS)), near=TUNED.near_path)
    return paths


def _paths_in_tile(cloud: Cloud, tile: tuple[slice, slice], below: float) -> list[Array]:
    """Find the paths in a tile of the grid, a slice of its rows and a slice of its columns."""
    windows = len(cloud.sizes) - cloud.window + 1
    sides = [cloud.part(slice(side.start, min(side.stop, windows))) for side in tile]
    squares = tiled_distances(*sides)
    grid: Floats = np.sqrt(np.where(squares < distance_grids.EQUAL, 0.0, squares))
    corner = [side.start for side in tile]
    diagonal = corner[0] - corner[1] + TUNED.least_advance  # the second window is later
    if diagonal + len(grid) > 0:
        is_early = np.tri(len(grid), grid.shape[1], diagonal - 1, dtype=bool)
        grid[is_early] = np.inf
    penalties = np.where(minima_1d(grid), 0.0, TUNED.off_minimum * below)
    costs = grid - below + penalties
    paths = apart(local_paths(costs, slope=TUNED.slope, least=TUNED.least_advance), near=TUNED.near_path)
    return [np.column_stack([path + corner, grid[tuple(path.T)]]) for path in paths]


def pieces(starts: Sequence[int], size: int, overlap: int) -> list[slice]:
    """Partition consecutive clips into groups of whole clips and overlapping parts of long clips.

    Parameters
    ----------
    starts : first window of each clip, and the end of the last clip.
    size : largest number of windows in a piece.
    overlap : windows that two parts of a clip share.

    Examples
    --------
    >>> [(p.start, p.stop) for p in pieces([0, 40, 70, 100, 350], size=100, overlap=20)]
    [(0, 100), (100, 200), (180, 280), (260, 350)]
    >>> [(p.start, p.stop) for p in pieces([0, 60, 120, 180, 240], size=120, overlap=20)]
    [(0, 120), (120, 240)]
    """
    cut: list[slice] = []
    begin = starts[0]
    for start, stop in pairwise(starts):
        if stop - begin > size and begin < start:
            cut.append(slice(begin, start))
            begin = start
        while stop - begin > size:
            cut.append(slice(begin, begin + size))
            begin += size - overlap
    return [*cut, slice(begin, starts[-1])]
