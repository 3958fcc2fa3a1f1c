"""What a skeleton refuses, and how it finds its sides."""

import numpy as np
import pytest

from mocap.body.skeleton import Skeleton
from mocap.errors import SkeletonMismatch
from tests.refusals import refused

ZEROS = np.zeros((2, 3))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([], [], np.zeros((0, 3))), "at least one joint"),
        ((["a", "a"], [-1, 0], ZEROS), "given twice: a"),
        ((["a", "b"], [-1, 0, 1], ZEROS), r"got \(3,\) and \(2, 3\)"),
        ((["a", "b"], [-1, -1], ZEROS), "no other, is the root"),
        ((["a", "b"], [0, 0], ZEROS), "no other, is the root"),
        ((["a", "b"], [-1, 1], ZEROS), "'b' stands before its parent"),
        ((["a", "b"], [-1, 0], [[0, 0, 0], [0, np.nan, 0]]), "'b' is not a finite"),
        ((["a", "b"], [-1, 0], ZEROS, np.ones((2, 4))), r"axes \(2, 4\) of length 1"),
        ((["a", "b"], [-1, 0], ZEROS, np.eye(4)[:1]), r"axes \(2, 4\) of length 1, got \(1, 4\)"),
        ((["a", "b"], [-1, 0], ZEROS, np.eye(4)[:2], ["xx", ""]), "'a' needs dofs such as .*got 'xx'"),
        ((["a", "b"], [-1, 0], ZEROS, np.eye(4)[:2], ["x"]), "2 joints need as many dofs, got 1"),
    ],
)
def test_a_bad_skeleton_is_refused(arguments, message):
    refused(message, Skeleton, *arguments)


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


def test_an_unknown_joint_is_named_with_those_there_are():
    refused("No joint 'c'; there are: a, b", Skeleton(["a", "b"], [-1, 0], ZEROS).index, "c")


@pytest.mark.parametrize(
    ("names", "sides"),
    [
        (["root", "lowerback", "lfemur", "rfemur"], ["middle", "middle", "left", "right"]),
        (["Hips", "LeftUpLeg", "RightUpLeg"], ["middle", "left", "right"]),
        (["spine", "Shoulder_R", "Shoulder_L"], ["middle", "right", "left"]),
        (["pelvis", "foot_l", "foot_r"], ["middle", "left", "right"]),
        (["lowerneck", "ltoes"], ["middle", "middle"]),
    ],
)
def test_sides_are_read_off_the_names(names, sides):
    body = Skeleton(names, [-1, *[0] * (len(names) - 1)], np.zeros((len(names), 3)))
    assert [body.side(j) for j in range(len(names))] == sides


def test_mismatches_are_named():
    body = Skeleton(["a", "b", "c"], [-1, 0, 1], np.zeros((3, 3)))
    body.require_same(Skeleton(["a", "b", "c"], [-1, 0, 1], np.zeros((3, 3))))
    others = {
        "these joints: b, d": Skeleton(["a", "d", "c"], [-1, 0, 1], np.zeros((3, 3))),
        "another order or tree": Skeleton(["a", "b", "c"], [-1, 0, 0], np.zeros((3, 3))),
        "'c' sits 5 cm apart": Skeleton(["a", "b", "c"], [-1, 0, 1], [[0, 0, 0], [0, 0, 0], [0, 0.05, 0]]),
    }
    for message, other in others.items():
        refused(message, body.require_same, other, kind=SkeletonMismatch)
