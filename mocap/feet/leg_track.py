"""One leg over a clip: how far its knee lets it reach, and its ankle in another place: step 4 of [KSG02].

All five steps of a clean-up ask for the same few things about a leg. A `LegTrack` measures each of them once.
`two_bone_ik` poses a limb from nothing; here there is a pose to begin with, and the leg changes as little as
its new ankle allows. The knee, a hinge, turns until hip and ankle are as far apart as they must be. Then the
whole leg swings at the hip.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
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


class LegTrack(NamedTuple):
    """A leg in the F frames of a motion, and what turning its knee does.

    With thigh u and shank s, turning the shank by δ about the hinge h gives
    ‖u + R(h, δ) s‖² = size + 2 radius cos(δ - δ₀).

    Parameters
    ----------
    motion, leg : whose leg it is; the motion's contacts are not read.
    matrices : how each joint is turned in the world, shape (F, J, 3, 3).
    hip, knee, ankle, ball : where they are, shape (F, 3), metres.
    axis : h, the knee's hinge, unit vectors of shape (F, 3).
    size, radius : shape (F,), m².
    straight : δ₀, shape (F,), the turn that would stretch the leg most, radians.
    """

    motion: Motion
    leg: Leg
    matrices: Array
    hip: Array
    knee: Array
    ankle: Array
    ball: Array
    axis: Array
    size: Array
    radius: Array
    straight: Array

    @property
    def names(self) -> list[str]:
        """The names of hip, knee, ankle and ball."""
        return [self.motion.skeleton.names[joint] for joint in self.leg]

    @property
    def distance(self) -> Array:
        """From hip to ankle, (F,), metres."""
        return np.asarray(np.linalg.norm(self.ankle - self.hip, axis=-1))

    @property
    def reach(self) -> Array:
        """The longest distance from hip to ankle, (F,), metres."""
        return np.asarray(np.sqrt(self.size + 2 * self.radius))

    @property
    def limit(self) -> Array:
        """How far apart hip and ankle may come, (F,), metres.

        No knee becomes straighter than `BENT`, except where it is straighter already.
        """
        bent = np.sqrt(self.size + 2 * self.radius * np.cos(BENT))
        return np.asarray(np.maximum(bent, np.minimum(self.distance, self.reach)))

    def turn(self, distance: Array) -> Array:
        """How far to turn until hip and ankle are a distance (F,) apart, radians; the knee keeps its side."""
        cosine = np.clip((distance**2 - self.size) / (2 * self.radius), -1.0, 1.0)
        side = np.where(self.straight > BACK, -1.0, 1.0)  # a straight knee bends forwards
        return np.asarray(self.straight + side * np.arccos(cosine))

    def highest(self, ankle: Array, length: Array) -> Array:
        """How far the root may rise at most, (F,), metres, for a leg of `length` (F,) to reach to `ankle`."""
        apart = self.hip - ankle
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        return np.asarray(np.sqrt(np.maximum(length**2 - level, 0.0)) - apart[:, 1])


def track_leg(motion: Motion, leg: Leg, poses: GlobalPoses) -> LegTrack:
    """Measure a leg in all frames of a motion whose global poses are known.

    Raises
    ------
    MocapError : for a knee that is straight in every frame: it does not show which way it bends.

    Examples
    --------
    >>> from mocap.body.kinematics import forward_kinematics
    >>> from mocap.body.limbs import find_legs
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> left = track_leg(walk, find_legs(walk.skeleton)[0], forward_kinematics(walk))
    >>> bool((left.distance < left.reach).all())
    True
    """
    hip, knee, ankle, ball = (poses.positions[:, joint] for joint in leg)
    thigh, shank, frame = knee - hip, ankle - knee, poses.matrices[:, leg.hip]
    across = np.cross(thigh, shank)
    if np.linalg.norm(across, axis=-1).max() <= STIFF:
        name = motion.skeleton.names[leg.knee]
        raise MocapError(f"'{name}' is straight in every frame: which way does it bend?")
    axis = np.einsum("fji,fj->fi", frame, across).sum(axis=0)  # seen from the thigh
    axis = frame @ (axis / np.linalg.norm(axis))
    along = (thigh * axis).sum(-1) * (shank * axis).sum(-1)
    cos = (thigh * shank).sum(-1) - along
    sin = (thigh * np.cross(axis, shank)).sum(-1)
    size = (thigh**2).sum(-1) + (shank**2).sum(-1) + 2 * along
    joints = (hip, knee, ankle, ball)
    return LegTrack(
        motion, leg, poses.matrices, *joints, axis, size, np.hypot(cos, sin), np.arctan2(sin, cos)
    )


def bend_and_swing(track: LegTrack, wanted: Array) -> tuple[Array, Array]:
    """Turn a shank about its knee, then the whole leg about its hip, so that its ankle comes where wanted.

    Parameters
    ----------
    track : the leg in F frames.
    wanted : from the hip to where the ankle must be, (F, 3), metres; out of reach, the leg points there.

    Returns
    -------
    The two rotations in the world's frame, (F, 4) each.
    """
    distance = np.minimum(np.linalg.norm(wanted, axis=-1), track.reach)
    bend = rotations.from_rotvec(track.turn(distance)[:, None] * track.axis)
    return bend, rotations.between(
        track.knee - track.hip + rotations.rotate(bend, track.ankle - track.knee), wanted
    )


def pose_leg(track: LegTrack, wanted: Array, turn: ArrayLike) -> Array:
    """Pose a leg so that its ankle is where it must be, and its foot turned [KSG02, step 4].

    Parameters
    ----------
    track : the leg in F frames.
    wanted : from the hip to where the ankle must be, shape (F, 3), metres.
    turn : shape (F, 3), rotation vectors in the world's frame: how the foot is turned beyond what it was.

    Returns
    -------
    The rotations of hip, knee and ankle relative to their parents, shape (F, 3, 4).

    Raises
    ------
    MocapError : for an ankle that is out of the leg's reach.
    """
    motion, leg = track.motion, track.leg
    lack = np.linalg.norm(wanted, axis=-1) - track.reach
    if np.any(lack > ROUNDING):
        frame = int((lack > ROUNDING).argmax())
        raise MocapError(
            f"'{motion.name}', frame {frame}: '{track.names[2]}' would have to be "
            f"{100 * lack[frame]:.2g} cm out of its leg's reach; are its contacts true?"
        )
    bend, swing = bend_and_swing(track, wanted)
    # In the world, each joint turns by what its parent does not turn it already.
    carried = rotations.multiply(swing, bend)
    sole = rotations.multiply(rotations.inverse(carried), rotations.from_rotvec(turn))
    posed = []
    above = (motion.skeleton.parents[leg.hip], leg.hip, leg.knee)
    for parent, joint, more in zip(above, leg[:3], (swing, bend, sole), strict=True):
        # The same turn, seen from the parent's frame, comes on top of the joint's own rotation.
        above_it = rotations.from_matrix(track.matrices[:, parent])
        local = rotations.multiply(rotations.multiply(rotations.inverse(above_it), more), above_it)
        posed.append(rotations.multiply(local, motion.rotations[:, joint]))
    return np.stack(posed, axis=1)
