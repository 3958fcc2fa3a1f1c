"""Whole warps: a hand to a post, a higher jump, a deeper crouch, on generated clips."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import joint_positions, rotations
from mocap.datasets.samples import sample
from mocap.editing.displacements import displaced
from mocap.editing.edits import posed
from mocap.editing.keys import Key, keys_around, offsets
from mocap.feet.footskate import clean_up
from tests.editing.test_path_editing import slide
from tests.editing.wishes import body
from tests.refusals import refusals

UP = np.array([0.0, 1.0, 0.0])


def accelerations(motion):
    return np.linalg.norm(np.diff(joint_positions(motion), 2, axis=0), axis=-1) * motion.fps**2


def planted(motion):
    return sum(int(mark.sum()) for mark in motion.contacts.values())


def post(motion, frame):
    """Return a place for the right hand, 32 cm from where it is: to the right, up, and ahead."""
    side, ahead = (rotations.rotate(motion.rotations[frame, 0], v) for v in ([-1.0, 0, 0], [0, 0, 1.0]))
    hand = joint_positions(motion[frame : frame + 1])[0, motion.skeleton.index("rhand")]
    return hand + 0.15 * side + 0.25 * UP + 0.10 * ahead


def check_hand(motion, frame, columns):
    """Warp a hand to a post; `columns` are the joints whose accelerations within the window are compared."""
    hand, target = motion.skeleton.index("rhand"), post(motion, frame)
    pose = posed(motion, frame, {"rhand": target})
    ratios = []
    for seconds in (0.15, 0.5):
        keys = keys_around(motion, [Key(frame, pose)], seconds)
        change = offsets(motion, keys)
        warped = displaced(motion, change)
        assert np.linalg.norm(joint_positions(warped)[frame, hand] - target) < 1e-5  # 0.01 mm
        outside = np.r_[0 : keys[0].frame + 1, keys[2].frame : len(motion)]
        assert np.abs(change.root[outside]).max() == np.abs(change.turns[outside]).max() == 0
        inside = slice(keys[0].frame, keys[2].frame)
        before, after = (np.percentile(accelerations(m)[inside, columns], 99) for m in (motion, warped))
        ratios.append(after / before)
    assert ratios[0] > 1.5  # too short a window jolts
    assert ratios[1] < 1.1
    left = rotations.multiply(rotations.from_rotvec(change.turns), motion.rotations)
    miss = joint_positions(replace(motion, rotations=left))[frame, hand] - target
    assert np.linalg.norm(miss) > 0.01  # on the other side
    return warped


@pytest.mark.parametrize("frame", [150, 238])
def test_a_hand_to_a_post(frame):
    walk = sample("walk_straight")[:480]
    warped = check_hand(walk, frame, body(walk))
    cleaned = clean_up(warped)
    assert slide(cleaned) < 1e-6
    assert planted(cleaned) >= 0.99 * planted(walk)


def test_a_height_alone_may_be_asked_for_without_feet():
    bare = replace(sample("walk_straight")[:120], contacts={})
    assert len(posed(bare, 60, {"lhand": [np.nan, 1.2, np.nan]}, feet=False)) == 1


SHORT = sample("walk_straight")[:120]

test_poses_that_cannot_be = refusals(
    ("'walk_straight' has 120 frames", posed, SHORT, 999, {"lhand": [0, 1, 0]}),
    ("No joint 'left hand'", posed, SHORT, 5, {"left hand": [0, 1, 0]}),
    (r"'lhand': a place is \(3,\)", posed, SHORT, 5, {"lhand": [0, 1]}),
    (r"Frame 5: '\w+' would be [\d.]+ m from '\w+', the bones", posed, SHORT, 5, {"lhand": [0, 6, 0]}),
    ("needs low ≤ high", posed, SHORT, 5, {"lhand": [0, np.inf, 0]}),
    ("mark_plants finds out", posed, replace(SHORT, contacts={}), 60, {"lhand": [0, 1.2, 0]}),
)
