"""The local minima of a grid that is too large to hold: it is made and searched tile by tile."""

from concurrent.futures import Executor
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap._shared.tasks import run_in_order
from mocap.matching.chosen_pairs import fit
from mocap.matching.distance_grids import Cloud, cloud_distances, tiles
from mocap.matching.lower_bound import Weights
from mocap.matching.minima import local_minima

BLOCK = 1280  # windows on each side of the part of the grid that a worker gets at a time


class Block(NamedTuple):
    """The windows [start, stop) of a cloud, and one more on each side where there is one.

    So the block itself holds the neighbours that decide about a minimum at its border. `cloud` starts at
    the window `first`.
    """

    start: int
    stop: int
    first: int
    cloud: Cloud

    def part(self, windows: slice) -> tuple[int, Cloud]:
        """Take some windows, counted from `start`, with their neighbours; and the number of the first one."""
        low = max(self.start + windows.start - 1, self.first)
        high = min(self.start + windows.stop + 1, self.first + len(self.cloud.sizes))
        return low, self.cloud.part(slice(low - self.first, high - self.first))


def find_minima(
    cloud: Cloud,
    weights: Weights,
    below: float,
    *,
    progress: Progress = iter,
    executor: Executor | None = None,
) -> Array:
    """Find the local minima of the distances between all windows of a cloud, above the diagonal.

    Parameters
    ----------
    cloud : all clips one after the other.
    weights : those of the cloud.
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
    >>> weights = Weights(np.ones(1), np.ones(1))
    >>> ready = prepare(points, np.zeros(1), *weights, np.float64)
    >>> find_minima(ready, weights, 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    count = len(cloud.sizes) - len(weights.taper) + 1
    starts = range(0, count, BLOCK)
    pairs = [(row, column) for row in starts for column in starts if row <= column]

    def block(start: int) -> Block:
        first, stop = max(start - 1, 0), min(start + BLOCK, count)
        return Block(start, stop, first, cloud.part(slice(first, min(stop + 1, count))))

    tasks = ((block(row), block(column), weights.taper, below) for row, column in progress(pairs))
    return np.concatenate(list(run_in_order(_block_minima, tasks, executor)), axis=1)


def _block_minima(a: Block, b: Block, taper: Array, below: float) -> Array:
    """Find the minima in the grid of two blocks, tile by tile: what one worker does at a time."""
    window = len(taper)
    found = [np.empty((6, 0))]
    for rows, columns in tiles(a.stop - a.start, b.stop - b.start, upper=a.start == b.start):
        (top, part_a), (left, part_b) = a.part(rows), b.part(columns)
        minima = local_minima(cloud_distances(part_a, part_b, taper), below * below)
        i, j = minima[:, 0] + top, minima[:, 1] + left
        own = (i >= a.start + rows.start) & (i < a.start + rows.stop)
        own &= (j >= b.start + columns.start) & (j < b.start + columns.stop)
        own &= j - i >= window  # no window overlaps itself, and each pair counts once
        found.append(
            np.concatenate([[i[own], j[own]], fit(part_a, part_b, minima[own, 0], minima[own, 1], taper)])
        )
    return np.concatenate(found, axis=1)
