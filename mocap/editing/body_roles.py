"""Which joint of a body does what? Two skeletons have few names in common, but the same parts.

Legs, arms and head are found by the names that files use. The trunk is found by the tree: the pelvis is where
the legs meet, the chest is where the arms meet, and the waist and the neck are the first joints above them.
"""

from collections.abc import Mapping
from textwrap import shorten

from mocap.body.limbs import Leg, find_legs, name_leg
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

TRUNK = ("pelvis", "waist", "chest", "neck", "head")
LEG = ("hip", "knee", "ankle", "ball")
LIMBS = ("clavicle", "shoulder", "elbow", "wrist", *LEG)
SIDES = ("left", "right")
FEET = tuple(f"{side} {part}" for side in SIDES for part in ("ankle", "ball"))
ROLES = (*TRUNK, *(f"{side} {part}" for side in SIDES for part in LIMBS))
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
    given = {role: skeleton.index(name) for role, name in told.items()}
    found = _named(skeleton, known_legs=all(f"{side} {part}" in given for side in SIDES for part in LEG))
    found |= given
    found = _trunk(skeleton, found) | found
    for leg in legs_among(found):
        name_leg(skeleton, *(skeleton.names[joint] for joint in leg))
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
    left, right = (Leg(*(who[f"{side} {part}"] for part in LEG)) for side in SIDES)
    return left, right


def _named(skeleton: Skeleton, *, known_legs: bool) -> dict[str, int]:
    """Find legs, arms and head by their names; only the legs must be there, unless they are told."""
    plain = [name.rsplit(":", 1)[-1] for name in skeleton.names]
    found = {}
    if not known_legs:
        try:
            legs = find_legs(skeleton)
        except MocapError as error:
            tried = str(error).split(" Name each")[0]
            raise MocapError(f'{tried} Name them: told={{"left hip": "...", ...}}.') from None
        for side, leg in zip(SIDES, legs, strict=True):
            found |= {f"{side} {part}": joint for part, joint in zip(LEG, leg, strict=True)}
    arms = next((pair for pair in _ARMS if set(" ".join(pair).split()) <= set(plain)), ())
    for side, arm in zip(SIDES, arms, strict=False):
        names = zip(("shoulder", "elbow", "wrist"), arm.split(), strict=True)
        found |= {f"{side} {part}": plain.index(name) for part, name in names}
    heads = [joint for joint, name in enumerate(plain) if name.lower() == "head"]
    return found | ({"head": heads[0]} if heads else {})


def _trunk(skeleton: Skeleton, limbs: Mapping[str, int]) -> dict[str, int]:
    """Find the trunk by the tree: what the limbs and the head hang on."""
    up = {role: skeleton.path_to_root(joint)[1:] for role, joint in limbs.items()}
    pelvis, chest = (
        max(set(up.get(f"left {part}", ())) & set(up.get(f"right {part}", ())), default=0)
        for part in ("hip", "shoulder")
    )
    if pelvis not in (above := skeleton.path_to_root(chest)[1:]):  # no arms, or they hang on the pelvis
        return {"pelvis": pelvis}
    trunk = {"pelvis": pelvis, "chest": chest}
    # The first joint on the way from the chest to a limb, and from the pelvis to the chest.
    ways = {"neck": up.get("head", []), **{f"{side} clavicle": up[f"{side} shoulder"] for side in SIDES}}
    trunk |= {role: way[way.index(chest) - 1] for role, way in ways.items() if chest in way[1:]}
    return trunk | ({"waist": above[above.index(pelvis) - 1]} if above[0] != pelvis else {})
