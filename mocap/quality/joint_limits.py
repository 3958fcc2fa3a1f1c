"""Joint angles of knees, elbows, hips, wrists and the neck, and the human range of motion.

Rest poses differ from file to file, so no angle is measured from them. An angle is between two bones, or
between a bone and the trunk, which is the line from the middle of the hips to the neck. The spine also bends.
Therefore a limit of the angle to the trunk is that of the joint plus that of the spine, both by [AAOS65]. For
the thigh it is 30° + 30° backwards, 45° + 35° outwards and 30° + 35° inwards, past the other leg. For the
head it is 45° + 35°, and for a wrist 80°. The limits of knees and elbows are our own. In 75 captured files,
which include dances and cartwheels, the head bends by at most 60°, a wrist by 70°, and a thigh by 43°
backwards and 76° outwards.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.legs import Leg
from mocap.body.limbs import ARM, SIDES
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.quality.limits import LIMITS

BEHIND = 60.0  # degrees that a thigh may bend behind the trunk's line
OUT = 80.0  # degrees that a thigh may bend out to its side
ACROSS = 65.0  # degrees that a thigh may bend past the other leg
NOD = 80.0  # degrees between trunk and head
WRIST = 80.0  # degrees between forearm and hand

# In the names of joints.
ELBOW = "elbow|radius|forearm|lowerarm"
NECK = "neck"
HEAD = "head"


class Bend(NamedTuple):
    """A joint's angle in each frame (F,), degrees, with the smallest and the largest human angle.

    Examples
    --------
    >>> Bend("lfemur", "back", np.array([30.0, 90.0]), -np.inf, 60.0).fraction
    array([0.5, 1.5])
    """

    joint: str
    direction: str
    angles: Array
    smallest: float
    largest: float

    @property
    def fraction(self) -> Array:
        """The angle in each frame as a fraction of its limit. Above 1 the joint exceeds the limit."""
        return np.maximum(self.angles / self.smallest, self.angles / self.largest)


def joint_bends(motion: Motion, legs: Sequence[Leg] = (), poses: GlobalPoses | None = None) -> list[Bend]:
    """Measure the angles of the joints whose limits are known.

    The axis of a knee or an elbow is the axis about which it bends most in the clip. A knee whose shank is in
    front is recognised as bent backwards. An arm may have any direction, therefore an elbow that is bent
    backwards in all frames is not recognised. An arm that is nearly straight in all frames has no sure axis,
    so it is not known which of its bends are backwards.

    Parameters
    ----------
    motion : F frames.
    legs : the left and the right leg, as returned by `body.find_legs`. Without them knees, hips and the neck
        are left out. Elbows, wrists and the neck are found by their roles or names.
    poses : the world poses of all joints, as returned by `body.forward_kinematics`. They are computed by
        default.

    Examples
    --------
    >>> from mocap.body.limbs import find_legs
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> sorted({bend.direction for bend in joint_bends(walk, find_legs(walk.skeleton))})
    ['back', 'bent', 'nodding', 'out']
    """
    skeleton = motion.skeleton
    if poses is None:
        poses = forward_kinematics(motion)
    hip_axis = _hip_axis(poses.positions, legs)
    bends = [_hinge_bend(poses, skeleton.names[leg.knee], leg[:3], hip_axis) for leg in legs]
    for arm in _arms(skeleton):
        bends += _arm_bends(poses, skeleton, arm)
    return [*bends, *_trunk_bends(poses.positions, skeleton, legs, hip_axis)]


def _hip_axis(positions: Array, legs: Sequence[Leg]) -> Array:
    """Return the unit vectors (F, 3) from the right hip to the left one, or zeros without two legs."""
    if len(legs) != 2:
        return np.zeros(3)
    axis = positions[:, legs[0].hip] - positions[:, legs[1].hip]
    return np.asarray(axis / np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-12))


def _arms(skeleton: Skeleton) -> list[list[int]]:
    """List shoulder, elbow and wrist by their roles, or around joints that have the name of an elbow."""
    by_role = [[skeleton.roles.get(f"{side} {part}", "") for part in ARM] for side in SIDES]
    if all(map(all, by_role)):
        return [[skeleton.index(name) for name in arm] for arm in by_role]
    return [[int(skeleton.parents[j]), j, skeleton.children(j)[0]] for j in _elbows(skeleton)]


def _elbows(skeleton: Skeleton) -> list[int]:
    """List the joints that have the name of an elbow and at least one child."""
    joints = range(1, len(skeleton))
    named = [joint for joint in joints if re.search(ELBOW, skeleton.names[joint].lower())]
    return [joint for joint in named if skeleton.children(joint)]


def _arm_bends(poses: GlobalPoses, skeleton: Skeleton, arm: Sequence[int]) -> Iterator[Bend]:
    """Measure an elbow, and its wrist if there are joints in the hand."""
    shoulder, elbow, wrist = arm
    yield _hinge_bend(poses, skeleton.names[elbow], (shoulder, elbow, wrist), np.zeros(3))
    fingers = [joint for joint in skeleton.children(wrist) if np.linalg.norm(skeleton.offsets[joint]) > 1e-3]
    if fingers:
        positions = poses.positions
        forearm = positions[:, wrist] - positions[:, elbow]
        hand = positions[:, fingers].mean(axis=1) - positions[:, wrist]
        yield Bend(skeleton.names[wrist], "bent", _angles(forearm, hand), -np.inf, WRIST)


def _trunk_bends(
    positions: Array, skeleton: Skeleton, legs: Sequence[Leg], hip_axis: Array
) -> Iterator[Bend]:
    """Measure hips and neck against the trunk, the line from the middle of the hips to the neck."""
    neck = _named(skeleton, NECK)
    head = _named(skeleton, HEAD)
    if len(legs) != 2 or neck is None:
        return
    middle_of_hips = (positions[:, legs[0].hip] + positions[:, legs[1].hip]) / 2
    trunk = positions[:, neck] - middle_of_hips
    ahead = np.cross(hip_axis, trunk)
    to_the_left = np.cross(trunk, ahead)
    for leg, outwards in zip(legs, (to_the_left, -to_the_left), strict=True):
        name = skeleton.names[leg.hip]
        thigh = positions[:, leg.knee] - positions[:, leg.hip]
        yield Bend(name, "back", _angles(thigh, ahead) - 90, -np.inf, BEHIND)
        yield Bend(name, "out", 90 - _angles(thigh, outwards), -ACROSS, OUT)
    if head is not None:
        top = (skeleton.children(head) or [head])[0]
        nodding = _angles(trunk, positions[:, top] - positions[:, neck])
        yield Bend(skeleton.names[neck], "nodding", nodding, -np.inf, NOD)


def _named(skeleton: Skeleton, part: str) -> int | None:
    """Return the joint with the role `part`, or else the first one below the root with it in its name."""
    if part in skeleton.roles:
        return skeleton.index(skeleton.roles[part])
    names = enumerate(skeleton.names[1:], start=1)
    return next((joint for joint, name in names if part in name.lower()), None)


def _hinge_bend(poses: GlobalPoses, name: str, joints: Sequence[int], hip_axis: Array) -> Bend:
    """Measure the flexion of a hinge joint between two bones, degrees, negative backwards.

    It is the rotation about the joint's axis, atan2(n · axis, u · v) of the directions u and v of both bones
    with n = u × v. Sideways bending does not count. Without a sure axis no angle is too far backwards.
    """
    bones = np.diff(poses.positions[:, list(joints)], axis=1)
    bones /= np.maximum(np.linalg.norm(bones, axis=-1, keepdims=True), 1e-12)
    upper = bones[:, 0]
    lower = bones[:, 1]
    to_world = poses.matrices[:, joints[0]]  # from the frame of the upper bone
    normals = np.einsum("fji,fj->fi", to_world, np.cross(upper, lower))
    to_the_left = np.einsum("fji,fj->fi", to_world, np.broadcast_to(hip_axis, upper.shape)).mean(axis=0)
    axis, is_sure = _hinge_axis(normals, to_the_left)
    angles = np.degrees(np.arctan2(normals @ axis, (upper * lower).sum(axis=-1)))
    return Bend(name, "bent", np.asarray(angles), -LIMITS.backwards if is_sure else -np.inf, LIMITS.folded)


def _hinge_axis(normals: Array, to_the_left: Array) -> tuple[Array, bool]:
    """Find the axis of a hinge, about which its flexion is positive, and whether it is sure.

    It is the first principal axis of the normals. A knee's points to the left, about which no human knee
    bends backwards; if it does not lie across the body, and for an elbow, flexion is what the joint mostly
    does.

    Parameters
    ----------
    normals : shape (F, 3), the cross products of the directions of both bones.
    to_the_left : shape (3,), the body's left, or zeros if it tells nothing. Both are in the frame of the
        upper bone.
    """
    _, directions = np.linalg.eigh(normals.T @ normals)  # in ascending order
    axis = directions[:, -1]
    across = float(axis @ to_the_left)
    if abs(across) > LIMITS.about_one_axis:
        return axis * np.sign(across), True
    mean_sine = float(normals.mean(axis=0) @ axis)
    if mean_sine < 0:
        axis = -axis
    return axis, abs(mean_sine) > LIMITS.sure_bend


def _angles(first: Array, second: Array) -> Array:
    """Return the angles between vectors (F, 3), degrees."""
    sine = np.linalg.norm(np.cross(first, second), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (first * second).sum(-1))))
