"""Which joints are the legs? And which joint of a body does what.

Two skeletons have few names in common, but the same parts. Legs, arms and head are found by the names that
files use, or legs are named by hand. The trunk is found by the tree: the pelvis is where the legs meet, the
chest is where the arms meet, and the waist and the neck are the first joints above them.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from textwrap import shorten
from typing import Literal, NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, Remedy

# Hip, knee, ankle and shoulder, elbow, wrist of the left side, as files name them; each column is looked up
# by itself, and a prefix up to a colon is ignored.
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
"""What a joint can be to a body: from "pelvis" to "right ball"."""


class Leg(NamedTuple):
    """One leg's joints, as indices into a skeleton, each the parent of the next.

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
        """Give the lengths of thigh, shank and foot (ankle to ball), shape (3,), metres."""
        return np.asarray(np.linalg.norm(skeleton.offsets[list(self[1:])], axis=-1))


def find_legs(skeleton: Skeleton) -> tuple[Leg, ...]:
    """Find the left and the right leg by their joints' names; the ball is the ankle's first child.

    Raises
    ------
    MocapError : if no known names are there; then name the joints by hand with `name_leg`.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [SKELETON.names[joint] for joint in find_legs(SKELETON)[0]]
    ['lfemur', 'ltibia', 'lfoot', 'ltoes']

    Notebook: 04b-feet
    """
    legs = find_pair(skeleton, "legs")
    if bare := [ankle for *_, ankle in legs if not skeleton.children(ankle)]:
        name = skeleton.names[bare[0]]
        raise MocapError(f"The foot '{name}' has no joint or end site that could be its ball.")
    if not legs:
        joints = shorten(", ".join(skeleton.names), 38)
        candidates = shorten(", ".join(dict(LIMBS)), 40)
        problem = f"No legs found among {joints}: tried {candidates}."
        by_hand = "name each by hand, {}[name_leg(skeleton, hip, knee, ankle, ball), ...]"
        raise MocapError(problem, remedy=Remedy(by_hand, "legs"))
    whole = [[*joints, skeleton.children(joints[2])[0]] for joints in legs]
    return tuple(name_leg(skeleton, *(skeleton.names[joint] for joint in leg)) for leg in whole)


def find_pair(skeleton: Skeleton, limbs: Literal["legs", "arms"]) -> list[list[int]]:
    """Find the three joints of the left limb and of the right one, its mirror image; [] where none are known.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [[SKELETON.names[joint] for joint in arm] for arm in find_pair(SKELETON, "arms")]
    [['lhumerus', 'lradius', 'lwrist'], ['rhumerus', 'rradius', 'rwrist']]
    """
    plain = [name.rsplit(":", 1)[-1] for name in skeleton.names]
    for names in (row[limbs == "arms"].split() for row in LIMBS):
        left = [plain.index(name) for name in names if name in plain]
        right = [skeleton.partner(joint) for joint in left]
        if len(left) == 3 and not set(left) & set(right):
            return [left, right]
    return []


def name_leg(skeleton: Skeleton, hip: str, knee: str, ankle: str, ball: str) -> Leg:
    """Make a leg out of the names of its joints.

    Raises
    ------
    MocapError : for names that the skeleton lacks, a joint that is not the parent of the next one, and
        bones without a length.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> name_leg(SKELETON, "lfemur", "ltibia", "lfoot", "ltoes")
    Leg(hip=2, knee=3, ankle=4, ball=5)
    """
    leg = Leg(*(skeleton.index(name) for name in (hip, knee, ankle, ball)))
    names = skeleton.names
    for above, below in pairwise(leg):
        if skeleton.parents[below] != above:
            hangs = f"'{names[below]}' hangs on '{names[skeleton.parents[below]]}', not on '{names[above]}'"
            raise MocapError(f"In a leg each joint hangs on the one before, but {hangs}.")
        if not np.linalg.norm(skeleton.offsets[below]) > 1e-6:
            raise MocapError(f"'{names[below]}' sits on '{names[above]}': a bone needs a length.")
    return leg


def heading_by_hips(positions: Array, legs: Sequence[Leg]) -> Array:
    """Read where a body heads, square to the line of its hips, from positions (F, J, 3); radians (F,).

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
        raise MocapError(f"{error.problem()} Rename the joints.") from None
    joint_of: dict[str, int] = {}
    for side, joints in limbs:
        parts = LEG if isinstance(joints, Leg) else ARM
        joint_of |= {f"{side} {part}": joint for part, joint in zip(parts, joints, strict=True)}
    names = [name.rsplit(":", 1)[-1].lower() for name in skeleton.names]
    heads = [joint for joint, name in enumerate(names) if name == "head"]
    joint_of |= {"head": heads[0]} if heads else {}
    joint_of |= _trunk(skeleton, joint_of)
    return {role: joint_of[role] for role in ROLES if role in joint_of}


def _trunk(skeleton: Skeleton, limbs: Mapping[str, int]) -> dict[str, int]:
    """Find the trunk by the tree: what the limbs and the head hang on."""
    ancestors = {role: skeleton.path_to_root(joint)[1:] for role, joint in limbs.items()}

    def fork(part: str) -> int:
        """Return the joint at which the paths from both sides to the root meet."""
        left, right = (set(ancestors.get(f"{side} {part}", ())) for side in SIDES)
        return max(left & right, default=0)

    pelvis = fork("hip")
    chest = fork("shoulder")
    spine = skeleton.path_to_root(chest)[1:]
    if pelvis not in spine:  # no arms, or they hang on the pelvis
        return {"pelvis": pelvis}
    trunk = {"pelvis": pelvis, "chest": chest}
    # The first joint on the path from the chest to a limb, and from the pelvis to the chest.
    paths = {"neck": ancestors.get("head", [])}
    paths |= {f"{side} clavicle": ancestors[f"{side} shoulder"] for side in SIDES}
    for role, path in paths.items():
        if chest in path[1:]:
            trunk[role] = path[path.index(chest) - 1]
    if spine[0] != pelvis:
        trunk["waist"] = spine[spine.index(pelvis) - 1]
    return trunk
