"""Turns copied from body to body."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body import Motion, PlanarTransform, joint_positions, rotations
from mocap.editing.retargeting import copied
from mocap.editing.stances import proportioned, stance_of
from mocap.errors import SkeletonMismatch
from tests.editing.bodies import LONG, adult, along_x, bends, child, renamed, rested, walk, without
from tests.refusals import refusals


def farthest(a: Motion, b: Motion) -> float:
    return float(np.linalg.norm(joint_positions(a) - joint_positions(b), axis=-1).max())


def rms(errors: np.ndarray) -> float:
    return float(np.sqrt((errors**2).mean()))


@settings(max_examples=5)
@given(share=st.floats(0.2, 3))
def test_onto_a_scaled_copy_all_places_are_scaled(share):
    """About the ground below the hips of the first frame. As in [Gle98, scaled start]."""
    smaller = proportioned(adult(), legs=share, trunk=share, arms=share, head=share)
    there = joint_positions(copied(walk(1.0), adult(), smaller))
    here = joint_positions(walk(1.0))
    centre = here[0, [adult().roles["left hip"], adult().roles["right hip"]]].mean(axis=0) * [1, 0, 1]
    assert np.allclose(there - centre, share * (here - centre), atol=1e-12)


@settings(max_examples=5)
@given(angle=st.floats(-3, 3), x=st.floats(-9, 9), z=st.floats(-9, 9))
def test_a_copy_is_carried_over_the_ground_with_its_source(angle, x, z):
    carry = PlanarTransform(angle, x, z)
    moved = copied(carry.apply_motion(walk(1.0)), adult(), child())
    assert farthest(moved, carry.apply_motion(copied(walk(1.0), adult(), child()))) < 1e-11


def test_the_rest_pose_does_not_matter():
    """Bones along +x at rest, as in Bandai-Namco's files; copied angle by angle the figure would fold."""
    other = rested(walk(), along_x(walk().skeleton))
    onto = stance_of(other)
    assert farthest(copied(walk(), stance_of(walk(), mean=True), onto), walk()) < 1e-12
    who = adult().roles
    apart = bends(copied(walk(), adult(), onto), who) - bends(walk(), who)
    assert rms(apart) < 5  # the rest pose against the mean over the walk, at the elbows


def test_arms_that_rest_another_way_keep_their_hands():
    """Arms out at rest, as in the CMU files, on arms that rest hanging: hands go with their forearms."""
    turns = np.tile([1.0, 0, 0, 0], (len(walk().skeleton), 1))
    for side, sign in (("l", -1), ("r", 1)):
        arm = walk().skeleton.index(f"{side}humerus")
        below = [j for j in range(len(turns)) if arm in walk().skeleton.path_to_root(j)]
        turns[below] = rotations.from_rotvec([0, 0, sign * np.pi / 2])
    out = rested(walk(), turns)
    assert farthest(copied(walk(), adult(), stance_of(out)), walk()) < 1e-12
    assert farthest(copied(out, stance_of(out), adult()), walk()) < 1e-12


def test_there_and_back():
    there = copied(walk(), adult(), child())
    assert farthest(copied(there, child(), adult()), walk()) < 1e-12
    fewer = without(walk(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    there = copied(walk(), adult(), stance_of(fewer))
    back = copied(there, stance_of(fewer), adult())
    apart = joint_positions(back) - joint_positions(walk())
    assert 0.001 < rms(np.linalg.norm(apart, axis=-1)) < 0.025  # the turns of joints that it lacks are lost
    legs = [joint for r, joint in adult().roles.items() if r.split()[-1] in ("hip", "knee", "ankle", "ball")]
    assert np.abs(apart[:, legs]).max() < 1e-12


def test_names_labels_and_contacts_come_along():
    other = renamed(walk(), LONG)
    there = copied(walk(), adult(), stance_of(other))
    assert there.name == walk().name
    assert list(there.labels) == list(walk().labels)
    assert np.array_equal(there.contacts["LeftFoot"], walk().contacts["lfoot"])
    assert set(there.contacts) == {"LeftFoot", "RightFoot", "LeftToeBase", "RightToeBase"}


def test_a_root_above_the_pelvis_turns_with_the_heading_only():
    old = walk().skeleton
    offsets = np.r_[[[0.0, 0, 0], [0, 0.9, 0]], old.offsets[1:]]
    body = type(old)(["ground", *old.names], [-1, *(old.parents + 1)], offsets)
    roots = walk().root_positions - [0, 0.9, 0]
    turns = np.concatenate([np.tile([1.0, 0, 0, 0], (len(walk()), 1, 1)), walk().rotations], axis=1)
    clip = Motion(body, roots, turns, walk().fps, contacts=walk().contacts)
    there = copied(walk(), adult(), stance_of(clip))
    assert np.abs(joint_positions(there)[:, 1:] - joint_positions(walk())).max() < 1e-12
    assert np.abs(there.rotations[:, 0, [1, 3]]).max() < 1e-9  # about the vertical


test_what_cannot_be_copied_is_refused = refusals(
    (SkeletonMismatch, "bones differ", copied, walk(), child(), adult()),
    *(
        ("needs a scale above 0", lambda share=share: copied(walk(), adult(), child(), scale=share))
        for share in (0, -1, np.nan, np.inf)
    ),
)
