"""Long stretches along which two clips are alike: local alignment in the grid of their distances.

A grid of costs is below 0 where two clips are more alike than asked, and above 0 where they are less. A path
may begin and end anywhere, and ends where its sum is lowest [SW81]. So it follows what is alike, and crosses
what is not only as long as it has earned enough to pay for that. The dynamic programme is that of
`matching.time_paths`, where every cell may begin a path:

    A[j] = 2 c + min(0, M₋[j - 1]),    all other states as there.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Indices, Mask
from mocap.matching.time_paths import PathSums, origins, path_sums, trace


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

    Examples
    --------
    >>> minima_1d([[0, 2, 3, 4], [2, 1, 2, 3], [3, 2, 2, 4]]).astype(int)
    array([[1, 0, 0, 0],
           [0, 1, 1, 1],
           [0, 1, 1, 0]])

    Notebook: 16-match-webs
    """
    cells = np.asarray(grid)
    marks = np.zeros(cells.shape, bool)
    for values, found in ((cells, marks), (cells.T, marks.T)):
        low = np.ones(values.shape, bool)
        low[:, 1:] = values[:, 1:] <= values[:, :-1]
        low[:, :-1] &= values[:, :-1] <= values[:, 1:]
        found |= low
    return np.asarray(marks & (cells < np.inf))


def local_paths(costs: ArrayLike, *, slope: int = 2, least: int = 1) -> Iterator[Indices]:
    """Find paths of low cost that may begin and end anywhere in a grid [KG04, chains and bridges].

    [KG04] takes three passes: chains of one-dimensional minima, those that are long enough, and bridges
    between their ends. One pass of local alignment in their place is ours.

    Parameters
    ----------
    costs : shape (n, m); a cell adds its cost once for each frame by which it advances the path. Infinite
        cells are never crossed.
    slope : how many steps down, or to the right, may follow each other.
    least : frames that a path advances in each of the two clips.

    Yields
    ------
    Paths of cells, shape (N, 2), lowest sum first; of those that begin in one cell, only the best. They may
    run side by side: `apart` keeps those that say something new.

    Examples
    --------
    >>> costs = np.ones((4, 5))
    >>> costs[[0, 1, 2], [1, 2, 4]] = -1
    >>> next(local_paths(costs)).tolist()
    [[0, 1], [1, 2], [1, 3], [2, 4]]

    Notebook: 16-match-webs
    """
    grid = np.asarray(costs)
    sums = path_sums(grid, np.ones(grid.shape, bool), slope=slope)
    for end in _ends(sums, least):
        yield trace(sums, divmod(int(end), grid.shape[1]))


def _ends(sums: PathSums, least: int) -> Indices:
    """List the best end of each beginning, best first, where the path advances far enough."""
    totals, begun = sums.totals.ravel(), origins(sums).ravel()
    cells = np.flatnonzero(totals < 0)
    best = np.zeros(len(totals), totals.dtype)
    np.minimum.at(best, begun[cells], totals[cells])
    cells = cells[totals[cells] == best[begun[cells]]]
    columns = sums.totals.shape[1]
    advance = np.array(np.divmod(cells, columns)) - np.divmod(begun[cells], columns)
    cells = cells[advance.min(axis=0) >= least]
    return np.asarray(cells[np.argsort(totals[cells], kind="stable")])


def apart(paths: Iterable[NDArray[Any]], *, near: int) -> list[NDArray[Any]]:
    """Keep the paths that say something new: at most half of each lies near those kept before it.

    Parameters
    ----------
    paths : shape (N, 2) or more, cells of one grid in their first two columns; best path first.
    near : columns up to which two cells of a row are near each other.

    Examples
    --------
    >>> down = np.stack([np.arange(4), np.arange(4)], axis=1)
    >>> len(apart([down, down + [0, 1], down + [0, 2]], near=1))
    2

    Notebook: 16-match-webs
    """
    taken = set[int]()
    beside = np.arange(-near, near + 1)
    kept = []
    for path in paths:
        cells = (path[:, :2] @ [1 << 32, 1]).astype(np.int64)  # one number for each cell
        if 2 * len(taken.intersection(cells.tolist())) <= len(cells):
            kept.append(path)
            taken.update((cells[:, None] + beside).ravel().tolist())
    return kept
