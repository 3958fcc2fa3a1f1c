"""Unit quaternions as arrays `(..., 4)`, scalar first (w, x, y, z): a thin adapter over SciPy.

This module alone knows in which order a quaternion's numbers stand. All functions broadcast over
leading axes, none included, and every rotation turns column vectors: `rotate(multiply(a, b), v)` turns by b
first. Only `from_euler` and `to_matrix`, which meet every joint of every frame, compute on their own.
Notebooks: 01-skeletons-and-clips, 03-transforms (Euler angles), 04-blending (slerp).
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array

IDENTITY: Array = np.array([1.0, 0.0, 0.0, 0.0])
IDENTITY.flags.writeable = False


def _rotation(quaternions: ArrayLike) -> Rotation:
    return Rotation.from_quat(np.asarray(quaternions, float).reshape(-1, 4), scalar_first=True)


def _quaternions(rotation: Rotation, shape: tuple[int, ...]) -> Array:
    return np.asarray(rotation.as_quat(scalar_first=True), float).reshape(*shape, 4)


def from_matrix(matrices: ArrayLike) -> Array:
    """Convert rotation matrices, shape (..., 3, 3), to quaternions, shape (..., 4).

    Examples
    --------
    >>> from_matrix(np.eye(3))
    array([1., 0., 0., 0.])
    """
    matrices = np.asarray(matrices, float)
    return _quaternions(Rotation.from_matrix(matrices.reshape(-1, 3, 3)), matrices.shape[:-2])


def to_matrix(quaternions: ArrayLike) -> Array:
    """Convert quaternions, shape (..., 4), to rotation matrices, shape (..., 3, 3).

    Examples
    --------
    >>> to_matrix([1, 0, 0, 0])[0]
    array([1., 0., 0.])
    """
    quaternions = np.asarray(quaternions, float)
    squares = np.einsum("...i,...i", quaternions, quaternions)
    w, x, y, z = np.moveaxis(quaternions, -1, 0) * np.sqrt(2 / squares)
    rows = [
        [1 - y * y - z * z, x * y - w * z, x * z + w * y],
        [x * y + w * z, 1 - x * x - z * z, y * z - w * x],
        [x * z - w * y, y * z + w * x, 1 - x * x - y * y],
    ]
    matrices = np.empty((*quaternions.shape[:-1], 3, 3))
    for i, j in np.ndindex(3, 3):
        matrices[..., i, j] = rows[i][j]
    return matrices


def from_rotvec(vectors: ArrayLike) -> Array:
    """Convert rotation vectors (axis times angle in radians), shape (..., 3), to quaternions, shape (..., 4).

    Examples
    --------
    >>> from_rotvec([0, 0, np.pi]).round(6) + 0.0
    array([0., 0., 0., 1.])
    """
    vectors = np.asarray(vectors, float)
    if not vectors.size:
        return np.empty((*vectors.shape[:-1], 4))
    return _quaternions(Rotation.from_rotvec(vectors.reshape(-1, 3)), vectors.shape[:-1])


def to_rotvec(quaternions: ArrayLike) -> Array:
    """Convert quaternions to rotation vectors, shape (..., 3), of at most π radians.

    Examples
    --------
    >>> to_rotvec(about_y(-0.5)).round(6) + 0.0
    array([ 0. , -0.5,  0. ])
    """
    shape = np.shape(quaternions)[:-1]
    if not np.size(quaternions):
        return np.empty((*shape, 3))
    return np.asarray(_rotation(quaternions).as_rotvec(), float).reshape(*shape, 3)


def about_y(angles: ArrayLike) -> Array:
    """Build the turns by `angles` (radians, shape (...)) about the vertical, shape (..., 4).

    Examples
    --------
    >>> rotate(about_y(np.pi / 2), [0, 0, 1]).round(6) + 0.0
    array([1., 0., 0.])
    """
    half = np.asarray(angles, float) / 2
    return np.stack([np.cos(half), np.zeros_like(half), np.sin(half), np.zeros_like(half)], axis=-1)


def multiply(first: ArrayLike, second: ArrayLike) -> Array:
    """Compose rotations: the result turns by `second`, then by `first`; shapes (..., 4) broadcast.

    Examples
    --------
    >>> multiply(about_y(0.1), about_y(0.2)).round(6) == about_y(0.3).round(6)
    array([ True,  True,  True,  True])

    Notebook: 01-skeletons-and-clips
    """
    a, b = np.broadcast_arrays(np.asarray(first, float), np.asarray(second, float))
    if not a.size:
        return np.empty(a.shape)
    return _quaternions(_rotation(a) * _rotation(b), a.shape[:-1])


def inverse(quaternions: ArrayLike) -> Array:
    """Turn the other way: the conjugates of unit quaternions, shape (..., 4).

    Examples
    --------
    >>> inverse([1.0, 0.0, 0.0, 0.0]) + 0.0
    array([1., 0., 0., 0.])
    """
    return np.asarray(quaternions, float) * [1.0, -1.0, -1.0, -1.0]


def rotate(quaternions: ArrayLike, vectors: ArrayLike) -> Array:
    """Turn vectors, shape (..., 3), by quaternions, shape (..., 4); leading axes broadcast.

    Examples
    --------
    >>> rotate([1, 0, 0, 0], [1, 2, 3])
    array([1., 2., 3.])

    Notebook: 01-skeletons-and-clips
    """
    return np.asarray((to_matrix(quaternions) @ np.asarray(vectors, float)[..., None])[..., 0])


def between(start: ArrayLike, end: ArrayLike) -> Array:
    """Build the shortest turn that brings one direction onto another: q ~ (|a| |b| + a·b, a × b).

    Parameters
    ----------
    start, end : shape (..., 3), of any length but 0; where they are opposite, no turn is the shortest
        and the result is not a rotation.

    Examples
    --------
    >>> between([0, 0, 1], [2, 0, 0]).round(6) == about_y(np.pi / 2).round(6)
    array([ True,  True,  True,  True])
    """
    a, b = (np.asarray(v, float) / np.linalg.norm(v, axis=-1, keepdims=True) for v in (start, end))
    turn = np.concatenate([1 + (a * b).sum(-1, keepdims=True), np.cross(a, b)], axis=-1)
    return np.asarray(turn / np.linalg.norm(turn, axis=-1, keepdims=True))


def slerp(start: ArrayLike, end: ArrayLike, amount: ArrayLike) -> Array:
    """Interpolate the short way round: start · exp(amount · log(start⁻¹ · end)).

    Parameters
    ----------
    start, end : shape (..., 4).
    amount : shape (...), 0 at `start`, 1 at `end`.

    Returns
    -------
    Quaternions, shape (..., 4).

    Examples
    --------
    >>> slerp(about_y(0.2), about_y(0.4), 0.5).round(6) == about_y(0.3).round(6)
    array([ True,  True,  True,  True])

    Notebook: 04-blending
    """
    difference = to_rotvec(multiply(inverse(start), end))
    return multiply(start, from_rotvec(np.asarray(amount, float)[..., None] * difference))


def angle_between(first: ArrayLike, second: ArrayLike) -> Array:
    """Measure the angle, in [0, π] radians and shape (...), of the turn from one rotation to another.

    θ = 4 atan2(|a - b|, |a + b|) for a and ±b, whichever is nearer: exact for small angles, too.

    Examples
    --------
    >>> float(angle_between(about_y(0.1), about_y(-0.3)).round(6))
    0.4

    Notebook: 04-blending
    """
    a, b = (np.asarray(q, float) for q in (first, second))
    a, b = (q / np.sqrt(np.einsum("...i,...i", q, q))[..., None] for q in (a, b))
    gap, sum_ = (np.sqrt(np.einsum("...i,...i", q, q)) for q in (a - b, a + b))
    return np.asarray(4 * np.arctan2(np.minimum(gap, sum_), np.maximum(gap, sum_)))
