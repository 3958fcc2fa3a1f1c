"""Which joints are the legs? Found by the names that common skeletons use, or named by hand."""

from collections.abc import Sequence
from itertools import pairwise
from textwrap import shorten
from typing import Literal, NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

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
        joints, known = (", ".join(names) for names in (skeleton.names, dict(LIMBS)))
        helps = "Name each by hand: legs=[name_leg(skeleton, hip, knee, ankle, ball), ...]."
        raise MocapError(f"No legs found among {shorten(joints, 38)}: tried {shorten(known, 40)}. {helps}")
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
    leg, names = Leg(*(skeleton.index(name) for name in (hip, knee, ankle, ball))), skeleton.names
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
