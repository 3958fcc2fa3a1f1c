"""The local minima of a grid that is too large to hold: it is made and searched tile by tile."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap.body.planar import from_ground
from mocap.matching.distance_grids import Cloud, cloud_distances, tiles
from mocap.matching.minima import local_minima

BLOCK = 1280  # windows on each side of the part of the grid that a worker gets at a time
AHEAD = 64  # pairs of blocks that workers have at once


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
    cloud: Cloud, below: float, *, progress: Progress = iter, executor: Executor | None = None
) -> Array:
    """Find the local minima of the distances between all windows of a cloud, above the diagonal.

    Parameters
    ----------
    cloud : all clips one after the other.
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
    >>> ready = prepare(points, np.zeros(1), np.ones(1), np.ones(1), np.float64)
    >>> find_minima(ready, 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    window = cloud.paths.shape[1]
    count = len(cloud.sizes) - window + 1
    starts = range(0, count, BLOCK)
    pairs = [(row, column) for row in starts for column in starts if row <= column]

    def block(start: int) -> Block:
        first, stop = max(start - 1, 0), min(start + BLOCK, count)
        return Block(start, stop, first, cloud.part(slice(first, min(stop + 1, count))))

    tasks = ((block(row), block(column), below) for row, column in progress(pairs))
    return np.concatenate(list(_run(_block_minima, tasks, executor)), axis=1)


def _run(
    work: Callable[..., Array], tasks: Iterable[tuple[Any, ...]], executor: Executor | None
) -> Iterator[Array]:
    """Work through tasks in their order; only AHEAD are out at once, since each carries its data along."""
    if executor is None:
        yield from (work(*task) for task in tasks)
        return
    waiting: deque[Future[Array]] = deque()
    try:
        for task in tasks:
            waiting.append(executor.submit(work, *task))
            if len(waiting) == AHEAD:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:  # after an error or Ctrl-C, no task is left that still waits
        for future in waiting:
            future.cancel()


def _block_minima(a: Block, b: Block, below: float) -> Array:
    """Find the minima in the grid of two blocks, tile by tile: what one worker does at a time."""
    window = a.cloud.paths.shape[1]
    taper = np.full(window, 1 / window)
    found = [np.empty((6, 0))]
    for rows, columns in tiles(a.stop - a.start, b.stop - b.start, upper=a.start == b.start):
        (top, part_a), (left, part_b) = a.part(rows), b.part(columns)
        minima = local_minima(cloud_distances(part_a, part_b, taper), below * below)
        i, j = minima[:, 0] + top, minima[:, 1] + left
        own = (i >= a.start + rows.start) & (i < a.start + rows.stop)
        own &= (j >= b.start + columns.start) & (j < b.start + columns.stop)
        own &= j - i >= window  # no window overlaps itself, and each pair counts once
        found.append(np.stack([i[own], j[own], *_fit(part_a, part_b, *minima[own].T)]))
    return np.concatenate(found, axis=1)


def _fit(a: Cloud, b: Cloud, i: NDArray[np.intp], j: NDArray[np.intp]) -> tuple[Array, ...]:
    """Lay windows j on windows i: the RMS distance that is left, and the transform's angle, x and z.

    In the grid D is a difference of larger numbers. Measured point by point, as here, it is right down to 0.
    """
    frames = np.arange(a.paths.shape[1])
    scale = a.heights.dtype.type(len(frames) ** -0.5)  # the square root of a frame's weight

    def windows(cloud: Cloud, starts: NDArray[np.intp]) -> tuple[NDArray[Any], NDArray[Any]]:
        each = starts[:, None] + frames
        ground = np.concatenate([cloud.ground[each] * scale, cloud.paths[starts][..., None]], axis=2)
        return ground, cloud.heights[each] * scale  # (N, k, P + 1), (N, k, P)

    (ground_a, heights_a), (ground_b, heights_b) = windows(a, i), windows(b, j)
    angle = np.angle((ground_a * ground_b.conj()).sum((1, 2)))
    left = ground_a - np.exp(1j * angle)[:, None, None] * ground_b
    square = (np.abs(left) ** 2).sum((1, 2)) + ((heights_a - heights_b) ** 2).sum((1, 2))
    move = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.sqrt(square), angle, *from_ground(move).T
