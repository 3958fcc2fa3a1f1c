"""The paths in a grid that is too large to hold: it is made and searched piece by piece."""

from collections.abc import Sequence
from concurrent.futures import Executor
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap._shared.tasks import run_in_order
from mocap.matching.distance_grids import Cloud, Floats, cloud_distances, tiles
from mocap.methods.match_webs.local_alignment import apart, local_paths
from mocap.methods.match_webs.valleys import minima_1d

ROWS, COLUMNS = 600, 4000  # windows on the sides of the part of the grid that a worker gets at a time


class Limits(NamedTuple):
    """What a path must be: `PathShape` with `least` and `near` in frames, and `below` in metres."""

    below: float
    slope: int
    least: int
    off_minimum: float
    near: int


class Piece(NamedTuple):
    """Windows in a row, from number `start` on."""

    start: int
    cloud: Cloud


class Grid(NamedTuple):
    """All windows of some clips in a row; `starts` says where each clip begins, and where the last ends."""

    cloud: Cloud
    starts: Indices
    taper: Array
    limits: Limits

    def paths(self, overlap: int, progress: Progress, executor: Executor | None) -> list[Array]:
        """Find the paths above the diagonal, each of shape (K, 3): two windows and their RMS distance.

        Parameters
        ----------
        overlap : windows that two parts of a long clip share.
        progress, executor : as for `build_web`.
        """
        rows, columns = (pieces(self.starts.tolist(), most, overlap) for most in (ROWS, COLUMNS))
        pairs = [
            (row, slice(max(row.start, column.start), column.stop))  # nothing lies below the diagonal
            for row in rows
            for column in columns
            if column.stop > row.start
        ]
        tasks = ((self._piece(i), self._piece(j), self.taper, self.limits) for i, j in progress(pairs))
        found = []
        for cells in run_in_order(paths_between, tasks, executor):
            ends = np.flatnonzero(np.diff(cells[:, 0])) + 1
            found += [path for path in np.split(cells[:, 1:], ends) if len(path)]
        if np.diff(self.starts).max() > ROWS:  # then parts of a clip may have found the same
            found.sort(key=lambda path: float((path[:, 2] - self.limits.below).sum()))
            found = apart(found, near=self.limits.near)
        return found

    def _piece(self, windows: slice) -> Piece:
        count = len(self.cloud.sizes) - len(self.taper) + 1
        return Piece(windows.start, self.cloud.part(slice(windows.start, min(windows.stop, count))))


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


def paths_between(a: Piece, b: Piece, taper: Array, limits: Limits) -> Array:
    """Find the paths in the grid of two pieces: what one worker does at a time.

    Parameters
    ----------
    a, b : the same piece twice, or a later one second.
    taper : shape (k,), the weights of a window's frames.
    limits : what a path must be.

    Returns
    -------
    Shape (N, 4), path after path, best first: the path's number, the two windows, and their RMS distance in
    metres.
    """
    grid = _distances(a, b, taper, limits.least)
    costs = grid - np.float32(limits.below)
    costs += np.where(minima_1d(grid), np.float32(0), np.float32(limits.off_minimum * limits.below))
    paths = apart(local_paths(costs, slope=limits.slope, least=limits.least), near=limits.near)
    numbers = np.repeat(np.arange(len(paths)), [len(path) for path in paths])
    cells = np.concatenate([np.empty((0, 2), np.intp), *paths])
    places = cells + np.array([a.start, b.start])
    return np.column_stack([numbers, places, grid[cells[:, 0], cells[:, 1]]])


def _distances(a: Piece, b: Piece, taper: Array, least: int) -> Floats:
    """Measure √D of all pairs of windows; infinite where the second is not at least so much later."""
    grid = np.empty((len(a.cloud.sizes), len(b.cloud.sizes)), a.cloud.heights.dtype)
    for tile in tiles(*grid.shape):
        grid[tile] = cloud_distances(a.cloud.part(tile[0]), b.cloud.part(tile[1]), taper)
    np.sqrt(grid, out=grid)
    if a.start + len(grid) + least > b.start:
        grid[np.tri(*grid.shape, a.start - b.start + least - 1, dtype=bool)] = np.inf
    return grid
