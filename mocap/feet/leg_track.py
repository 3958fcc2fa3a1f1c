"""One leg over a clip: where its joints are, and how far its knee lets it reach.

All five steps of a clean-up ask for the same few things about a leg. A `LegTrack` measures each of them once.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import GlobalPoses
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.errors import MocapError

UP = np.array([0.0, 1.0, 0.0])
ROUNDING = 1e-9  # metres: what rounding may add to a distance

# Radians: 8°. A leg that becomes a millimetre shorter moves its knee by 6 mm there, by 10 mm at 4°, and by
# 14 mm at 2°: knee popping. With 0° the knees of captured walks accelerate by 4 % more (99.9 % of the
# frames); with 16° the root moves by 3.0 mm instead of 2.5.
BENT = np.radians(8.0)

BACK = 1e-4  # radians: a knee that bends backwards by less is straight, but for rounding

# Square metres: where the cross product of thigh and shank is smaller in every frame, its direction is
# rounding.
STIFF = 1e-6


class KneeHinge(NamedTuple):
    """How far apart a knee's hinge can bring hip and ankle, in F frames.

    With thigh u and shank s, turning the shank by δ about the hinge h gives
    ‖u + R(h, δ) s‖² = size + 2 radius cos(δ - δ₀): `axis` h (F, 3), `size`, `radius` (F,) in m², and
    `straight` δ₀ (F,), the turn that would stretch the leg most, radians.
    """

    axis: Array
    size: Array
    radius: Array
    straight: Array

    @property
    def reach(self) -> Array:
        """The longest distance from hip to ankle, (F,), metres."""
        return np.asarray(np.sqrt(self.size + 2 * self.radius))

    def limit(self, distance: Array) -> Array:
        """How far apart hip and ankle may come, where they are a distance (F,) apart in the clip, metres.

        No knee becomes straighter than `BENT`, except where it is straighter already.
        """
        bent = np.sqrt(self.size + 2 * self.radius * np.cos(BENT))
        return np.asarray(np.maximum(bent, np.minimum(distance, self.reach)))

    def turn(self, distance: Array) -> Array:
        """How far to turn until hip and ankle are a distance (F,) apart, radians; the knee keeps its side."""
        cosine = np.clip((distance**2 - self.size) / (2 * self.radius), -1.0, 1.0)
        side = np.where(self.straight > BACK, -1.0, 1.0)  # a straight knee bends forwards
        return np.asarray(self.straight + side * np.arccos(cosine))


@dataclass(frozen=True, eq=False)
class LegTrack:
    """A leg in the F frames of a motion.

    Parameters
    ----------
    motion : F frames; its contacts are not read.
    leg : which joints.
    poses : the motion's global poses, or the same with the root raised.

    Examples
    --------
    >>> from mocap.body.kinematics import forward_kinematics
    >>> from mocap.body.limbs import find_legs
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> left = LegTrack(walk, find_legs(walk.skeleton)[0], forward_kinematics(walk))
    >>> bool((left.distance < left.hinge.reach).all())
    True
    """

    motion: Motion
    leg: Leg
    poses: GlobalPoses

    @property
    def names(self) -> list[str]:
        """The names of hip, knee, ankle and ball."""
        return [self.motion.skeleton.names[joint] for joint in self.leg]

    @property
    def hip(self) -> Array:
        """Where the hip is, (F, 3), metres."""
        return self.poses.positions[:, self.leg.hip]

    @property
    def knee(self) -> Array:
        """Where the knee is, (F, 3), metres."""
        return self.poses.positions[:, self.leg.knee]

    @property
    def ankle(self) -> Array:
        """Where the ankle is, (F, 3), metres."""
        return self.poses.positions[:, self.leg.ankle]

    @property
    def ball(self) -> Array:
        """Where the ball is, (F, 3), metres."""
        return self.poses.positions[:, self.leg.ball]

    @cached_property
    def bones(self) -> tuple[Array, Array]:
        """From hip to knee, and from knee to ankle, (F, 3) each, metres."""
        return self.knee - self.hip, self.ankle - self.knee

    @cached_property
    def distance(self) -> Array:
        """From hip to ankle, (F,), metres."""
        return np.asarray(np.linalg.norm(self.ankle - self.hip, axis=-1))

    @cached_property
    def limit(self) -> Array:
        """How far apart hip and ankle may come, (F,), metres: see `KneeHinge.limit`."""
        return self.hinge.limit(self.distance)

    @cached_property
    def bends(self) -> bool:
        """Whether the knee is bent in any frame, and so shows which way it bends."""
        return bool(np.linalg.norm(np.cross(*self.bones), axis=-1).max() > STIFF)

    @cached_property
    def hinge(self) -> KneeHinge:
        """The axis in the thigh about which the knee bends over the clip, and what turning about it does.

        Raises
        ------
        MocapError : for a knee that is straight in every frame: it does not show which way it bends.
        """
        thigh, shank = self.bones
        if not self.bends:
            raise MocapError(f"'{self.names[1]}' is straight in every frame: which way does it bend?")
        frame = self.poses.matrices[:, self.leg.hip]
        bends = np.einsum("fji,fj->fi", frame, np.cross(thigh, shank))  # seen from the thigh, (F, 3)
        axis = bends.sum(axis=0)
        axis = frame @ (axis / np.linalg.norm(axis))
        along = (thigh * axis).sum(-1) * (shank * axis).sum(-1)
        cos = (thigh * shank).sum(-1) - along
        sin = (thigh * np.cross(axis, shank)).sum(-1)
        size = (thigh**2).sum(-1) + (shank**2).sum(-1) + 2 * along
        return KneeHinge(axis, size, np.hypot(cos, sin), np.arctan2(sin, cos))

    def highest(self, ankle: Array, length: Array) -> Array:
        """How far the root may rise at most, (F,), metres, for a leg of `length` (F,) to reach to `ankle`."""
        apart = self.hip - ankle
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        return np.asarray(np.sqrt(np.maximum(length**2 - level, 0.0)) - apart[:, 1])
