"""Which joints are the legs? Found by the names that common skeletons give them, or told by hand."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

# Hip, knee and ankle of a left and a right leg, as files name them; what stands before a colon is left out.
_NAMES = (
    ("lfemur ltibia lfoot", "rfemur rtibia rfoot"),  # Acclaim, CMU
    ("LeftUpLeg LeftLeg LeftFoot", "RightUpLeg RightLeg RightFoot"),
    ("LeftHip LeftKnee LeftAnkle", "RightHip RightKnee RightAnkle"),
    ("LeftThigh LeftShin LeftFoot", "RightThigh RightShin RightFoot"),
    ("UpperLeg_L LowerLeg_L Foot_L", "UpperLeg_R LowerLeg_R Foot_R"),
    ("left_hip left_knee left_ankle", "right_hip right_knee right_ankle"),
)


class Leg(NamedTuple):
    """One leg's joints, as indices into a skeleton, each the parent of the next."""

    hip: int
    knee: int
    ankle: int
    ball: int

    def lengths(self, skeleton: Skeleton) -> Array:
        """Give the lengths of thigh, shank and foot (ankle to ball), shape (3,), metres."""
        return np.asarray(np.linalg.norm(skeleton.offsets[list(self[1:])], axis=-1))


def find_legs(skeleton: Skeleton) -> tuple[Leg, ...]:
    """Find the left and the right leg by their joints' names; the ball is what first hangs on the ankle.

    Raises
    ------
    MocapError : where no names fit, with those that were tried; `name_leg` tells them by hand.

    Examples
    --------
    >>> from mocap.datasets.generated import SKELETON
    >>> [SKELETON.names[joint] for joint in find_legs(SKELETON)[0]]
    ['lfemur', 'ltibia', 'lfoot', 'ltoes']

    Notebook: 04-blending
    """
    plain = [name.rsplit(":", 1)[-1] for name in skeleton.names]
    for pair in _NAMES:
        if all(name in plain for side in pair for name in side.split()):
            return tuple(_complete(skeleton, [plain.index(name) for name in side.split()]) for side in pair)
    tried = ", ".join("-".join(left.split()) for left, _ in _NAMES)
    raise MocapError(
        f"No legs found among {', '.join(skeleton.names)}: tried {tried}, and the right ones alike. Name "
        "each by hand: legs=[name_leg(skeleton, hip, knee, ankle, ball), ...]."
    )


def name_leg(skeleton: Skeleton, hip: str, knee: str, ankle: str, ball: str) -> Leg:
    """Tell by their names which joints are a leg.

    Raises
    ------
    MocapError : for names that the skeleton lacks, joints of which one is not the parent of the next, and
        bones without a length.
    """
    leg = Leg(*(skeleton.index(name) for name in (hip, knee, ankle, ball)))
    for above, below in pairwise(leg):
        if skeleton.parents[below] != above:
            names = skeleton.names
            raise MocapError(
                f"In a leg each joint hangs on the one before, but '{names[below]}' hangs on "
                f"'{names[skeleton.parents[below]]}', not on '{names[above]}'."
            )
        if not np.linalg.norm(skeleton.offsets[below]) > 1e-6:
            raise MocapError(
                f"'{skeleton.names[below]}' sits on '{skeleton.names[above]}': a bone needs a length."
            )
    return leg


def _complete(skeleton: Skeleton, joints: list[int]) -> Leg:
    """Add the ball, what first hangs on the ankle, to hip, knee and ankle."""
    hip, knee, ankle = (skeleton.names[joint] for joint in joints)
    children = skeleton.children(joints[2])
    if not children:
        raise MocapError(f"The foot '{ankle}' has no joint or end site that could be its ball.")
    return name_leg(skeleton, hip, knee, ankle, skeleton.names[children[0]])


def legs_of(skeleton: Skeleton, legs: Sequence[Leg] | None) -> Sequence[Leg]:
    """Take the legs that were told, or find them."""
    return find_legs(skeleton) if legs is None else legs
