"""Euler angles: three turns about three axes, and their traps.

Notebooks: 01-skeletons-and-clips, 03b-angles.
"""

import warnings

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array


def from_euler(order: str, angles: ArrayLike) -> Array:
    """Build quaternions from Euler angles.

    Parameters
    ----------
    order : the axes in SciPy's notation: "ZXY" turns about the body's own axes, R = Rz Rx Ry, as BVH
        does; "xyz" about the fixed ones, R = Rz Ry Rx, as Acclaim files do.
    angles : shape (..., len(order)), radians.

    Returns
    -------
    Quaternions, shape (..., 4).

    Examples
    --------
    >>> from_euler("y", [np.pi]).round(6) + 0.0
    array([0., 0., 1., 0.])

    Notebook: 03b-angles
    """
    halves = np.moveaxis(np.asarray(angles, float), -1, 0) / 2
    turns = list(zip(order.lower(), np.cos(halves), np.sin(halves), strict=True))
    q = np.zeros((4, *halves.shape[1:]))
    q[0] = 1.0
    for axis, cos, sin in turns if order.isupper() else reversed(turns):
        i = "xyz".index(axis)
        same, left, right = 1 + i, 1 + (i + 1) % 3, 1 + (i + 2) % 3
        # q (cos + sin e): the product with the axis e swaps the numbers of q in two pairs
        q[[0, same]] = cos * q[[0, same]] + sin * np.stack([-q[same], q[0]])
        q[[left, right]] = cos * q[[left, right]] + sin * np.stack([q[right], -q[left]])
    return np.moveaxis(q, 0, -1)


def to_euler(order: str, quaternions: ArrayLike) -> Array:
    """Read Euler angles off quaternions: the inverse of `from_euler` for three axes.

    Parameters
    ----------
    order : three axes in SciPy's notation, as for `from_euler`.
    quaternions : shape (..., 4).

    Returns
    -------
    Angles, shape (..., 3), radians; where two axes fall together (gimbal lock) the third is 0.

    Examples
    --------
    >>> to_euler("ZXY", from_euler("ZXY", [0.1, 0.2, 0.3])).round(6)
    array([0.1, 0.2, 0.3])

    Notebook: 03b-angles
    """
    quaternions = np.asarray(quaternions, float)
    turns = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Gimbal lock")
        angles = turns.as_euler(order)
    return np.asarray(angles.reshape(*quaternions.shape[:-1], 3))


def continuous(order: str, angles: ArrayLike) -> Array:
    """Choose, among the angles of the same rotations, those nearest to the frame before.

    (a, b, c) is the same rotation as (a + π, π - b, c + π), and a whole turn more or less changes nothing. In
    gimbal lock, where b = ±π/2, only a + c or a - c matters: there c stays as it was before.

    Parameters
    ----------
    order : three different axes in SciPy's notation.
    angles : shape (F, ..., 3), radians, as `to_euler` reads them off.

    Returns
    -------
    Angles of the same rotations, shape (F, ..., 3).

    Examples
    --------
    >>> continuous("ZXY", [[0, 1.5, 0], [np.pi, 1.5, np.pi], [np.pi, 1.4, np.pi]]).round(3) + 0.0
    array([[0.   , 1.5  , 0.   ],
           [0.   , 1.642, 0.   ],
           [0.   , 1.742, 0.   ]])

    Notebook: 03b-angles
    """
    angles = _without_lock(order, np.asarray(angles, float))
    twins = angles * [1, -1, 1] + np.pi
    turn = 2 * np.pi
    steps, twin_steps = (np.abs((a[1:] - angles[:-1] + np.pi) % turn - np.pi) for a in (angles, twins))
    # Is the twin nearer to the frame before? It is the same question for either twin of that frame.
    flips = steps.sum(-1) > twin_steps.sum(-1)
    flipped = np.zeros(angles.shape[:-1], bool)
    flipped[1:] = np.cumsum(flips, axis=0) % 2 == 1
    return np.unwrap(np.where(flipped[..., None], twins, angles), axis=0)


def _without_lock(order: str, angles: Array) -> Array:
    """Keep the last value of the third angle where two axes fall together and `to_euler` made it 0."""
    first, second, third = np.moveaxis(angles, -1, 0)
    locked = (third == 0) & (np.abs(np.cos(second)) < 1e-6)
    last = np.where(locked, 0, np.arange(len(angles)).reshape(-1, *[1] * (angles.ndim - 2)))
    # A lock at the start has no frame before it: take the first frame that is not locked.
    free = np.maximum(np.maximum.accumulate(last, axis=0), locked.argmin(axis=0))
    held = np.where(locked, np.take_along_axis(third, free, axis=0), third)
    sign = (1 if order.lower() in "xyzxy" else -1) * (1 if order.isupper() else -1) * np.sign(second)
    return np.stack([np.where(locked, first - sign * held, first), second, held], axis=-1)
