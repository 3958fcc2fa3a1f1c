"""Legs and arms of a skeleton, and the role of each joint in a body.

Skeletons from different sources share few joint names, but have the same parts. Legs, arms and head are
identified by the names that common files use, or legs are named by hand. The trunk is identified by the tree:
the pelvis is the last common ancestor of the legs, the chest that of the arms. The waist and the neck are the
first joints above them.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from textwrap import shorten
from typing import Literal, NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, Remedy

LEGS_BY_HAND = Remedy("name each by hand, {}[name_leg(skeleton, hip, knee, ankle, ball), ...]", "legs")

# Names of hip, knee, ankle and of shoulder, elbow, wrist on the left side, by source. Legs and arms are
# looked up separately. A prefix up to a colon is ignored.
LIMBS = (
    ("lfemur ltibia lfoot", "lhumerus lradius lwrist"),  # Acclaim, CMU
    ("lfemur ltibia lfoot", "lhumerus lradius lhand"),
    ("LeftUpLeg LeftLeg LeftFoot", "LeftArm LeftForeArm LeftHand"),
    ("LeftHip LeftKnee LeftAnkle", "LeftShoulder LeftElbow LeftWrist"),
    ("LeftThigh LeftShin LeftFoot", "LeftShoulder LeftElbow LeftWrist"),
    ("UpperLeg_L LowerLeg_L Foot_L", "UpperArm_L LowerArm_L Hand_L"),
    ("left_hip left_knee left_ankle", "left_shoulder left_elbow left_wrist"),
    ("LeftUpLeg LeftLowLeg LeftFoot", "LeftUpArm LeftLowArm LeftHand"),
    ("LeftUpperLeg LeftLowerLeg LeftFoot", "LeftUpperArm LeftLowerArm LeftHand"),
    ("lThigh lShin lFoot", "lShldr lForeArm lHand"),  # Poser, Daz
    ("L_Hip L_Knee L_Ankle", "L_Shoulder L_Elbow L_Wrist"),  # SMPL
)

TRUNK = ("pelvis", "waist", "chest", "neck", "head")
LEG = ("hip", "knee", "ankle", "ball")
ARM = ("shoulder", "elbow", "wrist")
SIDES = ("left", "right")
FEET = tuple(f"{side} {part}" for side in SIDES for part in ("ankle", "ball"))
ROLES = (*TRUNK, *(f"{side} {part}" for side in SIDES for part in ("clavicle", *ARM, *LEG)))
"""The roles that a joint can have in a body, from "pelvis" to "right ball"."""


class Leg(NamedTuple):
    """The joints of a leg, as indices into a skeleton, each the parent of the next.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> leg = Leg(2, 3, 4, 5)
    >>> SKELETON.names[leg.knee], leg.lengths(SKELETON).round(3)
    ('ltibia', array([0.429, 0.43 , 0.136]))
    """

    hip: int
    knee: int
    ankle: int
    ball: int

    def lengths(self, skeleton: Skeleton) -> Array:
        """Return the lengths of thigh, shank and foot (ankle to ball), shape (3,), metres."""
        return np.asarray(np.linalg.norm(skeleton.offsets[list(self[1:])], axis=-1))


def find_legs(skeleton: Skeleton) -> tuple[Leg, ...]:
    """Find the left and the right leg by the names of their joints; the ball is the ankle's first child.

    Raises
    ------
    MocapError : for skeletons with unknown names, whose legs are named by hand with `name_leg`.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [SKELETON.names[joint] for joint in find_legs(SKELETON)[0]]
    ['lfemur', 'ltibia', 'lfoot', 'ltoes']

    Notebook: 04b-feet
    """
    return _find_legs(skeleton, remedy=LEGS_BY_HAND)


def _find_legs(skeleton: Skeleton, advice: str = "", remedy: Remedy | None = None) -> tuple[Leg, ...]:
    """Find the left and the right leg; the error for unknown names carries the advice or the remedy."""
    pair = find_pair(skeleton, "legs")
    if not pair:
        joints = shorten(", ".join(skeleton.names), 38)
        names = shorten(", ".join(dict(LIMBS)), 40)
        raise MocapError(f"No legs found among {joints}: tried {names}.{advice}", remedy=remedy)
    legs = [Leg(hip, knee, ankle, _ball(skeleton, ankle)) for hip, knee, ankle in pair]
    for leg in legs:
        _require_leg(skeleton, leg)
    return tuple(legs)


def _ball(skeleton: Skeleton, ankle: int) -> int:
    """Return the ball of a foot: the first child of its ankle."""
    children = skeleton.children(ankle)
    if not children:
        name = skeleton.names[ankle]
        raise MocapError(f"The foot '{name}' has no joint or end site that could be its ball.")
    return children[0]


def find_pair(skeleton: Skeleton, limbs: Literal["legs", "arms"]) -> list[list[int]]:
    """Find the three joints of the left limb and of its mirror image on the right; [] for unknown names.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [[SKELETON.names[joint] for joint in arm] for arm in find_pair(SKELETON, "arms")]
    [['lhumerus', 'lradius', 'lwrist'], ['rhumerus', 'rradius', 'rwrist']]
    """
    names = _without_prefixes(skeleton)
    for legs, arms in LIMBS:
        limb = (legs if limbs == "legs" else arms).split()
        left = [names.index(name) for name in limb if name in names]
        right = [skeleton.partner(joint) for joint in left]
        if len(left) == len(limb) and not set(left) & set(right):
            return [left, right]
    return []


def _without_prefixes(skeleton: Skeleton) -> list[str]:
    """List the joints' names without a prefix up to a colon, as in "mixamorig:LeftArm"."""
    return [name.rsplit(":", 1)[-1] for name in skeleton.names]


