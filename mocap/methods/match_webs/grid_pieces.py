"""The paths in a grid that is too large to hold: it is made and searched piece by piece."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap.matching.distance_grids import Cloud, Floats, tiled_distances
from mocap.methods.match_webs.local_alignment import apart, local_paths, minima_1d

ROWS, COLUMNS = 600, 4000  # windows on the sides of the part of the grid that is worked on at a time
OVERLAP = 300  # windows that two parts of a long clip share, 10 s: no query is longer
SLOPE = 2  # frames of one clip at most in a row that lie on one frame of the other
LEAST = 9  # frames that a path advances in each clip, 0.3 s
NEAR = 3  # frames; a path of which more than half lies so close to a better one is left out
OFF_MINIMUM = 0.5  # by how much a cell that is no one-dimensional minimum costs more, in units of `below`


def find_paths(cloud: Cloud, starts: Indices, below: float, progress: Progress) -> list[Array]:
    """Find the paths above the diagonal, each of shape (K, 3): two windows and their RMS distance.

    Parameters
    ----------
    cloud : all windows of some clips in a row.
    starts : where each clip begins, and where the last ends.
    below : the mean distance that a path may have, metres.
    progress : as for `build_web`.
    """
    rows, columns = (pieces(starts.tolist(), most, OVERLAP) for most in (ROWS, COLUMNS))
    pairs = [
        (row, slice(max(row.start, column.start), column.stop))  # nothing lies below the diagonal
        for row in rows
        for column in columns
        if column.stop > row.start
    ]
    last = len(cloud.sizes) - cloud.window + 1
    found = []
    for pair in progress(pairs):
        a, b = (cloud.part(slice(part.start, min(part.stop, last))) for part in pair)
        cells = paths_between(a, b, (pair[0].start, pair[1].start), below)
        ends = np.flatnonzero(np.diff(cells[:, 0])) + 1
        found += [path for path in np.split(cells[:, 1:], ends) if len(path)]
    if np.diff(starts).max() > ROWS:  # then parts of a clip may have found the same
        found.sort(key=lambda path: float((path[:, 2] - below).sum()))
        found = apart(found, near=NEAR)
    return found


def pieces(starts: Sequence[int], most: int, overlap: int) -> list[slice]:
    """Cut clips in a row into pieces: whole clips together, or overlapping parts of a long one.

    Parameters
    ----------
    starts : where each clip begins, and where the last one ends.
    most : windows in a piece.
    overlap : windows that two parts of a clip share.

    Examples
    --------
    >>> [(p.start, p.stop) for p in pieces([0, 40, 70, 100, 350], most=100, overlap=20)]
    [(0, 100), (100, 200), (180, 280), (260, 350)]
    """
    found: list[slice] = []
    begin = starts[0]
    for start, stop in pairwise(starts):
        if stop - begin > most and begin < start:
            found.append(slice(begin, start))
            begin = start
        while stop - begin > most:
            found.append(slice(begin, begin + most))
            begin += most - overlap
    return [*found, slice(begin, starts[-1])]


def paths_between(a: Cloud, b: Cloud, corner: tuple[int, int], below: float) -> Array:
    """Find the paths in the grid of two pieces.

    Parameters
    ----------
    a, b : the same piece twice, or a later one second.
    corner : their first windows, in the numbering of all.
    below : as for `find_paths`.

    Returns
    -------
    Shape (N, 4), path after path, best first: the path's number, the two windows, and their RMS distance in
    metres.
    """
    grid: Floats = np.sqrt(tiled_distances(a, b))
    first = corner[0] - corner[1] + LEAST  # the second window is at least so much later
    if first + len(grid) > 0:
        grid[np.tri(len(grid), grid.shape[1], first - 1, dtype=bool)] = np.inf
    costs = grid - np.float32(below)
    costs += np.where(minima_1d(grid), np.float32(0), np.float32(OFF_MINIMUM * below))
    paths = apart(local_paths(costs, slope=SLOPE, least=LEAST), near=NEAR)
    numbers = np.repeat(np.arange(len(paths)), [len(path) for path in paths])
    cells = np.concatenate([np.empty((0, 2), np.intp), *paths])
    return np.column_stack([numbers, cells + np.array(corner), grid[tuple(cells.T)]])
