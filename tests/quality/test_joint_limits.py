"""Joints that bend as nobody's do are found, whatever the rest pose is; people's pass."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import find_legs, resample, rotations
from mocap.datasets.samples import sample
from mocap.quality.joint_limits import joint_bends

WALK = resample(sample("walk_straight"), 30)[:90]


def worst(motion, turns=()):
    """Give the name of the joint that is most beyond its limit, the way, and its share."""
    local = motion.rotations.copy()
    for name, degrees, axis in turns:
        joint = motion.skeleton.index(name)
        local[:, joint] = rotations.multiply(
            rotations.from_rotvec(np.radians(degrees) * np.array(axis, float)), local[:, joint]
        )
    turned = replace(motion, rotations=local)
    bend = max(joint_bends(turned, find_legs(motion.skeleton)), key=lambda bend: bend.share.max())
    return bend.joint, bend.way, bend.share.max()


def test_a_walk_stays_within_all_limits():
    assert worst(WALK)[2] < 0.6


BEYOND = [
    ([("lfemur", 80, (1, 0, 0))], "lfemur", "back"),
    ([("lfemur", 100, (0, 0, 1))], "lfemur", "out"),
    ([("rfemur", -100, (0, 0, 1))], "rfemur", "out"),
    ([("rfemur", 85, (0, 0, 1))], "rfemur", "out"),  # across the other leg
    ([("lowerneck", 60, (1, 0, 0)), ("upperneck", 60, (1, 0, 0))], "lowerneck", "nodding"),
    ([("lwrist", 100, (1, 0, 0))], "lwrist", "bent"),
    ([("ltibia", -100, (1, 0, 0))], "ltibia", "bent"),  # backwards in all frames
]


@pytest.mark.parametrize(("turns", "joint", "way"), BEYOND)
def test_a_joint_turned_beyond_its_limit_is_found(turns, joint, way):
    assert worst(WALK, turns)[:2] == (joint, way)
    assert worst(WALK, turns)[2] > 1
    few = [(name, degrees / 2, axis) for name, degrees, axis in turns if name != "ltibia"]
    assert worst(WALK, few)[2] < 1


def test_without_legs_or_names_the_rest_is_measured():
    assert {bend.joint for bend in joint_bends(WALK)} == {"lradius", "lwrist", "rradius", "rwrist"}
    names = [f"joint {number}" for number in range(len(WALK.skeleton))]
    nameless = replace(WALK, skeleton=replace(WALK.skeleton, names=names), contacts={})
    assert joint_bends(nameless) == []
    knees = joint_bends(nameless, find_legs(WALK.skeleton))
    assert len(knees) == 2
