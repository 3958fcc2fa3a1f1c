"""Do joints bend as people's do? Knees, elbows, hips, wrists and the neck, measured between bones.

Rest poses differ from file to file, so nothing is measured against them: an angle is between two bones, or
between a bone and the trunk, which goes from the middle of the hips to the neck. The trunk is bent by the
spine. So a limit against it is that of the joint plus that of the spine, both by [AAOS65]: the thigh goes
30° + 30° behind the trunk, 45° + 35° out to its side and 30° + 35° past the other leg; the head bends by
45° + 35°, a wrist by 80°. For knees and elbows the limits are ours. In 75 captured files, dances and
cartwheels among them, the head bends by 60° at most, a wrist by 70°; thighs go 43° behind and 76° out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton

BACKWARDS, FOLDED = 10.0, 160.0  # degrees that a knee or an elbow may bend backwards, and forwards
BEHIND, OUT, ACROSS = 60.0, 80.0, 65.0  # degrees that a thigh may go from the trunk's line
SURE = 0.5  # of a knee's bending has to be about one axis to say that it bends the wrong way
NOD, WRIST = 80.0, 80.0  # degrees between trunk and head, and between forearm and hand
ELBOW, NECK, HEAD = "elbow|radius|forearm|lowerarm", "neck", "head"  # in the names of joints


class Bend(NamedTuple):
    """A joint's angle in each frame (F,), degrees, and the least and the most that a person's joint does.

    Examples
    --------
    >>> Bend("lfemur", "back", np.array([30.0, 90.0]), -np.inf, 60.0).share
    array([0.5, 1.5])
    """

    joint: str
    way: str
    angles: Array
    least: float
    most: float

    @property
    def share(self) -> Array:
        """How much of the limit is used, per frame; above 1 the joint is beyond it."""
        return np.maximum(self.angles / self.least, self.angles / self.most)


def joint_bends(motion: Motion, legs: Sequence[Leg] = ()) -> list[Bend]:
    """Measure the angles of the joints whose limits are known.

    A knee or an elbow bends about the axis about which it bends most in the clip. The shank goes back from
    there; but an arm may point anywhere, so an elbow that is bent backwards in all frames is not seen.

    Parameters
    ----------
    motion : F frames.
    legs : the left and the right leg, as `body.find_legs` finds them; without them knees, hips and the neck
        are left out. Elbows, wrists and the neck are found by their names.

    Examples
    --------
    >>> from mocap.body.limbs import find_legs
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> sorted({bend.way for bend in joint_bends(walk, find_legs(walk.skeleton))})
    ['back', 'bent', 'nodding', 'out']
    """
    poses, skeleton = forward_kinematics(motion), motion.skeleton
    places, names, left = poses.positions, skeleton.names, np.zeros(3)
    if len(legs) == 2:  # unit vectors (F, 3) from the right hip to the left
        left = places[:, legs[0].hip] - places[:, legs[1].hip]
        left = left / np.maximum(np.linalg.norm(left, axis=-1, keepdims=True), 1e-12)
    bends = [_hinge(poses, names[leg.knee], leg[:3], left) for leg in legs]
    for elbow in range(1, len(skeleton)):
        below = skeleton.children(elbow)
        if not below or not re.search(ELBOW, names[elbow].lower()):
            continue
        wrist, forearm = below[0], (int(skeleton.parents[elbow]), elbow, below[0])
        bends.append(_hinge(poses, names[elbow], forearm, np.zeros(3)))
        if fingers := [c for c in skeleton.children(wrist) if np.linalg.norm(skeleton.offsets[c]) > 1e-3]:
            hand = places[:, fingers].mean(axis=1) - places[:, wrist]
            turned = _between(places[:, wrist] - places[:, elbow], hand)
            bends.append(Bend(names[wrist], "bent", turned, -np.inf, WRIST))
    return [*bends, *_against_trunk(places, skeleton, legs, left)]


def _against_trunk(places: Array, skeleton: Skeleton, legs: Sequence[Leg], left: Array) -> Iterator[Bend]:
    """Measure hips and neck against the line from the middle of the hips to the neck."""
    names = [(j, name.lower()) for j, name in enumerate(skeleton.names) if j]
    neck, head = (next((j for j, name in names if part in name), None) for part in (NECK, HEAD))
    if len(legs) != 2 or neck is None:
        return
    trunk = places[:, neck] - (places[:, legs[0].hip] + places[:, legs[1].hip]) / 2
    ahead = np.cross(left, trunk)
    for leg, side in zip(legs, (1, -1), strict=True):
        thigh, name = places[:, leg.knee] - places[:, leg.hip], skeleton.names[leg.hip]
        yield Bend(name, "back", _between(thigh, ahead) - 90, -np.inf, BEHIND)
        yield Bend(name, "out", 90 - _between(thigh, side * np.cross(trunk, ahead)), -ACROSS, OUT)
    if head is not None:
        top = (skeleton.children(head) or [head])[0]
        nodding = _between(trunk, places[:, top] - places[:, neck])
        yield Bend(skeleton.names[neck], "nodding", nodding, -np.inf, NOD)


def _hinge(poses: GlobalPoses, name: str, joints: Sequence[int], left: Array) -> Bend:
    """Measure how far a hinge bends, degrees; below 0 backwards: against the way in which it mostly bends.

    If it mostly bends to the right about `left`, unit vectors (F, 3), as no knee does, that is backwards.
    """
    upper, lower = np.diff(poses.positions[:, list(joints)], axis=1).swapaxes(0, 1)
    across = np.cross(upper, lower)
    bends = np.einsum("fji,fj->fi", poses.matrices[:, joints[0]], across)  # seen from above
    axis = bends.sum(axis=0) / max(float(np.linalg.norm(bends.sum(axis=0))), 1e-12)
    if (across * left).sum() < -SURE * np.linalg.norm(across, axis=-1).sum():
        axis = -axis
    sine = np.linalg.norm(bends, axis=-1) * np.sign(bends @ axis)
    angles = np.degrees(np.arctan2(sine, (upper * lower).sum(-1)))
    return Bend(name, "bent", np.asarray(angles), -BACKWARDS, FOLDED)


def _between(first: Array, second: Array) -> Array:
    """Measure the angles between vectors (F, 3), degrees."""
    sine = np.linalg.norm(np.cross(first, second), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (first * second).sum(-1))))
