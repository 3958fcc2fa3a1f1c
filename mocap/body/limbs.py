"""Legs and arms of a skeleton, and the role of each joint in a body.

Skeletons from different sources share few joint names, but have the same parts. A skeleton stores the roles
of its joints if they are given, or found by their motion when a file is read (`with_roles`). Otherwise legs,
arms and head are identified by the names that common files use, or else by the rest pose (`limb_search`). The
trunk is identified by the tree: the pelvis is the last common ancestor of the legs, the chest that of the
arms. The waist and the neck are the first joints above them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from textwrap import shorten
from typing import Literal

import numpy as np

from mocap.body.joint_trees import place_joints
from mocap.body.legs import SHORT, Leg, require_leg
from mocap.body.limb_pairs import LIMITS
from mocap.body.limb_search import find_limbs
from mocap.body.motion import Motion, require_motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, Remedy, shortened, warn

# Each surface names its own parameter: `roles=` of `mocap.load`, `--joints` of a command.
ROLES_BY_HAND = Remedy("name them by {} when the clip is read", "roles")


# Names of hip, knee and ankle on the left side. A prefix up to a colon is ignored.
LEGS_BY_NAME = (
    "lfemur ltibia lfoot",  # Acclaim, CMU
    "LeftUpLeg LeftLeg LeftFoot",
    "LeftHip LeftKnee LeftAnkle",
    "LeftThigh LeftShin LeftFoot",
    "UpperLeg_L LowerLeg_L Foot_L",
    "left_hip left_knee left_ankle",
    "LeftUpLeg LeftLowLeg LeftFoot",
    "LeftUpperLeg LeftLowerLeg LeftFoot",
    "lThigh lShin lFoot",  # Poser, Daz
    "L_Hip L_Knee L_Ankle",  # SMPL
)

# Names of shoulder, elbow and wrist on the left side.
ARMS_BY_NAME = (
    "lhumerus lradius lwrist",  # Acclaim, CMU
    "lhumerus lradius lhand",
    "LeftArm LeftForeArm LeftHand",
    "LeftShoulder LeftElbow LeftWrist",
    "UpperArm_L LowerArm_L Hand_L",
    "left_shoulder left_elbow left_wrist",
    "LeftUpArm LeftLowArm LeftHand",
    "LeftUpperArm LeftLowerArm LeftHand",
    "lShldr lForeArm lHand",  # Poser, Daz
    "L_Shoulder L_Elbow L_Wrist",  # SMPL
)

TRUNK = ("pelvis", "waist", "chest", "neck", "head")
LEG = ("hip", "knee", "ankle", "ball")
ARM = ("shoulder", "elbow", "wrist")
SIDES = ("left", "right")
FEET = tuple(f"{side} {part}" for side in SIDES for part in ("ankle", "ball"))
ROLES = (*TRUNK, *(f"{side} {part}" for side in SIDES for part in ("clavicle", *ARM, *LEG)))
"""The roles that a joint can have in a body, from "pelvis" to "right ball"."""
TIPS = tuple(f"{side} tip" for side in SIDES)
"""The ends of the toes: roles that a skeleton may carry, but that no bone of another body follows."""


def find_legs(skeleton: Skeleton) -> tuple[Leg, ...]:
    """Find the left and the right leg by the skeleton's roles, by names, or by the rest pose.

    By names, the ball is the ankle's first child.

    Raises
    ------
    MocapError : for skeletons in which no legs are found, and for roles that are no legs.

    Warns
    -----
    MocapWarning : if neither roles nor names identify the legs. A rest pose is less certain than a motion.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [SKELETON.names[joint] for joint in find_legs(SKELETON)[0]]
    ['lfemur', 'ltibia', 'lfoot', 'ltoes']

    Notebook: 04b-feet
    """
    joints = joints_of_limbs(skeleton)
    legs = []
    for side in SIDES:
        hip, knee, ankle = (joints[f"{side} {part}"] for part in LEG[:3])
        legs.append(Leg(hip, knee, ankle, joints.get(f"{side} ball", ankle)))
        require_leg(skeleton, legs[-1])
    return tuple(legs)


def joints_of_limbs(skeleton: Skeleton) -> dict[str, int]:
    """Find the joints of legs, arms and head by role; raise if there are no legs."""
    by_hand = {role: skeleton.index(name) for role, name in skeleton.roles.items()}
    if _has_legs(by_hand):
        return by_hand
    joints = _named_limbs(skeleton) | by_hand
    if _has_legs(joints):
        return joints
    at_rest, doubts = _limbs_at_rest(skeleton)
    if not at_rest:
        names = shorten(", ".join(skeleton.names), 60)
        problem = f"No legs found among {names} by name, nor at rest: {doubts[0]}."
        raise MocapError(problem, remedy=ROLES_BY_HAND)
    return at_rest | joints


def has_named_legs(skeleton: Skeleton) -> bool:
    """Return whether roles or known names identify the legs of a skeleton, so that no rest pose is searched.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> has_named_legs(SKELETON), has_named_legs(Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 1, 0]]))
    (True, False)
    """
    return has_leg_roles(skeleton) or bool(find_pair(skeleton, "legs"))


def has_leg_roles(skeleton: Skeleton) -> bool:
    """Return whether a skeleton stores the roles of both legs.

    Examples
    --------
    >>> has_leg_roles(Skeleton(["hip"], [-1], [[0, 0, 0]], roles={"left hip": "hip"}))
    False
    """
    return _has_legs(skeleton.roles)


def _has_legs(joints: Iterable[str]) -> bool:
    return {f"{side} {part}" for side in SIDES for part in LEG[:3]} <= set(joints)


def _named_limbs(skeleton: Skeleton) -> dict[str, int]:
    """Find limbs and head by their names."""
    joints: dict[str, int] = {}
    for side, leg in zip(SIDES, find_pair(skeleton, "legs"), strict=False):  # there may be none
        joints |= {f"{side} {part}": joint for part, joint in zip(LEG[:3], leg, strict=True)}
        toes = _toes(skeleton, leg[-1])
        if toes:
            joints[f"{side} ball"] = toes[0]
    for side, arm in zip(SIDES, find_pair(skeleton, "arms"), strict=False):
        joints |= {f"{side} {part}": joint for part, joint in zip(ARM, arm, strict=True)}
    names = [name.lower() for name in _without_prefixes(skeleton)]
    if "head" in names:
        joints["head"] = names.index("head")
    return joints


def _toes(skeleton: Skeleton, ankle: int) -> list[int]:
    """List the joints below an ankle, at a distance from it: one is the ball, another may be a heel."""
    return [toe for toe in skeleton.children(ankle) if np.linalg.norm(skeleton.offsets[toe]) > SHORT]


def _unclear_balls(skeleton: Skeleton, named: Mapping[str, int]) -> list[str]:
    """List the balls, by role, of feet in which they could be one of several joints."""
    sides = [side for side in SIDES if f"{side} ball" in named]
    return [f"{side} ball" for side in sides if len(_toes(skeleton, named[f"{side} ankle"])) > 1]


@lru_cache(maxsize=64)
def _limbs_at_rest(skeleton: Skeleton) -> tuple[dict[str, int], tuple[str, ...]]:
    """Find limbs by the rest pose, and warn of it once for each skeleton."""
    limbs = find_limbs(skeleton, skeleton.rest[None])
    joints = _without_trunk(limbs.roles)
    if joints:
        legs = ", ".join(f"'{skeleton.names[joints[f'left {part}']]}'" for part in LEG[:3])
        doubts = "; ".join([*limbs.doubts, "a motion shows more"])
        warn(f"{skeleton!r}: by its rest pose alone the left leg is {legs}; {doubts}.")
    return joints, limbs.doubts


def _without_trunk(joints: Mapping[str, int]) -> dict[str, int]:
    """Return the roles of limbs, neck and head: `_trunk` finds the others by the tree."""
    return {role: joint for role, joint in joints.items() if role not in ("pelvis", "chest")}


def with_roles(motion: Motion, roles: Mapping[str, str] | None = None) -> Motion:
    """Find the roles of a motion's joints, and give them to its skeleton.

    Limbs that have unknown names are found by their motion, with `limb_search.find_limbs`.

    Parameters
    ----------
    motion : F frames.
    roles : names of joints by role, such as {"left hip": "thigh_l"}; they replace those that are found. The
        roles are those of `ROLES`, and "left tip" and "right tip" for the ends of the toes. An empty name
        says that a limb has no such joint: a foot without toes has no ball.

    Returns
    -------
    The motion. If all limbs have known names, or roles, and no roles are given, it is the same.

    Raises
    ------
    MocapError : for unknown roles and joints.

    Warns
    -----
    MocapWarning : if the legs have unknown names and the motion leaves some roles in doubt.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = with_roles(sample("walk_straight"), {"left ball": "ltoes_end"})
    >>> walk.skeleton.roles["left ball"], walk.skeleton.roles["right ball"]
    ('ltoes_end', 'rtoes')
    """
    skeleton = require_motion(motion).skeleton
    by_hand = dict(roles or {})
    _check_roles(skeleton, by_hand)
    named = _named_limbs(skeleton)
    has_limbs = _has_legs(named) and f"{SIDES[0]} {ARM[0]}" in named
    is_known = has_limbs and not _unclear_balls(skeleton, named)
    if not by_hand and (is_known or _has_legs(skeleton.roles)):
        return motion
    joints = named if is_known or skeleton.roles else _limbs_in_motion(motion, named, by_hand)
    names = {role: skeleton.names[joint] for role, joint in joints.items()}
    names |= {**skeleton.roles, **by_hand}
    names = {role: name for role, name in names.items() if name}
    return replace(motion, skeleton=replace(skeleton, roles=names)) if names else motion


def _check_roles(skeleton: Skeleton, roles: Mapping[str, str]) -> None:
    """Raise for unknown roles and joints; an empty name is fine."""
    for role, name in roles.items():
        if role not in (*ROLES, *TIPS):
            parts = ", ".join([*TRUNK, *(f"left {part}" for part in ("clavicle", *ARM, *LEG, "tip"))])
            raise MocapError(f"No role '{shortened(role, 30)}'; there are {parts}, and those of the right.")
        if name:
            skeleton.index(name)


def _limbs_in_motion(motion: Motion, named: dict[str, int], by_hand: Mapping[str, str]) -> dict[str, int]:
    """Find limbs by their motion; those with known names keep them."""
    skeleton = motion.skeleton
    frames = np.linspace(0, len(motion) - 1, min(len(motion), LIMITS.frames)).astype(int)
    roots = motion.root_positions[frames]
    positions = place_joints(skeleton, roots, motion.rotations[frames]).positions
    limbs = find_limbs(skeleton, positions)
    joints = _without_trunk(limbs.roles)
    if joints.get("left hip") == named.get("right hip", -1):  # names count more than the motion
        joints = {other_side(role): joint for role, joint in joints.items()}
    if joints and limbs.doubts and not _has_legs(named) and not _has_legs(by_hand):
        correct = "`mocap info FILE --joints` prints the roles of the joints, to be corrected"
        warn(f"'{shortened(motion.name, 60)}': limbs are unsure: {'; '.join(limbs.doubts)}; {correct}.")
    clear = dict(named)
    if joints.get("left ankle") == named.get("left ankle"):
        for role in _unclear_balls(skeleton, named):
            clear.pop(role)
    return named | joints | clear


def other_side(role: str) -> str:
    """Return the role of the mirror image, such as "right knee" for "left knee"."""
    side, _, part = role.partition(" ")
    return f"{SIDES[1 - SIDES.index(side)]} {part}" if side in SIDES else role


def find_pair(skeleton: Skeleton, limbs: Literal["legs", "arms"]) -> list[list[int]]:
    """Find the three joints of the left limb and of its mirror image on the right; [] for unknown names.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [[SKELETON.names[joint] for joint in arm] for arm in find_pair(SKELETON, "arms")]
    [['lhumerus', 'lradius', 'lwrist'], ['rhumerus', 'rradius', 'rwrist']]
    """
    names = _without_prefixes(skeleton)
    for limb in LEGS_BY_NAME if limbs == "legs" else ARMS_BY_NAME:
        joints = [names.index(name) for name in limb.split() if name in names]
        partners = [skeleton.partner(joint) for joint in joints]
        if len(joints) == len(limb.split()) and not set(joints) & set(partners):
            return [joints, partners]
    return []


def _without_prefixes(skeleton: Skeleton) -> list[str]:
    """List the joints' names without a prefix up to a colon, as in "mixamorig:LeftArm"."""
    return [name.rsplit(":", 1)[-1] for name in skeleton.names]


def roles(skeleton: Skeleton) -> dict[str, int]:
    """Find the role of each joint in a body.

    Parameters
    ----------
    skeleton : J joints.

    Returns
    -------
    {role: joint}. Hips, knees, ankles and balls are always included, other roles only if the body has them.

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
    joints = joints_of_limbs(skeleton)
    for side, leg in zip(SIDES, find_legs(skeleton), strict=True):
        joints |= {f"{side} {part}": joint for part, joint in zip(LEG, leg, strict=True)}
    joints = _trunk(skeleton, joints) | joints
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
    above_left = set(ancestors.get(f"left {part}", ()))
    above_right = set(ancestors.get(f"right {part}", ()))
    return max(above_left & above_right, default=0)


def _child_towards(joint: int, path: list[int]) -> int:
    """Return the child of `joint` on a path to the root."""
    return path[path.index(joint) - 1]
