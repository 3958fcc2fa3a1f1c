"""Bring a leg's ankle to another place, and change the leg as little as that allows.

`two_bone_ik` poses a limb from nothing; here a pose is there already. The knee, a hinge, turns until
hip and ankle are as far apart as they must be, and then the whole leg swings at the hip.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.errors import MocapError

BENT = np.radians(8.0)  # a knee straighter than this pops: a millimetre of leg is a centimetre of knee


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

        No knee becomes straighter than `BENT`, but where it is so already.
        """
        bent = np.sqrt(self.size + 2 * self.radius * np.cos(BENT))
        return np.asarray(np.maximum(bent, np.minimum(distance, self.reach)))

    def turn(self, distance: Array) -> Array:
        """Turn until hip and ankle are a distance (F,) apart: radians. The knee bends to its own side."""
        cosine = np.clip((distance**2 - self.size) / (2 * self.radius), -1.0, 1.0)
        side = np.where(self.straight > 1e-4, -1.0, 1.0)  # a straight knee bends forwards
        return np.asarray(self.straight + side * np.arccos(cosine))


def knee_hinge(leg: Leg, poses: GlobalPoses, name: str) -> KneeHinge:
    """Find the axis in the thigh about which a knee bends over a clip, and what turning about it does.

    Parameters
    ----------
    leg : the joints.
    poses : F frames.
    name : of the knee, for the error.

    Raises
    ------
    MocapError : for a knee that is straight in every frame, so that nobody can tell which way it bends.
    """
    hip, knee, ankle = (poses.positions[:, joint] for joint in leg[:3])
    thigh, shank = knee - hip, ankle - knee
    frame = poses.matrices[:, leg.hip]
    bends = np.einsum("fji,fj->fi", frame, np.cross(thigh, shank))  # seen from the thigh, (F, 3)
    axis = bends.sum(axis=0)
    if not np.linalg.norm(bends, axis=-1).max() > 1e-6:
        raise MocapError(f"'{name}' is straight in every frame: which way does it bend?")
    axis = frame @ (axis / np.linalg.norm(axis))
    along = (thigh * axis).sum(-1) * (shank * axis).sum(-1)
    cos = (thigh * shank).sum(-1) - along
    sin = (thigh * np.cross(axis, shank)).sum(-1)
    size = (thigh**2).sum(-1) + (shank**2).sum(-1) + 2 * along
    return KneeHinge(axis, size, np.hypot(cos, sin), np.arctan2(sin, cos))


def bend_and_swing(hinge: KneeHinge, bones: tuple[Array, Array], wanted: Array) -> tuple[Array, Array]:
    """Turn a shank about its knee, then the whole leg about its hip, so that its ankle comes where wanted.

    Parameters
    ----------
    hinge : the knee's.
    bones : from hip to knee and from knee to ankle, (F, 3) each, metres.
    wanted : from hip to where the ankle shall be, (F, 3), metres; what is out of reach is aimed at.

    Returns
    -------
    The two rotations in the world's frame, (F, 4) each.
    """
    distance = np.minimum(np.linalg.norm(wanted, axis=-1), hinge.reach)
    bend = rotations.from_rotvec(hinge.turn(distance)[:, None] * hinge.axis)
    return bend, rotations.between(bones[0] + rotations.rotate(bend, bones[1]), wanted)


def pose_leg(motion: Motion, leg: Leg, poses: GlobalPoses, ankle: Array, turn: ArrayLike) -> Array:
    """Pose a leg so that its ankle is where it shall be, and its foot turned.

    Parameters
    ----------
    motion : F frames.
    leg : the joints.
    poses : the motion's global poses, its root where it shall be.
    ankle : shape (F, 3), metres: where the ankle shall be.
    turn : shape (F, 3), rotation vectors in the world's frame: how the foot is turned beyond what it was.

    Returns
    -------
    The rotations of hip, knee and ankle relative to their parents, shape (F, 3, 4).

    Raises
    ------
    MocapError : for an ankle that is out of the leg's reach.
    """
    hip, knee, foot = (poses.positions[:, joint] for joint in leg[:3])
    hinge = knee_hinge(leg, poses, motion.skeleton.names[leg.knee])
    wanted = ankle - hip
    distance = np.linalg.norm(wanted, axis=-1)
    if np.any(far := distance > hinge.reach + 1e-9):
        frame = int(far.argmax())
        raise MocapError(
            f"'{motion.name}', frame {frame}: '{motion.skeleton.names[leg.ankle]}' would have to be "
            f"{100 * (distance - hinge.reach)[frame]:.2g} cm out of its leg's reach; are its contacts true?"
        )
    bend, swing = bend_and_swing(hinge, (knee - hip, foot - knee), wanted)
    sole = rotations.from_rotvec(turn)
    frames = [
        rotations.from_matrix(poses.matrices[:, j]) for j in (motion.skeleton.parents[leg.hip], *leg[:2])
    ]
    # Each joint turns by what the world sees it turn beyond its parent, told in the parent's frame.
    carried = rotations.multiply(swing, bend)
    extra = (swing, bend, rotations.multiply(rotations.inverse(carried), sole))
    local = (
        rotations.multiply(rotations.multiply(rotations.inverse(frame), more), frame)
        for frame, more in zip(frames, extra, strict=True)
    )
    return np.stack(
        [rotations.multiply(more, motion.rotations[:, j]) for more, j in zip(local, leg[:3], strict=True)],
        axis=1,
    )