def name_leg(skeleton: Skeleton, hip: str, knee: str, ankle: str, ball: str) -> Leg:
    """Make a leg from the names of its joints.

    Raises
    ------
    MocapError : for unknown names, a joint that is not the parent of the next one, and bones of length zero.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> name_leg(SKELETON, "lfemur", "ltibia", "lfoot", "ltoes")
    Leg(hip=2, knee=3, ankle=4, ball=5)
    """
    leg = Leg(*(skeleton.index(name) for name in (hip, knee, ankle, ball)))
    _require_leg(skeleton, leg)
    return leg


def _require_leg(skeleton: Skeleton, leg: Leg) -> None:
    """Raise unless each joint of a leg is the parent of the next one, by a bone of nonzero length."""
    names = skeleton.names
    for above, below in pairwise(leg):
        if skeleton.parents[below] != above:
            hangs = f"'{names[below]}' hangs on '{names[skeleton.parents[below]]}', not on '{names[above]}'"
            raise MocapError(f"In a leg each joint hangs on the one before, but {hangs}.")
        if not np.linalg.norm(skeleton.offsets[below]) > 1e-6:
            raise MocapError(f"'{names[below]}' sits on '{names[above]}': a bone needs a length.")


def heading_by_hips(positions: Array, legs: Sequence[Leg]) -> Array:
    """Compute the heading perpendicular to the line of the hips, from positions (F, J, 3); radians (F,).

    Examples
    --------
    >>> left, right = Leg(0, 2, 3, 4), Leg(1, 5, 6, 7)
    >>> heading_by_hips(np.array([[[0.0, 1, 0.1], [0, 1, -0.1]]]), [left, right]).round(4)
    array([-1.5708])
    """
    left, right = (positions[:, leg.hip] for leg in legs)
    across = left - right
    return np.asarray(np.arctan2(-across[:, 2], across[:, 0]))


def roles(skeleton: Skeleton) -> dict[str, int]:
    """Find the role of each joint in a body.

    Parameters
    ----------
    skeleton : J joints.

    Returns
    -------
    {role: joint}. Hips, knees, ankles and balls are always included; other roles only if the body has them.

    Raises
    ------
    MocapError : for legs that are not found.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> joints = roles(SKELETON)
    >>> [SKELETON.names[joints[role]] for role in ("pelvis", "waist", "chest", "neck", "left wrist")]
    ['root', 'lowerback', 'thorax', 'lowerneck', 'lwrist']

    Notebook: 13-retargeting
    """
    joints: dict[str, int] = {}
    for side, leg in zip(SIDES, _find_legs(skeleton, advice=" Rename the joints."), strict=True):
        joints |= {f"{side} {part}": joint for part, joint in zip(LEG, leg, strict=True)}
    for side, arm in zip(SIDES, find_pair(skeleton, "arms"), strict=False):  # there may be none
        joints |= {f"{side} {part}": joint for part, joint in zip(ARM, arm, strict=True)}
    names = [name.lower() for name in _without_prefixes(skeleton)]
    if "head" in names:
        joints["head"] = names.index("head")
    joints |= _trunk(skeleton, joints)
    return {role: joints[role] for role in ROLES if role in joints}


def _trunk(skeleton: Skeleton, limbs: Mapping[str, int]) -> dict[str, int]:
    """Find the joints of the trunk by the tree, from those of the limbs and the head."""
    ancestors = {role: skeleton.path_to_root(joint)[1:] for role, joint in limbs.items()}
    pelvis = _last_common(ancestors, "hip")
    chest = _last_common(ancestors, "shoulder")
    spine = skeleton.path_to_root(chest)[1:]
    if pelvis not in spine:  # no arms, or arms attached to the pelvis
        return {"pelvis": pelvis}
    trunk = {"pelvis": pelvis, "chest": chest}
    if spine[0] != pelvis:
        trunk["waist"] = _child_towards(pelvis, spine)
    for role, limb in (("neck", "head"), *((f"{side} clavicle", f"{side} shoulder") for side in SIDES)):
        path = ancestors.get(limb, [])
        if chest in path[1:]:
            trunk[role] = _child_towards(chest, path)
    return trunk


def _last_common(ancestors: Mapping[str, list[int]], part: str) -> int:
    """Return the last common ancestor of the left and the right `part`, the root if there is none."""
    left = set(ancestors.get(f"left {part}", ()))
    right = set(ancestors.get(f"right {part}", ()))
    return max(left & right, default=0)


def _child_towards(joint: int, path: list[int]) -> int:
    """Return the child of `joint` on a path to the root."""
    return path[path.index(joint) - 1]
