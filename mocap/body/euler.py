"""Euler angles: conversion from and to quaternions, and angles that are continuous over frames.

Notebooks: 01-skeletons-and-clips, 03b-angles.
"""

import warnings

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array
from mocap.body.rotations import W, X, Y, Z

# The entries of a quaternion for an axis and for the two axes after it, in cyclic order.
AXES = {"x": (X, Y, Z), "y": (Y, Z, X), "z": (Z, X, Y)}


def from_euler(order: str, angles: ArrayLike) -> Array:
    """Convert Euler angles to quaternions.

    Parameters
    ----------
    order : the axes in SciPy's notation: "ZXY" is intrinsic, about the axes of the body, R = Rz Rx Ry, as in
        BVH; "xyz" is extrinsic, about fixed axes, R = Rz Ry Rx, as in Acclaim files.
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
    factors = list(zip(order.lower(), np.cos(halves), np.sin(halves), strict=True))
    q = np.zeros((4, *halves.shape[1:]))
    q[W] = 1.0
    for letter, cos, sin in factors if order.isupper() else reversed(factors):
        axis, second, third = AXES[letter]
        # Hamilton's product q (cos + sin e) with the unit vector e of the axis
        product = cos * q
        product[W] -= sin * q[axis]
        product[axis] += sin * q[W]
        product[second] += sin * q[third]
        product[third] -= sin * q[second]
        q = product
    return np.moveaxis(q, 0, -1)


def to_euler(order: str, quaternions: ArrayLike) -> Array:
    """Convert quaternions to Euler angles: the inverse of `from_euler` for three axes.

    Parameters
    ----------
    order : three axes in SciPy's notation, as for `from_euler`.
    quaternions : shape (..., 4).

    Returns
    -------
    Angles, shape (..., 3), radians. If two axes coincide (gimbal lock), the third angle is 0.

    Examples
    --------
    >>> to_euler("ZXY", from_euler("ZXY", [0.1, 0.2, 0.3])).round(6)
    array([0.1, 0.2, 0.3])

    Notebook: 03b-angles
    """
    quaternions = np.asarray(quaternions, float)
    rotations = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Gimbal lock")
        angles = rotations.as_euler(order)
    return np.asarray(angles.reshape(*quaternions.shape[:-1], 3))


def continuous(order: str, angles: ArrayLike) -> Array:
    """Make Euler angles continuous over frames, by choosing among equivalent triples.

    (a, b, c) and its twin (a + π, π - b, c + π) are the same rotation, and multiples of 2π may be added to
    each angle. Each frame gets the triple nearest to that of the previous frame. In gimbal lock, b = ±π/2,
    the rotation depends only on a + c or a - c. There c keeps its last value.

    Parameters
    ----------
    order : three different axes in SciPy's notation.
    angles : shape (F, ..., 3), radians, from `to_euler`.

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
    # The distance from a twin to some angles is that from the angles to the twin of the others. Therefore
    # each frame is compared with the unchanged previous frame, and each switch lasts until the next one.
    distances = _angular_distance(angles[1:], angles[:-1])
    twin_distances = _angular_distance(twins[1:], angles[:-1])
    takes_twin = np.zeros(angles.shape[:-1], bool)
    takes_twin[1:] = np.cumsum(twin_distances < distances, axis=0) % 2 == 1
    return np.unwrap(np.where(takes_twin[..., None], twins, angles), axis=0)


def _angular_distance(first: Array, second: Array) -> Array:
    """Sum the absolute differences of angles along the last axis, each wrapped to at most π."""
    differences = (first - second + np.pi) % (2 * np.pi) - np.pi
    return np.asarray(np.abs(differences).sum(-1))


def _without_lock(order: str, angles: Array) -> Array:
    """Replace angles in gimbal lock, whose third angle `to_euler` sets to 0, by an equivalent triple.

    The third angle keeps its value from the last frame without lock, and the first one compensates for it.
    At the start, the value of the first frame without lock is used.
    """
    first, second, third = np.moveaxis(angles, -1, 0)
    is_locked = (third == 0) & (np.abs(np.cos(second)) < 1e-6)
    frames = np.arange(len(angles)).reshape(-1, *[1] * (angles.ndim - 2))
    last_free = np.maximum.accumulate(np.where(is_locked, 0, frames), axis=0)
    first_free = is_locked.argmin(axis=0)
    held = np.take_along_axis(third, np.maximum(last_free, first_free), axis=0)
    compensated = first - _lock_sign(order) * np.sign(second) * held
    new_first = np.where(is_locked, compensated, first)
    new_third = np.where(is_locked, held, third)
    return np.stack([new_first, second, new_third], axis=-1)


def _lock_sign(order: str) -> int:
    """Return the sign s of gimbal lock, in which a rotation depends only on a + s c sign(b)."""
    is_cyclic = order.lower() in "xyzxy"
    about_body_axes = order.isupper()
    return 1 if is_cyclic == about_body_axes else -1
