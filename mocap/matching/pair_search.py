"""The local minima of a grid that is too large to hold, found by one of two searches.

All pairs of windows are cut into blocks of `Stretch` by `Stretch`, each of which a worker gets by itself.

1. *By products*: the block is measured tile by tile, and searched by `local_minima`.
2. *By the bound* of `lower_bound`: a k-d tree finds the pairs whose projections on few directions are within
   reach; a look at all directions leaves fewer; only these are measured. A neighbour that was not measured
   costs more than the threshold, so the minima are the same.

Both give each block the windows next to it, which decide about a minimum at its border.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array, Indices
from mocap._shared.progress import Progress
from mocap._shared.tasks import run_in_order
from mocap.body.planar import from_ground
from mocap.matching.distance_grids import Cloud, Floats, tiled_distances
from mocap.matching.lower_bound import evenly, projections, reach, sample_directions, whole_windows
from mocap.matching.minima import listed_minima, local_minima

AT_ONCE = 1024  # pairs measured together, to limit the memory


def pair_distances(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Floats:
    """Measure D between the windows i of one cloud and j of another, as `cloud_distances` does for all.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    i, j : shape (N,), the first frames of the windows.

    Returns
    -------
    Shape (N,), m², never negative.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> pair_distances(ready, ready, np.array([0]), np.array([1]))
    array([0.5])
    """
    if len(i) > AT_ONCE:
        parts = [slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE)]
        return np.concatenate([pair_distances(a, b, i[part], j[part]) for part in parts])
    share, frames = a.heights.dtype.type(1 / a.window), np.arange(a.window)
    rows, columns = i[:, None] + frames, j[:, None] + frames
    across = np.vecdot(a.paths[i], b.paths[j]) + share * np.vecdot(a.ground[rows], b.ground[columns]).sum(1)
    up = share * np.vecdot(a.heights[rows], b.heights[columns]).sum(1)
    return np.asarray(np.maximum(a.sizes[i] + b.sizes[j] - 2 * (np.abs(across) + up), 0))


def fit(a: Cloud, b: Cloud, i: Indices, j: Indices) -> Array:
    """Lay windows j on windows i: the RMS distance that is left, and the transform's angle, x and z.

    In the grid D is a difference of larger numbers. Measured point by point, as here, it is right down to 0.

    Parameters
    ----------
    a, b, i, j : as for `pair_distances`.

    Returns
    -------
    Shape (4, N): metres, radians, metres and metres.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> dot = np.array([[[0.0, 1, 0]], [[3, 1.5, 4]]])  # one point that moves
    >>> ready = cloud(dot, np.zeros(1), np.ones(1), 1, np.float64)
    >>> fit(ready, ready, np.array([0]), np.array([1]))[[0, 2, 3], 0]
    array([ 0.5, -3. , -4. ])
    """
    if len(i) > AT_ONCE:
        parts = [slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE)]
        return np.concatenate([fit(a, b, i[part], j[part]) for part in parts], axis=1)
    root, frames = a.heights.dtype.type(np.sqrt(1 / a.window)), np.arange(a.window)
    ground, heights = [], []  # (N, k, P + 1) and (N, k, P) of each cloud
    for cloud, starts in ((a, i), (b, j)):
        each = starts[:, None] + frames
        ground.append(np.concatenate([cloud.ground[each] * root, cloud.paths[starts][..., None]], axis=2))
        heights.append(cloud.heights[each] * root)
    angle = np.angle((ground[0] * ground[1].conj()).sum((1, 2)))
    left = ground[0] - np.exp(1j * angle)[:, None, None] * ground[1]
    square = (np.abs(left) ** 2).sum((1, 2)) + ((heights[0] - heights[1]) ** 2).sum((1, 2))
    move = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.stack([np.sqrt(square), angle, *from_ground(move).T])


BLOCK, WIDE_BLOCK = 1280, 16384  # windows of a stretch, by products and by the bound
ROWS = 1024  # of these are looked up in the tree at a time, so that even a loose threshold leaves memory
FIRST = 12  # directions of the k-d tree
LOOKED_AT = 1 << 13  # pairs in a second look
MANY = 5_000  # windows up to which products are quicker
LOOSE = 0.005  # share of pairs within reach above which products are quicker
SAMPLE = 2000  # windows that decide on this share
NOWHERE = 1e9  # metres between windows that run off their clips


class Stretch(NamedTuple):
    """The windows [start, stop) of a cloud, and one more on each side where there is one.

    first : the first window of `cloud`: `start`, or the one before.
    places : shape (n, d), the projections of the cloud's windows; by products d is 0.
    """

    start: int
    stop: int
    first: int
    cloud: Cloud
    places: Floats


def find_minima(  # noqa: PLR0913 (what to find, how, and where to work)
    cloud: Cloud,
    weights: Array,
    below: float,
    *,
    by_bound: bool = False,
    progress: Progress = iter,
    executor: Executor | None = None,
) -> Array:
    """Find the local minima of the distances between all windows of a cloud, above the diagonal.

    Parameters
    ----------
    cloud : all clips one after the other.
    weights : shape (P,), those of the cloud's points.
    below : only minima whose RMS distance is under this one, metres.
    by_bound : measure only the pairs that the lower bound leaves.
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
    >>> ready = prepare(points, np.zeros(1), np.ones(1), 1, np.float64)
    >>> find_minima(ready, np.ones(1), 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    if not len(whole_windows(cloud)):
        return np.empty((6, 0))
    count = len(cloud.sizes) - cloud.window + 1
    size, far = (WIDE_BLOCK, reach(cloud, below)) if by_bound else (BLOCK, None)
    places = _places(cloud, weights, count) if by_bound else np.empty((count, 0))

    def stretch(start: int) -> Stretch:
        first, stop = max(start - 1, 0), min(start + size, count)
        windows = slice(first, min(stop + 1, count))
        return Stretch(start, stop, first, cloud.part(windows), places[windows])

    pairs = [(row, column) for row in range(0, count, size) for column in range(row, count, size)]
    tasks = ((stretch(i), stretch(j), below, far) for i, j in progress(pairs))
    return np.concatenate(list(run_in_order(_block_minima, tasks, executor)), axis=1)


def _places(cloud: Cloud, weights: Array, count: int) -> Floats:
    """Project the f of all windows; those that run off a clip are put far from everything."""
    starts, directions = whole_windows(cloud), sample_directions(cloud, weights)
    far = NOWHERE * np.arange(1, count + 1)[:, None]
    places = np.repeat(far, directions[1].shape[1], axis=1).astype(cloud.heights.dtype)
    places[starts] = projections(cloud, starts, weights, directions)
    return places


def _block_minima(a: Stretch, b: Stretch, below: float, far: float | None) -> Array:
    """Find the minima between two stretches: what one worker does at a time."""
    if far is None:
        i, j = local_minima(tiled_distances(a.cloud, b.cloud, upper=a.start == b.start), below**2).T
    else:
        i, j = _by_bound(a, b, below, far)
    row, column = i + a.first, j + b.first
    own = (row >= a.start) & (row < a.stop) & (column >= b.start) & (column < b.stop)
    own &= column - row >= a.cloud.window  # no window overlaps itself, and each pair counts once
    return np.concatenate([[row[own], column[own]], fit(a.cloud, b.cloud, i[own], j[own])])


def _by_bound(a: Stretch, b: Stretch, below: float, far: float) -> Indices:
    """Find the minima of a block among the pairs within reach: rows and columns, shape (2, N)."""
    found, values = [np.empty((2, 0), np.intp)], [np.empty(0, a.cloud.heights.dtype)]
    for pairs in _near_pairs(a, b, far):
        distances = pair_distances(a.cloud, b.cloud, pairs[0], pairs[1])
        low = distances < below**2
        found.append(pairs[:, low])
        values.append(distances[low])
    every = np.concatenate(found, axis=1)
    return every[:, listed_minima(every, np.concatenate(values))]


def _near_pairs(a: Stretch, b: Stretch, far: float) -> Iterator[Indices]:
    """Give the pairs of windows within reach, (2, N); of those that overlap, only neighbours of others."""
    tree = cKDTree(b.places[:, :FIRST].astype(float), balanced_tree=False)
    for start in range(0, len(a.places), ROWS):
        some = cKDTree(a.places[start : start + ROWS, :FIRST].astype(float), balanced_tree=False)
        near = some.sparse_distance_matrix(tree, far, output_type="ndarray")
        pairs = np.stack([near["i"] + start, near["j"]])
        pairs = pairs[:, pairs[1] + b.first - pairs[0] - a.first >= a.cloud.window - 2]
        for part in range(0, pairs.shape[1], LOOKED_AT):
            i, j = pairs[:, part : part + LOOKED_AT]
            left = a.places[i] - b.places[j]
            close = np.einsum("nd,nd->n", left, left) <= far * far
            yield np.stack([i[close], j[close]])


def is_quicker(cloud: Cloud, weights: Array, below: float) -> bool:
    """Say whether the bound is quicker than products: there are many windows, and it rules most pairs out.

    Parameters
    ----------
    cloud, weights, below : as for `find_minima`.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud as prepare
    >>> is_quicker(prepare(np.zeros((5, 1, 3)), np.zeros(1), np.ones(1), 1, np.float64), np.ones(1), 0.04)
    False
    """
    windows = whole_windows(cloud)
    if len(windows) <= MANY:
        return False
    places = projections(cloud, evenly(windows, SAMPLE), weights, sample_directions(cloud, weights))
    tree = cKDTree(places.astype(float))
    return bool(tree.count_neighbors(tree, reach(cloud, below)) < LOOSE * len(places) ** 2)
