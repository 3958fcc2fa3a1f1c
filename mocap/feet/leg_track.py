"""One leg over a clip: its reach by the flexion of its knee, and its pose for another ankle [KSG02, step 4].

All steps of a clean-up need the same few quantities of a leg. A `LegTrack` has them. A leg is posed from the
pose that it has, which changes as little as the new position of its ankle allows: the knee, a hinge, flexes,
and then the whole leg swings at the hip.
"""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses
from mocap.body.legs import Leg
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.feet.tuned import TUNED

UP = np.array([0.0, 1.0, 0.0])
ROUNDING = 1e-9  # metres: what rounding may add to a distance

BACK = 1e-4  # radians: a knee that is bent backwards by less is straight, except for rounding

# Square metres: where the cross product of thigh and shank is smaller in every frame, its direction is
# rounding.
STIFF = 1e-6


def dot(a: Array, b: Array) -> Array:
    """Return the dot products of vectors (..., 3), shape (...)."""
    return np.asarray(np.einsum("...c,...c->...", a, b))


class LegTrack(NamedTuple):
    """A leg in the F frames of a motion, with the hinge of its knee.

    The distance from hip to ankle is √(size + 2 radius cos φ) for a flexion φ of the knee.

    Parameters
    ----------
    motion, leg : whose leg it is; the motion's contacts are not read.
    matrices : rotations of the joints in the world's frame, shape (F, J, 3, 3).
    hip, knee, ankle, ball : positions, shape (F, 3), metres.
    axis : the hinge of the knee, unit vectors of shape (F, 3).
    shank : the vector from knee to ankle in three parts, (3, F, 3): along the hinge, perpendicular to it, and
        the latter rotated about it by 90°.
    size, radius : shape (F,), m².
    flexion : φ in the motion, shape (F,), radians; negative if the knee is bent backwards.
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
    flexion: Array

    @property
    def length(self) -> float:
        """Return the length of thigh and shank together, metres."""
        return float(self.leg.lengths(self.motion.skeleton)[:2].sum())

    def reach(self, flexion: ArrayLike) -> Array:
        """Return the distance from hip to ankle, (F,), metres, for flexions of the knee (F,), radians."""
        return np.asarray(np.sqrt(self.size + 2 * self.radius * np.cos(flexion)))

    def flexion_at(self, distance: Array) -> Array:
        """Return the flexion of the knee, (F,), radians, for distances (F,) from hip to ankle."""
        cosine = (distance**2 - self.size) / (2 * self.radius)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))

    @property
    def limit(self) -> Array:
        """Return the largest distance from hip to ankle for which the pose may change, (F,), metres.

        No knee becomes straighter than `TUNED.flexion`, unless it is straighter in the motion.
        """
        return self.reach(np.minimum(np.abs(self.flexion), np.radians(TUNED.flexion)))

    def rises(self, place: Array, foot: float | Array = 0.0) -> Array:
        """Return the lowest and the highest rise of the root, (2, F), metres, at which the leg reaches.

        Parameters
        ----------
        place : position of the ankle or the ball, (F, 3), metres.
        foot : length of the foot if it is the ball's position, metres.
        """
        offset = self.hip - place
        horizontal = offset[:, 0] ** 2 + offset[:, 2] ** 2
        vertical = np.sqrt(np.maximum((self.reach(0.0) + foot) ** 2 - horizontal, 0.0))
        return np.array([-vertical, vertical]) - offset[:, 1]

    def flexed(self, flexion: Array) -> Array:
        """Return the vector from hip to ankle, (..., F, 3), if the thigh rests and the knee flexes."""
        parallel, perpendicular, rotated = self.shank
        change = (flexion - self.flexion)[..., None]
        thigh = self.knee - self.hip
        return np.asarray(thigh + parallel + np.cos(change) * perpendicular + np.sin(change) * rotated)

    def swung_thigh(self, flexion: Array, wanted: Array) -> Array:
        """Return the vector from hip to knee, (..., F, 3), if then the leg swings to `wanted` (..., F, 3).

        The swing is a half turn about the direction of the leg, and one about the bisector of that direction
        and the wanted one. It is undefined, and the second one is left out, if they are opposite.
        """
        thigh = self.knee - self.hip
        leg = self.flexed(flexion) / self.reach(flexion)[..., None]
        direction = wanted / np.sqrt(dot(wanted, wanted))[..., None]
        bisector = leg + direction
        weight = dot(bisector, thigh) / np.maximum(1 + dot(leg, direction), ROUNDING)
        along = 2 * dot(leg, thigh)[..., None] * direction
        return np.asarray(thigh + along - weight[..., None] * bisector)


def track_leg(motion: Motion, leg: Leg, poses: GlobalPoses) -> LegTrack:
    """Measure a leg in all frames of a motion with its global poses.

    Raises
    ------
    MocapError : for a knee that is straight in every frame and therefore shows no hinge.
    """
    hip, knee, ankle, ball = (poses.positions[:, joint] for joint in leg)
    thigh = knee - hip
    shank = ankle - knee
    frame = poses.matrices[:, leg.hip]
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
    track: LegTrack, flexion: Array, wanted: Array, turn: ArrayLike, pelvis: Array = rotations.IDENTITY
) -> Array:
    """Compute the rotations of a leg from the flexion of its knee and the direction of its ankle.

    In the paper: [KSG02, step 4].

    Parameters
    ----------
    track : the leg in F frames.
    flexion : of the knee, shape (F,), radians; `track.flexion_at` computes it from a distance.
    wanted : the vector from the hip to the ankle, shape (F, 3).
    turn : the additional rotation of the foot, shape (F, 3), rotation vectors in the world's frame.
    pelvis : the rotation of the joint above the hip, shape (F, 4), quaternions in the world's frame.

    Returns
    -------
    The rotations of hip, knee and ankle relative to their parents, shape (F, 3, 4).
    """
    motion = track.motion
    leg = track.leg
    # The knee flexes. Then the whole leg swings at the hip along the shortest arc.
    fold = rotations.from_rotvec((flexion - track.flexion)[:, None] * track.axis)
    swing = rotations.between(track.flexed(flexion), wanted)
    # In the world's frame, each joint rotates by what its parent does not yet rotate it.
    carried = rotations.multiply(swing, fold)
    sole = rotations.multiply(rotations.inverse(carried), rotations.from_rotvec(turn))
    thigh = rotations.multiply(rotations.inverse(pelvis), swing)
    posed = []
    parents = motion.skeleton.parents[list(leg[:3])]  # of a split thigh, a joint between
    for parent, joint, rotation in zip(parents, leg[:3], (thigh, fold, sole), strict=True):
        # The same rotation in the parent's frame precedes the rotation of the joint.
        frame = rotations.from_matrix(track.matrices[:, parent])
        local = rotations.multiply(rotations.multiply(rotations.inverse(frame), rotation), frame)
        posed.append(rotations.multiply(local, motion.rotations[:, joint]))
    return np.stack(posed, axis=1)


def kept_toes(track: LegTrack, turn: Array) -> Array:
    """Compute the rotations of a ball that keep the tilt of the toes if the foot rotates.

    A captured ball trembles, and the foot with it, but the toes less: the rotation of the ball relative to it
    cancels a part. If the ball is held, the foot is still, and with the same rotation the toes would tremble.
    Toes follow only the heading of the foot: the part of its rotation about the vertical.

    Parameters
    ----------
    track : the leg in F frames.
    turn : the additional rotation of the foot, shape (F, 3), rotation vectors in the world's frame.

    Returns
    -------
    Rotations relative to the foot, shape (F, 4).
    """
    foot_turn = rotations.from_rotvec(turn)
    heading = rotations.about_y(2 * np.arctan2(foot_turn[:, 2], foot_turn[:, 0]))
    back = rotations.multiply(rotations.inverse(foot_turn), heading)
    foot = rotations.from_matrix(track.matrices[:, track.motion.skeleton.parents[track.leg.ball]])
    local = rotations.multiply(rotations.multiply(rotations.inverse(foot), back), foot)
    return rotations.multiply(local, track.motion.rotations[:, track.leg.ball])
