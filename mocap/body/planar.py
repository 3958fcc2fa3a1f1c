"""Planar rigid transforms: a rotation about the vertical axis, then a translation over the ground.

A motion is invariant to them: it remains the same motion at any position on the ground and with any heading.
Therefore clips are aligned by these three numbers alone [KGP02, 3.1].

A point (x, z) on the ground is also the complex number z + ix. A rotation about +y by θ is then a
multiplication by exp(iθ), and a planar transform is p ↦ rotation · p + translation.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Points
from mocap._shared.deprecation import deprecated
from mocap._shared.quantities import check_radians
from mocap.body import rotations
from mocap.body.motion import Motion, require_motion
from mocap.errors import MocapError

Numbers = float | NDArray[np.floating[Any]]


def on_ground(points: ArrayLike) -> Points:
    """Project points (..., 3), or ground points (x, z) of shape (..., 2), to complex numbers z + ix.

    Examples
    --------
    >>> complex(on_ground([3.0, 1.0, 2.0])), complex(on_ground([3.0, 2.0]))
    ((2+3j), (2+3j))

    Notebook: 15-registration
    """
    points = np.asarray(points, float)
    return np.asarray(points[..., -1] + 1j * points[..., 0])


def from_ground(points: Points) -> Array:
    """Convert complex numbers z + ix to ground points (x, z), shape (..., 2): the inverse of `on_ground`.

    Examples
    --------
    >>> from_ground(2 + 3j)
    array([3., 2.])
    """
    return np.stack([np.imag(points), np.real(points)], axis=-1)


class PlanarTransform(NamedTuple):
    """Rotation by `angle` (radians) about +y, then translation by `x` and `z` (metres).

    The fields are numbers, or arrays of one shape for many transforms. `a @ b` applies b first, then a.

    Examples
    --------
    >>> quarter = PlanarTransform(np.pi / 2, 1.0, 0.0)
    >>> quarter.apply_points([0.0, 0.5, 1.0]).round(6) + 0.0
    array([2. , 0.5, 0. ])
    >>> complex(np.round(quarter.rotation * on_ground([0.0, 0.5, 1.0]) + quarter.translation, 6))
    2j

    Notebook: 03-transforms
    """

    angle: Numbers
    x: Numbers
    z: Numbers

    @classmethod
    def from_complex(cls, rotation: complex | Points, translation: complex | Points) -> PlanarTransform:
        """Build the transform p ↦ rotation · p + translation of ground points z + ix; |rotation| is 1."""
        return cls(np.angle(rotation), translation.imag, translation.real)

    @property
    def rotation(self) -> Points:
        """The rotation as a complex number, exp(i · angle)."""
        return np.exp(1j * np.asarray(self.angle))

    @property
    def translation(self) -> Points:
        """The translation as a complex number, z + ix."""
        return np.asarray(self.z) + 1j * np.asarray(self.x)

    @property
    @deprecated("PlanarTransform.turn", since="0.2", removed_in="0.3", instead="PlanarTransform.rotation")
    def turn(self) -> Points:
        """The former name of `rotation`."""
        return self.rotation

    @property
    @deprecated("PlanarTransform.move", since="0.2", removed_in="0.3", instead="PlanarTransform.translation")
    def move(self) -> Points:
        """The former name of `translation`."""
        return self.translation

    def apply_points(self, points: ArrayLike) -> Array:
        """Transform points, shape (..., 3): x' = x cos θ + z sin θ + x₀, z' = z cos θ - x sin θ + z₀."""
        x, y, z = np.moveaxis(np.asarray(points, float), -1, 0)
        cos = np.cos(self.angle)
        sin = np.sin(self.angle)
        new_x = x * cos + z * sin + self.x
        new_z = z * cos - x * sin + self.z
        return np.stack(np.broadcast_arrays(new_x, y, new_z), -1)

    def apply_frames(self, roots: ArrayLike, quaternions: Array) -> tuple[Array, Array]:
        """Transform poses, given by root positions (..., 3) and rotations (..., J, 4); only roots change."""
        transformed = quaternions.copy()
        transformed[..., 0, :] = rotations.multiply(rotations.about_y(self.angle), transformed[..., 0, :])
        return self.apply_points(roots), transformed

    def apply_motion(self, motion: Motion) -> Motion:
        """Transform a whole motion. Only its root changes."""
        root_positions, transformed = self.apply_frames(motion.root_positions, motion.rotations)
        return replace(motion, root_positions=root_positions, rotations=transformed)

    def __matmul__(self, first: PlanarTransform) -> PlanarTransform:
        """Compose: apply `first`, then this one. Angles add up, wrapped to [-π, π)."""
        translation = self.apply_points(np.stack(np.broadcast_arrays(first.x, 0.0, first.z), -1))
        angle = (np.add(self.angle, first.angle) + np.pi) % (2 * np.pi) - np.pi
        return PlanarTransform(angle, translation[..., 0], translation[..., 2])

    def inverse(self) -> PlanarTransform:
        """Return the inverse transform."""
        rotation = PlanarTransform(np.negative(self.angle), 0.0, 0.0)
        translation = rotation.apply_points(np.stack(np.broadcast_arrays(self.x, 0.0, self.z), -1))
        return PlanarTransform(rotation.angle, -translation[..., 0], -translation[..., 2])


IDENTITY = PlanarTransform(0.0, 0.0, 0.0)


def heading(quaternions: ArrayLike) -> Array:
    """Compute the heading of a body, its twist about the vertical axis: θ = 2 atan2(q_y, q_w).

    Every rotation is a swing about a horizontal axis, followed by a twist about +y by θ (swing-twist
    decomposition). The heading is also defined if the body lies down or looks straight up, and a rotation of
    the body about +y by α adds exactly α. The only exception is a swing by 180° (upside down,
    q_w = q_y = 0), where it is 0. The homework computes its heading from the rotation matrix. Notebook 03b
    shows when that fails.

    Parameters
    ----------
    quaternions : root orientations, shape (..., 4).

    Returns
    -------
    Angles about +y, shape (...), radians in [-π, π]: 0 faces +z, π/2 faces +x.

    Examples
    --------
    >>> on_the_back = rotations.multiply(rotations.about_y(0.7), rotations.from_rotvec([-np.pi / 2, 0, 0]))
    >>> float(heading(on_the_back).round(6))
    0.7

    Notebook: 03b-angles
    """
    w, _, y, _ = np.moveaxis(np.asarray(quaternions, float), -1, 0)
    # The sine and the cosine of θ, both times w² + y², which are the same for q and -q.
    return np.asarray(np.arctan2(2 * w * y, w * w - y * y))


def align_frames(motion: Motion, target: Motion, frame: int = 0) -> PlanarTransform:
    """Return the planar transform that aligns a motion's first frame with a frame of another.

    It rotates by the difference of the two headings, then translates the root over the ground to the other.

    Parameters
    ----------
    motion : the motion to align.
    target, frame : the motion and the frame to align it with.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> here = Motion(dot, [[5, 1, 5]], [[[1, 0, 0, 0]]], 30.0)
    >>> there = Motion(dot, [[2, 2, 3]], [rotations.about_y([0.5])], 30.0)
    >>> align_frames(here, there).apply_motion(here).root_positions.round(6)
    array([[2., 1., 3.]])

    Notebook: 03b-angles
    """
    angle = float(heading(target.rotations[frame, 0]) - heading(motion.rotations[0, 0]))
    rotated = PlanarTransform(angle, 0.0, 0.0).apply_points(motion.root_positions[0])
    x, _, z = target.root_positions[frame] - rotated
    return PlanarTransform(angle, float(x), float(z))


def place(motion: Motion, direction: float, position: ArrayLike) -> Motion:
    """Transform a motion such that its first frame has the heading `direction` and is over `position`.

    Parameters
    ----------
    motion : any motion. Its heights do not change.
    direction : the heading, radians about +y.
    position : (x, z), metres.

    Raises
    ------
    MocapError : for numbers that are not finite, and positions that are not two numbers.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Motion(Skeleton(["root"], [-1], [[0, 0, 0]]), [[5, 1, 5]], [[[1, 0, 0, 0]]], 30.0)
    >>> place(dot, 0.0, [2, 3]).root_positions
    array([[2., 1., 3.]])

    Notebook: 03-transforms
    """
    require_motion(motion)
    check_radians(direction, "direction")
    target = np.asarray(position, float)
    if target.shape != (2,) or not np.isfinite([direction, *target]).all():
        got = f"{direction} and {target.tolist()}"
        raise MocapError(f"A place is a finite direction and position (x, z), got {got}.")
    rotation = PlanarTransform(direction - float(heading(motion.rotations[0, 0])), 0.0, 0.0)
    x, _, z = rotation.apply_points(motion.root_positions[0])
    return rotation._replace(x=target[0] - x, z=target[1] - z).apply_motion(motion)
