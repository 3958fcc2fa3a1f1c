"""Chosen pairs of windows, measured one by one: the distance of each, and the transform that aligns it."""

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body.planar import from_ground
from mocap.matching.distance_grids import Cloud, Floats

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
