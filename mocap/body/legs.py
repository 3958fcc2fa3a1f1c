"""A leg: its joints, the lengths of its bones, and the heading that both hips show."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

SHORT = 1e-6  # metres: a bone of this length or less has no direction


class Leg(NamedTuple):
    """The joints of a leg, as indices into a skeleton, each below the one before.

    A foot without toes has no joint at its ball. Its `ball` is then the ankle, and its length is 0.

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
        bones = np.linalg.norm(skeleton.offsets, axis=-1)
        lengths = []
        for above, joint in pairwise(self):
            path = skeleton.path_to_root(joint)
            between = path[: path.index(above)]  # more than one bone in a thigh that is split
            lengths.append(sum(bones[between]))
        return np.array(lengths, float)

    @property
    def has_ball(self) -> bool:
        """Whether the foot has a joint ahead of its ankle."""
        return self.ball != self.ankle


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
    require_leg(skeleton, leg)
    return leg


def require_leg(skeleton: Skeleton, leg: Leg) -> None:
    """Raise unless each joint of a leg hangs on the one before, at a distance; a ball may be the ankle."""
    names = skeleton.names
    for above, below in pairwise(leg if leg.has_ball else leg[:3]):
        if above not in skeleton.path_to_root(below)[1:]:
            hangs = f"'{names[below]}' hangs on '{names[skeleton.parents[below]]}', not on '{names[above]}'"
            raise MocapError(f"In a leg each joint hangs on the one before, but {hangs}.")
    for below, length in zip(leg[1:], leg.lengths(skeleton), strict=True):
        if not length > SHORT and (below != leg.ball or leg.has_ball):
            above = leg[leg.index(below) - 1]
            raise MocapError(f"'{names[below]}' sits on '{names[above]}': a bone needs a length.")


def heading_by_hips(positions: Array, legs: Sequence[Leg]) -> Array:
    """Compute the heading perpendicular to the line of the hips, from positions (F, J, 3); radians (F,).

    Examples
    --------
    >>> legs = [Leg(0, 2, 3, 4), Leg(1, 5, 6, 7)]
    >>> heading_by_hips(np.array([[[0.0, 1, 0.1], [0, 1, -0.1]]]), legs).round(4)
    array([-1.5708])
    """
    left_hips, right_hips = (positions[:, leg.hip] for leg in legs)
    across = left_hips - right_hips
    return np.asarray(np.arctan2(-across[:, 2], across[:, 0]))
