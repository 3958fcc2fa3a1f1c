"""One leg over a clip: how far its knee lets it reach, and its ankle in another place: step 4 of [KSG02].

All five steps of a clean-up ask for the same few things about a leg. A `LegTrack` measures each of them once.
There is a pose to begin with, and the leg changes as little as its new ankle allows. The knee, a hinge, bends
as it must. Then the whole leg swings at the hip.
"""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.errors import MocapError

UP = np.array([0.0, 1.0, 0.0])
ROUNDING = 1e-9  # metres: what rounding may add to a distance

# Radians: 12°. A leg that becomes a millimetre shorter moves its knee by 4 mm there, by 6 mm at 8°, and by
# 14 mm at 2°: knee popping. With 8° one who stands on straight legs accelerates by up to 1.4 times as much as
# before; with 15° as many plants are held.
BENT = np.radians(12.0)

BACK = 1e-4  # radians: a knee that bends backwards by less is straight, but for rounding

# Square metres: where the cross product of thigh and shank is smaller in every frame, its direction is
# rounding.
STIFF = 1e-6


def dot(a: Array, b: Array) -> Array:
    """Multiply vectors (..., 3), each with its own, to numbers (...)."""
    return np.asarray(np.einsum("...c,...c->...", a, b))


class LegTrack(NamedTuple):
    """A leg in the F frames of a motion, and what bending its knee does.

    With its knee bent by φ about its hinge, a leg is √(size + 2 radius cos φ) long.

    Parameters
    ----------
    motion, leg : whose leg it is; the motion's contacts are not read.
    matrices : how each joint is turned in the world, shape (F, J, 3, 3).
    hip, knee, ankle, ball : where they are, shape (F, 3), metres.
    axis : the knee's hinge, unit vectors of shape (F, 3).
    shank : from knee to ankle, (3, F, 3): along the hinge, across it, and that turned about it by 90°.
    size, radius : shape (F,), m².
    own : φ in the motion, shape (F,), radians; below 0 where the knee is bent backwards.
    """

    motion: Motion
    leg: Leg
    matrices: Array
    hip: Array
    knee: Array
    ankle: Array
    ball: Array
    axis: Array
    shank: Array
    size: Array
    radius: Array
    own: Array

    @property
    def length(self) -> float:
        """Of thigh and shank together, metres."""
        return float(self.leg.lengths(self.motion.skeleton)[:2].sum())

    def long(self, bend: ArrayLike) -> Array:
        """How far hip and ankle are apart, (F,), metres, where the knee is bent by (F,), radians."""
        return np.asarray(np.sqrt(self.size + 2 * self.radius * np.cos(bend)))

    @property
    def limit(self) -> Array:
        """How far apart hip and ankle shall come, (F,), metres.

        No knee becomes straighter than `BENT`, except where it is straighter already.
        """
        return self.long(np.minimum(np.abs(self.own), BENT))

    def rises(self, place: Array, foot: float | Array = 0.0) -> Array:
        """How far the root may fall and rise, (2, F), metres, for leg and foot to reach to `place` (F, 3)."""
        apart = self.hip - place
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        half = np.sqrt(np.maximum((self.long(0.0) + foot) ** 2 - level, 0.0))
        return np.array([-half, half]) - apart[:, 1]

    def bend(self, distance: Array) -> Array:
        """How far the knee is bent, (F,), radians, where hip and ankle are a distance (F,) apart."""
        return np.asarray(np.arccos(np.clip((distance**2 - self.size) / (2 * self.radius), -1.0, 1.0)))

    def folded(self, bend: Array) -> Array:
        """Give the way from hip to ankle, (..., F, 3), if the knee bends to (..., F) and the thigh rests."""
        along, across, turned = self.shank
        more = (bend - self.own)[..., None]
        return np.asarray(self.knee - self.hip + along + np.cos(more) * across + np.sin(more) * turned)

    def thigh(self, bend: Array, wanted: Array) -> Array:
        """Give the way from hip to knee, (..., F, 3), if then the leg swings to `wanted` (..., F, 3)."""
        thigh, leg = self.knee - self.hip, self.folded(bend) / self.long(bend)[..., None]
        way = wanted / np.sqrt(dot(wanted, wanted))[..., None]
        # The swing is a half turn about the leg, then one about leg + way; that is 0 where they are opposite.
        share = dot(leg + way, thigh) / np.maximum(1 + dot(leg, way), ROUNDING)
        return np.asarray(thigh + 2 * dot(leg, thigh)[..., None] * way - share[..., None] * (leg + way))


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
    >>> bool((left.own > 0).all())
    True
    """
    hip, knee, ankle, ball = (poses.positions[:, joint] for joint in leg)
    thigh, shank, frame = knee - hip, ankle - knee, poses.matrices[:, leg.hip]
    across = np.cross(thigh, shank)
    if np.abs(across).max() <= STIFF:
        name = motion.skeleton.names[leg.knee]
        raise MocapError(f"'{name}' is straight in every frame: which way does it bend?")
    axis = np.einsum("fji,fj->fi", frame, across).sum(axis=0)  # seen from the thigh
    axis = frame @ (axis / np.linalg.norm(axis))
    along = dot(shank, axis)[:, None] * axis
    parts = np.array([along, shank - along, np.cross(axis, shank)])
    level, cos, sin = dot(parts, thigh)
    size = dot(thigh, thigh) + dot(shank, shank) + 2 * level
    hinge = (axis, parts, size, np.hypot(cos, sin), -np.arctan2(sin, cos))
    return LegTrack(motion, leg, poses.matrices, hip, knee, ankle, ball, *hinge)


def pose_leg(
    track: LegTrack, bend: Array, wanted: Array, turn: ArrayLike, pelvis: Array = rotations.IDENTITY
) -> Array:
    """Pose a leg by the angle of its knee and the direction of its ankle [KSG02, step 4].

    Parameters
    ----------
    track : the leg in F frames.
    bend : the knee's angle, shape (F,), radians; `track.bend` says which one brings an ankle where it is
        wanted.
    wanted : the way from the hip to the ankle, shape (F, 3).
    turn : shape (F, 3), rotation vectors in the world's frame: how the foot is turned beyond what it was.
    pelvis : shape (F, 4), quaternions in the world's frame: how the joint above the hip is turned.

    Returns
    -------
    The rotations of hip, knee and ankle relative to their parents, shape (F, 3, 4).
    """
    motion, leg = track.motion, track.leg
    # The shank turns at the knee to bend it; then the whole leg turns at the hip, the shortest way.
    fold = rotations.from_rotvec((bend - track.own)[:, None] * track.axis)
    swing = rotations.between(track.folded(bend), wanted)
    # In the world, each joint turns by what its parent does not turn it already.
    carried = rotations.multiply(swing, fold)
    sole = rotations.multiply(rotations.inverse(carried), rotations.from_rotvec(turn))
    posed = []
    above = motion.skeleton.parents[list(leg[:3])]  # of a split thigh, a joint between
    thigh = rotations.multiply(rotations.inverse(pelvis), swing)
    for parent, joint, more in zip(above, leg[:3], (thigh, fold, sole), strict=True):
        # The same turn, seen from the parent's frame, comes on top of the joint's own rotation.
        above_it = rotations.from_matrix(track.matrices[:, parent])
        local = rotations.multiply(rotations.multiply(rotations.inverse(above_it), more), above_it)
        posed.append(rotations.multiply(local, motion.rotations[:, joint]))
    return np.stack(posed, axis=1)
