"""What a skeleton refuses, how it finds its sides, and legs by the names of many."""

import numpy as np
import pytest

from mocap.body.legs import name_leg
from mocap.body.limbs import find_legs, roles
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import SKELETON
from mocap.errors import SkeletonMismatch
from tests.refusals import refusals

ZEROS = np.zeros((2, 3))


test_a_bad_skeleton_is_refused = refusals(
    ("at least one joint", Skeleton, [], [], np.zeros((0, 3))),
    ("given twice: a", Skeleton, ["a", "a"], [-1, 0], ZEROS),
    (r"got \(3,\) and \(2, 3\)", Skeleton, ["a", "b"], [-1, 0, 1], ZEROS),
    ("no other, is the root", Skeleton, ["a", "b"], [-1, -1], ZEROS),
    ("no other, is the root", Skeleton, ["a", "b"], [0, 0], ZEROS),
    ("'b' stands before its parent", Skeleton, ["a", "b"], [-1, 1], ZEROS),
    ("'b' is not a finite", Skeleton, ["a", "b"], [-1, 0], [[0, 0, 0], [0, np.nan, 0]]),
    (r"axes \(2, 4\) of length 1", Skeleton, ["a", "b"], [-1, 0], ZEROS, np.ones((2, 4))),
    (r"axes \(2, 4\) of length 1, got \(1, 4\)", Skeleton, ["a", "b"], [-1, 0], ZEROS, np.eye(4)[:1]),
    ("'a' needs dofs such as .*got 'xx'", Skeleton, ["a", "b"], [-1, 0], ZEROS, np.eye(4)[:2], ["xx", ""]),
    ("2 joints need as many dofs, got 1", Skeleton, ["a", "b"], [-1, 0], ZEROS, np.eye(4)[:2], ["x"]),
    ("No joint 'c'; there are: a, b", Skeleton(["a", "b"], [-1, 0], ZEROS).index, "c"),
)


def test_arrays_are_copies_that_nobody_writes_to():
    offsets = np.zeros((2, 3))
    body = Skeleton(["a", "b"], [-1, 0], offsets)
    offsets[1] = 7
    assert body.offsets[1].tolist() == [0, 0, 0]
    with pytest.raises(ValueError, match="read-only"):
        body.offsets[0] = 1


def test_joints_turn_about_unturned_axes_unless_told_otherwise():
    body = Skeleton(["a", "b"], [-1, 0], ZEROS)
    assert body.axes.tolist() == [[1, 0, 0, 0]] * 2
    assert body.dofs == ("xyz", "")


SIDES = [
    (["root", "lowerback", "lfemur", "rfemur"], ["middle", "middle", "left", "right"]),
    (["Hips", "LeftUpLeg", "RightUpLeg"], ["middle", "left", "right"]),
    (["spine", "Shoulder_R", "Shoulder_L"], ["middle", "right", "left"]),
    (["pelvis", "foot_l", "foot_r"], ["middle", "left", "right"]),
    (["lowerneck", "ltoes"], ["middle", "middle"]),
]


@pytest.mark.parametrize(("names", "sides"), SIDES)
def test_sides_are_read_off_the_names(names, sides):
    body = Skeleton(names, [-1, *[0] * (len(names) - 1)], np.zeros((len(names), 3)))
    assert [body.side(j) for j in range(len(names))] == sides


def three(names="abc", parents=(-1, 0, 1), end=0.0):
    return Skeleton([*names], parents, np.outer([0, 0, end], [0, 1, 0]))


def test_the_same_is_no_mismatch():
    three().require_same(three())


def test_offsets_that_differ_by_the_rounding_of_a_file_are_the_same():
    three(end=0.1).require_same(three(end=0.10002))
    with pytest.raises(SkeletonMismatch, match="sits"):
        three(end=0.1).require_same(three(end=0.1002))


test_mismatches_are_named = refusals(
    (SkeletonMismatch, "these joints: b, d", three().require_same, three("adc")),
    (SkeletonMismatch, "another order or tree", three().require_same, three(parents=(-1, 0, 0))),
    (SkeletonMismatch, "'c' sits 5 cm apart", three().require_same, three(end=0.05)),
)


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


def test_a_foot_without_toes_has_its_ball_at_the_ankle():
    left, right = find_legs(FOOTLESS)
    assert (tuple(left), tuple(right)) == ((1, 2, 3, 3), (4, 5, 6, 6))
    assert not left.has_ball
    assert left.lengths(FOOTLESS)[2] == 0


def test_legs_can_be_named_by_hand():
    assert tuple(name_leg(NAMED, "h2", "k2", "a2", "b2")) == (5, 6, 7, 8)


FLAT = Skeleton(["h", "k", "a", "b"], [-1, 0, 1, 2], [[0, 0, 0], [0, -1, 0], [0, -1, 0], [0, 0, 0]])

test_what_is_no_leg_is_told_with_what_was_tried = refusals(
    (
        r"among pelvis, a, b by name, nor at rest: no two limbs .*: name them by roles= when",
        find_legs,
        body("a", "b"),
    ),
    ("No legs found.*roles=", roles, body("a", "b")),
    ("No joint 'toe'", name_leg, NAMED, "h1", "k1", "a1", "toe"),
    ("'a2' hangs on 'k2', not on 'k1'", name_leg, NAMED, "h1", "k1", "a2", "b2"),
    ("'b' sits on 'a': a bone needs a length", name_leg, FLAT, "h", "k", "a", "b"),
)
