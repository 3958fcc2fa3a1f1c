"""Planar rigid transforms: turn about the vertical, then move over the ground.

A captured motion means the same wherever on the ground it happens and whichever way it faces, so
these three numbers are all that may be changed to lay one clip on another [KGP02, 3.1].
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap import rotations
from mocap.motion import Motion

Array = NDArray[np.float64]


class PlanarTransform(NamedTuple):
    """Turn by `angle` (radians) about +y, then move by `x` and `z` (metres).

    The fields are numbers, or arrays of one shape for many transforms at once.

    Examples
    --------
    >>> quarter = PlanarTransform(np.pi / 2, 1.0, 0.0)
    >>> quarter.points([0.0, 0.5, 1.0]).round(6) + 0.0
    array([2. , 0.5, 0. ])

    Notebook: 00-quickstart
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
    """
    matrices = rotations.to_matrix(quaternions)
    return np.arctan2(-matrices[..., 2, 0], matrices[..., 0, 0])
