"""Planar rigid transforms: turn about the vertical, then move over the ground.

A captured motion means the same wherever on the ground it happens and whichever way it faces, so
these three numbers are all that may be changed to lay one clip on another [KGP02, 3.1].
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Points
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError


def on_ground(points: ArrayLike) -> Points:
    """Turn points (..., 3) into complex numbers z + ix.

    Examples
    --------
    >>> complex(on_ground([3.0, 1.0, 2.0]))
    (2+3j)
    """
    points = np.asarray(points, float)
    return np.asarray(points[..., 2] + 1j * points[..., 0])


class PlanarTransform(NamedTuple):
    """Turn by `angle` (radians) about +y, then move by `x` and `z` (metres).

    The fields are numbers, or arrays of one shape for many transforms at once.

    Examples
    --------
    >>> quarter = PlanarTransform(np.pi / 2, 1.0, 0.0)
    >>> quarter.points([0.0, 0.5, 1.0]).round(6) + 0.0
    array([2. , 0.5, 0. ])

    Notebook: 03-transforms
    """

    angle: float | Array
    x: float | Array
    z: float | Array

    def points(self, points: ArrayLike) -> Array:
        """Move points, shape (..., 3): x' = x cos θ + z sin θ + x₀, z' = z cos θ - x sin θ + z₀."""
        x, y, z = np.moveaxis(np.asarray(points, float), -1, 0)
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return np.stack(np.broadcast_arrays(x * cos + z * sin + self.x, y, z * cos - x * sin + self.z), -1)

    def orientations(self, quaternions: ArrayLike) -> Array:
        """Turn global orientations, quaternions of shape (..., 4)."""
        return rotations.multiply(rotations.about_y(self.angle), quaternions)

    def motion(self, motion: Motion) -> Motion:
        """Move a whole motion; only its root changes."""
        turned = motion.rotations.copy()
        turned[:, 0] = self.orientations(turned[:, 0])
        return replace(motion, root_positions=self.points(motion.root_positions), rotations=turned)

    def after(self, first: PlanarTransform) -> PlanarTransform:
        """Compose: do `first`, then this one; angles add up, wrapped to [-π, π)."""
        moved = self.points(np.stack(np.broadcast_arrays(first.x, 0.0, first.z), -1))
        total = np.add(self.angle, first.angle)
        return PlanarTransform((total + np.pi) % (2 * np.pi) - np.pi, moved[..., 0], moved[..., 2])

    def inverse(self) -> PlanarTransform:
        """Undo it."""
        back = PlanarTransform(np.negative(self.angle), 0.0, 0.0)
        moved = back.points(np.stack(np.broadcast_arrays(self.x, 0.0, self.z), -1))
        return PlanarTransform(back.angle, -moved[..., 0], -moved[..., 2])


IDENTITY = PlanarTransform(0.0, 0.0, 0.0)


def heading(quaternions: ArrayLike) -> Array:
    """Read the direction a body faces off its root: θ = atan2(-R₂₀, R₀₀), the homework's formula.

    It looks where the body's left points, and is lost where that is straight up or down; `facing` is not.

    Parameters
    ----------
    quaternions : root orientations, shape (..., 4).

    Returns
    -------
    Angles about +y, shape (...), radians in [-π, π]: 0 faces +z, π/2 faces +x.

    Examples
    --------
    >>> float(heading(rotations.about_y(0.7)).round(6))
    0.7

    Notebook: 03-transforms
    """
    matrices = rotations.to_matrix(quaternions)
    return np.arctan2(-matrices[..., 2, 0], matrices[..., 0, 0])


def facing(quaternions: ArrayLike) -> Array:
    """Read the direction a body faces as its twist about the vertical: θ = 2 atan2(q_y, q_w).

    Every rotation is a turn about +y after a swing about a level axis; θ is that turn. Where a body only
    turns and leans it agrees with `heading`, but it stays defined when the body lies down or looks
    straight up, and turning the body by α adds α exactly. Undefined is it only for a swing by half a turn
    (upside down, q_w = q_y = 0): there it is 0.

    Parameters
    ----------
    quaternions : root orientations, shape (..., 4).

    Returns
    -------
    Angles about +y, shape (...), radians in [-π, π]: 0 faces +z, π/2 faces +x.

    Examples
    --------
    >>> on_the_back = rotations.multiply(rotations.about_y(0.7), rotations.from_rotvec([-np.pi / 2, 0, 0]))
    >>> float(facing(on_the_back).round(6))
    0.7

    Notebook: 03-transforms
    """
    w, _, y, _ = np.moveaxis(np.asarray(quaternions, float), -1, 0)
    # The cosine and the sine of θ, each times w² + y²: the same for q and -q.
    return np.asarray(np.arctan2(2 * w * y, w * w - y * y))


def place(motion: Motion, heading: float, position: ArrayLike) -> Motion:
    """Move a whole motion so that its first frame faces `heading` and stands over `position`.

    Parameters
    ----------
    motion : any; heights stay.
    heading : radians about +y, as `facing` reads it.
    position : (x, z), metres.

    Raises
    ------
    MocapError : for a heading or a position that is no finite number, or not two of them.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Motion(Skeleton(["root"], [-1], [[0, 0, 0]]), [[5, 1, 5]], [[[1, 0, 0, 0]]], 30.0)
    >>> place(dot, 0.0, [2, 3]).root_positions
    array([[2., 1., 3.]])

    Notebook: 03-transforms
    """
    target = np.asarray(position, float)
    if target.shape != (2,) or not np.isfinite([heading, *target]).all():
        raise MocapError(
            f"A place is a finite heading and position (x, z), got {heading} and {target.tolist()}."
        )
    turn = PlanarTransform(heading - float(facing(motion.rotations[0, 0])), 0.0, 0.0)
    x, _, z = turn.points(motion.root_positions[0])
    return turn._replace(x=target[0] - x, z=target[1] - z).motion(motion)
