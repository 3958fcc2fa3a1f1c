"""Which joint of a body does what? Two skeletons have few names in common, but the same parts.

Legs, arms and head are found by the names that files use. The trunk is found by the tree: the pelvis is where
the legs meet, the chest is where the arms meet, and the waist and the neck are the first joints above them.
"""

from collections.abc import Mapping

from mocap.body.limbs import Leg, find_legs, find_pair
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

TRUNK = ("pelvis", "waist", "chest", "neck", "head")
LEG = ("hip", "knee", "ankle", "ball")
ARM = ("shoulder", "elbow", "wrist")
LIMBS = ("clavicle", *ARM, *LEG)
SIDES = ("left", "right")
FEET = tuple(f"{side} {part}" for side in SIDES for part in ("ankle", "ball"))
ROLES = (*TRUNK, *(f"{side} {part}" for side in SIDES for part in LIMBS))
"""What a joint can be to a body: from "pelvis" to "right ball"."""


def roles(skeleton: Skeleton) -> dict[str, int]:
    """Find which joint plays which role in a body.

    Parameters
    ----------
    skeleton : J joints.

    Returns
    -------
    {role: joint}. Roles that the body lacks are left out; hips, knees, ankles and balls are always there.

    Raises
    ------
    MocapError : for legs that are not found.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> found = roles(SKELETON)
    >>> [SKELETON.names[found[role]] for role in ("pelvis", "waist", "chest", "neck", "left wrist")]
    ['root', 'lowerback', 'thorax', 'lowerneck', 'lwrist']

    Notebook: 13-retargeting
    """
    try:
        limbs = zip(SIDES * 2, [*find_legs(skeleton), *find_pair(skeleton, "arms")], strict=False)
    except MocapError as error:
        raise MocapError(f"{str(error).split(' Name each')[0]} Rename the joints.") from None
    found: dict[str, int] = {}
    for side, joints in limbs:
        parts = LEG if isinstance(joints, Leg) else ARM
        found |= {f"{side} {part}": joint for part, joint in zip(parts, joints, strict=True)}
    names = [name.rsplit(":", 1)[-1].lower() for name in skeleton.names]
    heads = [joint for joint, name in enumerate(names) if name == "head"]
    found |= {"head": heads[0]} if heads else {}
    found |= _trunk(skeleton, found)
    return {role: found[role] for role in ROLES if role in found}


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
