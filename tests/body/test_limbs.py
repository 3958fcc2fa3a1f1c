"""Legs are found by the names of many skeletons, and where they are not, the error says what would help."""

import numpy as np
import pytest

from mocap.body.limbs import find_legs, name_leg
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import SKELETON
from tests.refusals import refusals


def body(*names: str) -> Skeleton:
    """Return two legs of as many joints as names a leg, which all hang on a pelvis."""
    half = len(names) // 2
    parents = [-1] + [0 if j % half == 0 else j for j in range(len(names))]
    return Skeleton(["pelvis", *names], parents, np.ones((len(names) + 1, 3)))


NAMED = body("h1", "k1", "a1", "b1", "h2", "k2", "a2", "b2")


FOOTLESS = body("lfemur", "ltibia", "lfoot", "rfemur", "rtibia", "rfoot")


LEGS = [
    "lfemur ltibia lfoot ltoes rfemur rtibia rfoot rtoes",
    "LeftUpLeg LeftLeg LeftFoot LeftToeBase RightUpLeg RightLeg RightFoot RightToeBase",
    "LeftHip LeftKnee LeftAnkle LeftAnkle_end RightHip RightKnee RightAnkle RightAnkle_end",
    "UpperLeg_L LowerLeg_L Foot_L Toes_L UpperLeg_R LowerLeg_R Foot_R Toes_R",
    "a:LeftUpLeg a:LeftLeg a:LeftFoot a:LeftToeBase a:RightUpLeg a:RightLeg a:RightFoot a:RightToeBase",
]


@pytest.mark.parametrize("names", LEGS)
def test_legs_are_found_by_their_names(names):
    skeleton = body(*names.split())
    left, right = find_legs(skeleton)
    assert tuple(left) == (1, 2, 3, 4)
    assert tuple(right) == (5, 6, 7, 8)


def test_the_legs_of_the_bundled_body_are_as_long_as_they_are():
    for leg in find_legs(SKELETON):
        assert leg.lengths(SKELETON) == pytest.approx([0.245 * 1.75, 0.246 * 1.75, 0.1368], abs=1e-3)


def test_legs_can_be_named_by_hand():
    assert tuple(name_leg(NAMED, "h2", "k2", "a2", "b2")) == (5, 6, 7, 8)


FLAT = Skeleton(["h", "k", "a", "b"], [-1, 0, 1, 2], [[0, 0, 0], [0, -1, 0], [0, -1, 0], [0, 0, 0]])

test_what_is_no_leg_is_told_with_what_was_tried = refusals(
    (r"among pelvis, a, b: tried lfemur ltibia lfoot, Left.*name_leg\(", find_legs, body("a", "b")),
    ("'lfoot' has no joint or end site", find_legs, FOOTLESS),
    ("No joint 'toe'", name_leg, NAMED, "h1", "k1", "a1", "toe"),
    ("'a2' hangs on 'k2', not on 'k1'", name_leg, NAMED, "h1", "k1", "a2", "b2"),
    ("'b' sits on 'a': a bone needs a length", name_leg, FLAT, "h", "k", "a", "b"),
)
