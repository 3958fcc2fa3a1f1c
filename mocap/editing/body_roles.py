"""Which joint of a body does what? Two skeletons have few names in common, but the same parts.

Legs, arms and head are found by the names that files use. The trunk is found by the tree: the pelvis is where
the legs meet, the chest is where the arms meet, and the waist and the neck are the first joints above them.
"""

from collections.abc import Mapping, Sequence
from textwrap import shorten

from mocap.body.limbs import Leg, find_legs, name_leg
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

TRUNK = ("pelvis", "waist", "chest", "neck", "head")
LIMBS = ("clavicle", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "ball")
LEG = ("hip", "knee", "ankle", "ball")
FEET = tuple(f"{side} {part}" for side in ("left", "right") for part in ("ankle", "ball"))
ROLES = (*TRUNK, *(f"{side} {part}" for side in ("left", "right") for part in LIMBS))
"""What a joint can be to a body: from "pelvis" to "right ball"."""

# Shoulder, elbow and wrist of a left and a right arm, as files name them; a prefix up to a colon is ignored.
_ARMS = (
    ("lhumerus lradius lwrist", "rhumerus rradius rwrist"),  # Acclaim, CMU
    ("lhumerus lradius lhand", "rhumerus rradius rhand"),
    ("LeftArm LeftForeArm LeftHand", "RightArm RightForeArm RightHand"),
    ("LeftShoulder LeftElbow LeftWrist", "RightShoulder RightElbow RightWrist"),
    ("UpperArm_L LowerArm_L Hand_L", "UpperArm_R LowerArm_R Hand_R"),
    ("left_shoulder left_elbow left_wrist", "right_shoulder right_elbow right_wrist"),
    ("LeftUpArm LeftLowArm LeftHand", "RightUpArm RightLowArm RightHand"),
    ("LeftUpperArm LeftLowerArm LeftHand", "RightUpperArm RightLowerArm RightHand"),
    ("lShldr lForeArm lHand", "rShldr rForeArm rHand"),  # Poser, Daz
    ("L_Shoulder L_Elbow L_Wrist", "R_Shoulder R_Elbow R_Wrist"),  # SMPL
)


def roles(skeleton: Skeleton, told: Mapping[str, str] | None = None) -> dict[str, int]:
    """Find which joint plays which role in a body.

    Parameters
    ----------
    skeleton : J joints.
    told : {role: joint's name} for joints that go before those found by name; the roles are `ROLES`.

    Returns
    -------
    {role: joint}. Roles that the body lacks are left out; hips, knees, ankles and balls are always there.

    Raises
    ------
    MocapError : for a role or a joint that does not exist, two roles of one joint, and legs that neither the
        names nor `told` give.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> found = roles(SKELETON)
    >>> [SKELETON.names[found[role]] for role in ("pelvis", "waist", "chest", "neck", "left wrist")]
    ['root', 'lowerback', 'thorax', 'lowerneck', 'lwrist']

    Notebook: 13-retargeting
    """
    told = dict(told or {})
    if unknown := [role for role in told if role not in ROLES]:
        raise MocapError(f"No role '{unknown[0]}'; there are: {shorten(', '.join(ROLES), 150)}.")
    found = {role: skeleton.index(name) for role, name in told.items()}
    found = _legs(skeleton, told) | _arms(skeleton) | _head(skeleton) | found
    found = _trunk(skeleton, found) | found
    joints = list(found.values())
    if twice := [role for role, joint in found.items() if joints.count(joint) > 1]:
        name = skeleton.names[found[twice[0]]]
        raise MocapError(f"Joint '{name}' would be both {twice[0]} and {twice[1]}: name them by told=.")
    return {role: found[role] for role in ROLES if role in found}


def legs_among(who: Mapping[str, int]) -> tuple[Leg, Leg]:
    """Give the left and the right leg among roles.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> legs_among(roles(SKELETON))[0]
    Leg(hip=2, knee=3, ankle=4, ball=5)
    """
    left, right = (Leg(*(who[f"{side} {part}"] for part in LEG)) for side in ("left", "right"))
    return left, right


def _legs(skeleton: Skeleton, told: Mapping[str, str]) -> dict[str, int]:
    """Find both legs by name, or take those that are told whole."""
    sides = {side: [f"{side} {part}" for part in LEG] for side in ("left", "right")}
    if all(role in told for asked in sides.values() for role in asked):
        legs = [name_leg(skeleton, *(told[role] for role in asked)) for asked in sides.values()]
    else:
        try:
            legs = list(find_legs(skeleton))
        except MocapError as error:
            tried = str(error).split(" Name each")[0]
            raise MocapError(f'{tried} Name them: told={{"left hip": "...", ...}}.') from None
    pairs = zip(sides.values(), legs, strict=True)
    return {role: joint for asked, leg in pairs for role, joint in zip(asked, leg, strict=True)}


def _plain(skeleton: Skeleton) -> list[str]:
    return [name.rsplit(":", 1)[-1] for name in skeleton.names]


def _arms(skeleton: Skeleton) -> dict[str, int]:
    """Find both arms by name; a body may have none."""
    plain = _plain(skeleton)
    for pair in _ARMS:
        if all(name in plain for side in pair for name in side.split()):
            return {
                f"{side} {part}": plain.index(name)
                for side, names in zip(("left", "right"), pair, strict=True)
                for part, name in zip(("shoulder", "elbow", "wrist"), names.split(), strict=True)
            }
    return {}


def _head(skeleton: Skeleton) -> dict[str, int]:
    lower = [name.lower() for name in _plain(skeleton)]
    return {"head": lower.index("head")} if "head" in lower else {}


def _trunk(skeleton: Skeleton, limbs: Mapping[str, int]) -> dict[str, int]:
    """Find the trunk by the tree: what the limbs and the head hang on."""
    pelvis = _meeting(skeleton, [limbs[f"{side} hip"] for side in ("left", "right")])
    trunk = {"pelvis": pelvis}
    shoulders = [limbs[f"{side} shoulder"] for side in ("left", "right") if f"{side} shoulder" in limbs]
    if len(shoulders) == 2 and (chest := _meeting(skeleton, shoulders)) != pelvis:
        trunk["chest"] = chest
        trunk |= {"waist": way[0]} if len(way := _way(skeleton, pelvis, chest)) > 1 else {}
        for side in ("left", "right"):
            way = _way(skeleton, chest, limbs[f"{side} shoulder"])
            trunk |= {f"{side} clavicle": way[0]} if len(way) > 1 else {}
        if "head" in limbs and len(way := _way(skeleton, chest, limbs["head"])) > 1:
            trunk["neck"] = way[0]
    return trunk


def _meeting(skeleton: Skeleton, joints: Sequence[int]) -> int:
    """Find the nearest joint above all of some joints."""
    lines = [skeleton.path_to_root(joint)[1:] for joint in joints]
    return max(set(lines[0]).intersection(*lines[1:]), default=0)


def _way(skeleton: Skeleton, above: int, joint: int) -> list[int]:
    """List the joints from below `above` down to `joint`, or none where `joint` does not hang on it."""
    line = skeleton.path_to_root(joint)
    return line[: line.index(above)][::-1] if above in line else []
