"""How the hips move when the root rises and the pelvis lists: the body's part of step 3 of [KSG02].

Two legs that stand ask for two heights of their hips. The root's rise gives both hips the same height. The
list of the pelvis, a small rotation about a horizontal axis that points ahead, raises one hip and lowers the
other. Spine, head and arms keep their directions.
"""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses
from mocap.body.legs import Leg
from mocap.body.motion import Motion
from mocap.feet.leg_track import UP, dot


class Pelvis(NamedTuple):
    """The joint from which both legs branch, in F frames, and what its list does to the hips.

    Parameters
    ----------
    joint : the last common ancestor of the hips.
    axis : unit vectors of the list, shape (F, 3), horizontal; 0 where the hips are above each other.
    level : shape (F,), how far the line of the hips is from upright: 1 if it is horizontal, 0 if it is
        vertical. The pelvis lists by so much of the angle.
    half : half the distance between the hips, metres; 0 for one leg.
    across : of each leg's hip its velocity, shape (L, F, 3), metres per radian of the list.
    arm : of each leg's hip its offset from the axis through the joint, shape (L, F, 3), metres.
    """

    joint: int
    axis: Array
    level: Array
    half: float
    across: Array
    arm: Array

    def shift(self, leg: int, rise: Array, angle: Array) -> Array:
        """Return the displacement of a leg's hip, (..., F, 3), metres.

        Parameters
        ----------
        leg : index of the leg.
        rise : of the root, shape (..., F), metres.
        angle : of the list, shape (..., F), radians; positive raises the first leg's hip.
        """
        listed = (self.level * angle)[..., None]
        inwards = (np.cos(listed) - 1) * self.arm[leg]
        raised = np.sin(listed) * self.across[leg]
        return np.asarray(rise[..., None] * UP + raised + inwards)

    def rotation(self, angle: Array) -> Array:
        """Return the list as quaternions in the world's frame, shape (F, 4)."""
        return rotations.from_rotvec((self.level * angle)[:, None] * self.axis)


def find_pelvis(motion: Motion, legs: Sequence[Leg], poses: GlobalPoses) -> Pelvis:
    """Find the joint from which legs branch, and the axis of its list.

    Examples
    --------
    >>> from mocap.body.kinematics import forward_kinematics
    >>> from mocap.body.limbs import find_legs
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> pelvis = find_pelvis(walk, find_legs(walk.skeleton), forward_kinematics(walk))
    >>> bool((pelvis.across[0, :, 1] > 0.05).all()), bool((pelvis.across[1, :, 1] < -0.05).all())
    (True, True)
    """
    above = [motion.skeleton.path_to_root(leg.hip)[1:] or [leg.hip] for leg in legs]
    joint = next(joint for joint in above[0] if all(joint in path for path in above))
    hips = poses.positions[:, [leg.hip for leg in legs]].swapaxes(0, 1)
    between = hips[0] - hips[-1]
    distance = np.sqrt(dot(between, between))
    ahead = np.cross(between, UP)
    horizontal = np.sqrt(dot(ahead, ahead))
    axis = ahead / np.maximum(horizontal, np.finfo(float).tiny)[:, None]
    level = horizontal / np.maximum(distance, np.finfo(float).tiny)
    arm = hips - poses.positions[:, joint]
    arm = arm - dot(arm, np.broadcast_to(axis, arm.shape))[..., None] * axis
    return Pelvis(joint, axis, level, float(distance.mean()) / 2, np.cross(axis, arm), arm)


def listed_rotations(
    motion: Motion, pelvis: Pelvis, legs: Sequence[Leg], poses: GlobalPoses, angle: Array
) -> Array:
    """Rotate a pelvis, and keep the directions of all that is above it.

    Parameters
    ----------
    motion, legs, poses : F frames of J joints, as for `find_pelvis`.
    angle : of the list, shape (F,), radians.

    Returns
    -------
    Rotations relative to the parents, shape (F, J, 4). The legs still turn with the pelvis.
    """
    local = motion.rotations.copy()
    turn = pelvis.rotation(angle)
    parent = motion.skeleton.parents[pelvis.joint]
    local[:, pelvis.joint] = _turned(local[:, pelvis.joint], turn, poses, parent)
    below = {joint for leg in legs for joint in motion.skeleton.path_to_root(leg.hip)}
    for child in np.flatnonzero(motion.skeleton.parents == pelvis.joint):
        if child not in below:
            local[:, child] = _turned(local[:, child], rotations.inverse(turn), poses, pelvis.joint)
    return local


def _turned(local: Array, turn: Array, poses: GlobalPoses, parent: int) -> Array:
    """Apply a rotation of the world's frame to local rotations (F, 4) below a parent."""
    if parent < 0:
        return rotations.multiply(turn, local)
    frame = rotations.from_matrix(poses.matrices[:, parent])
    seen = rotations.multiply(rotations.multiply(rotations.inverse(frame), turn), frame)
    return rotations.multiply(seen, local)
