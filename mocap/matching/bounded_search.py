"""The local minima below a threshold, of which only the pairs that the lower bound leaves are measured.

1. A k-d tree finds the pairs of windows whose projections on few directions are within reach.
2. A second look, at more directions, leaves fewer.
3. What is left is measured exactly. A neighbour that was not measured costs more than the threshold, so the
   local minima are those of the measured pairs.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap._shared.tasks import run_in_order
from mocap.matching.chosen_pairs import fit, pair_distances, runs
from mocap.matching.distance_grids import Cloud, Floats
from mocap.matching.lower_bound import Weights, evenly, projections, reach, sample_directions, whole_windows
from mocap.matching.minima import listed_minima

Indices = NDArray[np.intp]

BLOCK = 16384  # windows on each side of the part of the grid that a worker gets at a time
ROWS = 1024  # of these on one side are looked up at a time, so that even a loose threshold leaves memory
FIRST = 12  # directions of the k-d tree
AT_ONCE = 1 << 13  # pairs in a second look
MANY = 5_000  # windows up to which products are quicker
LOOSE = 0.005  # share of pairs within reach above which products are quicker
SAMPLE = 2000  # windows that decide on this share


class Stretch(NamedTuple):
    """The windows [start, stop) of a cloud, and one more on each side where there is one.

    starts : shape (n,), the first frames of those that do not run off a clip, counted from `first`.
    places : shape (n, d), their projections.
    """

    start: int
    stop: int
    first: int
    cloud: Cloud
    starts: Indices
    places: Floats


def is_quicker(cloud: Cloud, weights: Weights, below: float) -> bool:
    """Say whether the bound is quicker than products: there are many windows, and it rules most pairs out.

    Parameters
    ----------
    cloud, weights, below : as for `find_minima_by_bound`.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud as prepare
    >>> weights = Weights(np.ones(1), np.ones(1))
    >>> is_quicker(prepare(np.zeros((5, 1, 3)), np.zeros(1), *weights, np.float64), weights, 0.04)
    False
    """
    windows = whole_windows(cloud)
    if len(windows) <= MANY:
        return False
    places = projections(cloud, evenly(windows, SAMPLE), weights, sample_directions(cloud, weights))
    tree = cKDTree(places.astype(float))
    return bool(tree.count_neighbors(tree, reach(cloud, below)) < LOOSE * len(places) ** 2)


def find_minima_by_bound(
    cloud: Cloud,
    weights: Weights,
    below: float,
    *,
    progress: Progress = iter,
    executor: Executor | None = None,
) -> Array:
    """Find what `find_minima` finds, from the pairs alone that the lower bound leaves.

    Parameters
    ----------
    cloud, weights, below, progress, executor : as for `find_minima`.

    Returns
    -------
    Shape (6, N), as by `find_minima`, in another order.

    Examples
    --------
    A point rises and falls back; its last frame is 1 cm from its first.

    >>> from mocap.matching.distance_grids import cloud as prepare
    >>> points = np.array([[[0, height, 0]] for height in (1.0, 1.3, 1.6, 1.9, 1.01)])
    >>> weights = Weights(np.ones(1), np.ones(1))
    >>> ready = prepare(points, np.zeros(1), *weights, np.float64)
    >>> find_minima_by_bound(ready, weights, 0.05)[:3].round(6)
    array([[0.  ],
           [4.  ],
           [0.01]])
    """
    starts = whole_windows(cloud)
    if not len(starts):
        return np.empty((6, 0))
    places = projections(cloud, starts, weights, sample_directions(cloud, weights))
    count = len(cloud.sizes) - len(weights.taper) + 1

    def stretch(start: int) -> Stretch:
        first, stop = max(start - 1, 0), min(start + BLOCK, count)
        end = min(stop + 1, count)
        mine = slice(*np.searchsorted(starts, (first, end)))
        return Stretch(start, stop, first, cloud.part(slice(first, end)), starts[mine] - first, places[mine])

    blocks = range(0, count, BLOCK)
    pairs = [(row, column) for row in blocks for column in blocks if row <= column]
    far = reach(cloud, below)
    tasks = ((stretch(i), stretch(j), weights.taper, below, far) for i, j in progress(pairs))
    return np.concatenate(list(run_in_order(_stretch_minima, tasks, executor)), axis=1)


def _stretch_minima(a: Stretch, b: Stretch, taper: Array, below: float, far: float) -> Array:
    """Find the minima between two stretches: what one worker does at a time."""
    window = len(taper)
    found = [np.empty((2, 0), np.intp)]
    values = [np.empty(0, a.cloud.heights.dtype)]
    for rows, columns in _near_pairs(a, b, window, far):
        i, j = runs(rows, columns)
        distances = pair_distances(a.cloud, b.cloud, i, j, taper)
        low = distances < below * below
        found.append(np.stack([i[low], j[low]]))
        values.append(distances[low])
    pairs = np.concatenate(found, axis=1)
    pairs = pairs[:, listed_minima(pairs, np.concatenate(values))]
    i, j = pairs + np.array([[a.first], [b.first]])
    own = (i >= a.start) & (i < a.stop) & (j >= b.start) & (j < b.stop) & (j - i >= window)
    return np.concatenate([[i[own], j[own]], fit(a.cloud, b.cloud, pairs[0, own], pairs[1, own], taper)])


def _near_pairs(a: Stretch, b: Stretch, window: int, far: float) -> Iterator[tuple[Indices, Indices]]:
    """Give the pairs of windows within reach; of those that overlap, only the neighbours of others."""
    tree = cKDTree(b.places[:, :FIRST].astype(float), balanced_tree=False)
    for start in range(0, len(a.starts), ROWS):
        some = cKDTree(a.places[start : start + ROWS, :FIRST].astype(float), balanced_tree=False)
        near = some.sparse_distance_matrix(tree, far, output_type="ndarray")
        rows, columns = near["i"] + start, near["j"]
        apart = b.starts[columns] + b.first - a.starts[rows] - a.first >= window - 2
        rows, columns = rows[apart], columns[apart]
        for part in range(0, len(rows), AT_ONCE):
            i, j = rows[part : part + AT_ONCE], columns[part : part + AT_ONCE]
            left = a.places[i] - b.places[j]
            close = np.einsum("nd,nd->n", left, left) <= far * far
            yield a.starts[i[close]], b.starts[j[close]]
