"""Chosen pairs of windows, measured one by one: the distance of each, and the transform that aligns it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.planar import from_ground
from mocap.matching.distance_grids import Cloud, Floats

Indices = NDArray[np.intp]

AT_ONCE = 1024  # pairs measured together, to limit the memory


def pair_distances(a: Cloud, b: Cloud, i: Indices, j: Indices, taper: Array) -> Floats:
    """Measure D between the windows i of one cloud and j of another, as `cloud_distances` does for all.

    Pairs that follow each other on a diagonal, (i, j) and (i + 1, j + 1), share all pairs of frames but one.
    So each pair of frames in such a run is multiplied once, and each window adds up k of these products.

    Parameters
    ----------
    a, b : two clouds, or the same one twice.
    i, j : shape (N,), the first frames of the windows; sorted by j - i, then by i.
    taper : shape (k,), as for `cloud`.

    Returns
    -------
    Shape (N,), m², never negative.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), np.ones(1), np.float64)
    >>> pair_distances(ready, ready, np.array([0]), np.array([1]), np.ones(1))
    array([0.5])
    """
    each = (slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE))
    found = [_distances(a, b, i[part], j[part], taper.astype(a.heights.dtype)) for part in each]
    return np.concatenate([np.empty(0, a.heights.dtype), *found])


def _distances(a: Cloud, b: Cloud, i: Indices, j: Indices, taper: Floats) -> Floats:
    window = len(taper)
    step = np.diff(i, prepend=i[0] - window)
    fresh = np.where((np.diff(j - i, prepend=j[0] - i[0]) == 0) & (step < window), step, window)
    ends = np.cumsum(fresh)  # of each window's products, in the list of all
    frames = np.arange(ends[-1]) - np.repeat(ends - window, fresh)
    rows, columns = np.repeat(i, fresh) + frames, np.repeat(j, fresh) + frames
    ground = np.vecdot(a.ground[rows], b.ground[columns])
    heights = np.vecdot(a.heights[rows], b.heights[columns])
    starts = ends - window
    across = np.vecdot(a.paths[i], b.paths[j])
    across += sum(weight * ground[starts + f] for f, weight in enumerate(taper))
    up = sum(weight * heights[starts + f] for f, weight in enumerate(taper))
    return np.asarray(np.maximum(a.sizes[i] + b.sizes[j] - 2 * (np.abs(across) + up), 0))


def fit(a: Cloud, b: Cloud, i: Indices, j: Indices, taper: Array) -> Array:
    """Lay windows j on windows i: the RMS distance that is left, and the transform's angle, x and z.

    In the grid D is a difference of larger numbers. Measured point by point, as here, it is right down to 0.

    Parameters
    ----------
    a, b, i, j, taper : as for `pair_distances`, in any order.

    Returns
    -------
    Shape (4, N): metres, radians, metres and metres.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> dot = np.array([[[0.0, 1, 0]], [[3, 1.5, 4]]])  # one point that moves
    >>> ready = cloud(dot, np.zeros(1), np.ones(1), np.ones(1), np.float64)
    >>> fit(ready, ready, np.array([0]), np.array([1]), np.ones(1))[[0, 2, 3], 0]
    array([ 0.5, -3. , -4. ])
    """
    parts = (slice(start, start + AT_ONCE) for start in range(0, len(i), AT_ONCE))
    return np.concatenate(
        [np.empty((4, 0)), *(_fits(a, b, i[part], j[part], taper) for part in parts)], axis=1
    )


def _fits(a: Cloud, b: Cloud, i: Indices, j: Indices, taper: Array) -> Array:
    root = np.sqrt(taper).astype(a.heights.dtype)[:, None]

    def windows(cloud: Cloud, starts: Indices) -> tuple[NDArray[Any], NDArray[Any]]:
        each = starts[:, None] + np.arange(len(taper))
        ground = np.concatenate([cloud.ground[each] * root, cloud.paths[starts][..., None]], axis=2)
        return ground, cloud.heights[each] * root  # (N, k, P + 1), (N, k, P)

    (ground_a, heights_a), (ground_b, heights_b) = windows(a, i), windows(b, j)
    angle = np.angle((ground_a * ground_b.conj()).sum((1, 2)))
    left = ground_a - np.exp(1j * angle)[:, None, None] * ground_b
    square = (np.abs(left) ** 2).sum((1, 2)) + ((heights_a - heights_b) ** 2).sum((1, 2))
    move = a.centres[i] - np.exp(1j * angle.astype(float)) * b.centres[j]
    return np.stack([np.sqrt(square), angle, *from_ground(move).T])


def runs(i: Indices, j: Indices) -> tuple[Indices, Indices]:
    """Sort pairs as `pair_distances` needs them: by diagonal, and by frame on each.

    Examples
    --------
    >>> [numbers.tolist() for numbers in runs(np.array([3, 0, 2]), np.array([9, 4, 8]))]
    [[0, 2, 3], [4, 8, 9]]
    """
    order = np.lexsort((i, j - i))
    return i[order], j[order]
