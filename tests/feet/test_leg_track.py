"""A hinge says how far a leg reaches; an ankle comes to its target, and without one nothing changes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import find_legs, rotations
from mocap.body.kinematics import forward_kinematics
from mocap.datasets.samples import sample
from mocap.feet.leg_track import UP, pose_leg, track_leg
from mocap.feet.tuned import TUNED
from tests.refusals import refused
from tests.strategies import seeds

CLIP = sample("walk_straight")[300:420]
LEFT = find_legs(CLIP.skeleton)[0]
POSES = forward_kinematics(CLIP)
TRACK = track_leg(CLIP, LEFT, POSES)
ANKLE, HIP = TRACK.ankle, TRACK.hip


def test_the_hinge_says_how_far_a_leg_reaches():
    thigh, shank, _ = LEFT.lengths(CLIP.skeleton)
    assert TRACK.reach(0.0) == pytest.approx(np.full(len(CLIP), thigh + shank))
    distance = np.linalg.norm(ANKLE - HIP, axis=-1)
    assert TRACK.reach(TRACK.flexion) == pytest.approx(distance)
    assert TRACK.flexion_at(distance) == pytest.approx(TRACK.flexion)
    assert np.all(TRACK.flexion > 0)


@given(seeds)
def test_a_captured_knee_that_is_no_pure_hinge_is_as_long_as_it_is(seed):
    turned = CLIP.rotations.copy()
    tilt = rotations.from_rotvec(np.random.default_rng(seed).normal(size=(len(CLIP), 3)) * 0.2)
    turned[:, LEFT.knee] = rotations.multiply(tilt, turned[:, LEFT.knee])
    motion = replace(CLIP, rotations=turned)
    track = track_leg(motion, LEFT, forward_kinematics(motion))
    assert track.flexed(track.flexion) == pytest.approx(track.ankle - track.hip, abs=1e-12)
    distance = np.linalg.norm(track.ankle - track.hip, axis=-1)
    assert track.reach(track.flexion) == pytest.approx(distance, abs=1e-12)


def test_where_a_leg_is_too_short_or_too_long_its_knee_is_straight_or_folded():
    reach = TRACK.reach(0.0)
    assert TRACK.flexion_at(1.1 * reach) == pytest.approx(0.0, abs=1e-6)  # near 1 arccos loses digits
    assert TRACK.flexion_at(0.0 * reach) == pytest.approx(np.pi, abs=1e-6)


def test_no_knee_becomes_straighter_than_twelve_degrees_or_than_it_is():
    thigh, shank, _ = LEFT.lengths(CLIP.skeleton)
    bent = np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(np.radians(TUNED.flexion)))
    assert pytest.approx(np.maximum(TRACK.reach(TRACK.flexion), bent)) == TRACK.limit


def test_a_root_as_high_or_as_low_as_it_may_be_stretches_the_leg_to_its_length():
    """As low as that: the hip hangs below the ankle, or a leg that lies would leave its plant."""
    rises = TRACK.rises(TRACK.ankle)
    ends = TRACK.hip + rises[..., None] * UP
    for end in ends:
        assert np.linalg.norm(end - TRACK.ankle, axis=-1) == pytest.approx(TRACK.reach(0.0))
    assert np.all(rises[1] >= -1e-9)
    assert np.all(ends[0, :, 1] < TRACK.ankle[:, 1])


def test_a_leg_that_must_turn_round_keeps_its_thigh():
    swung = TRACK.swung_thigh(TRACK.flexion, HIP - ANKLE)
    assert np.linalg.norm(swung, axis=-1) == pytest.approx(np.linalg.norm(TRACK.knee - HIP, axis=-1))


def test_a_knee_that_never_bends_hides_its_hinge():
    straight = CLIP.rotations.copy()
    straight[:, LEFT.knee] = rotations.IDENTITY
    stiff = replace(CLIP, rotations=straight)
    refused("'ltibia' is straight in every frame", track_leg, stiff, LEFT, forward_kinematics(stiff))


def posed(ankle, turn):
    """Return the positions and matrices of the clip with its left leg posed anew."""
    pose = CLIP.rotations.copy()
    bend = TRACK.flexion_at(np.linalg.norm(ankle - HIP, axis=-1))
    pose[:, LEFT[:3]] = pose_leg(TRACK, bend, ankle - HIP, turn)
    return forward_kinematics(replace(CLIP, rotations=pose))


@given(seeds, st.floats(0, 0.15))
def test_the_ankle_comes_to_its_target_and_the_foot_turns_as_asked(seed, far):
    random = np.random.default_rng(seed)
    target = ANKLE + far * random.uniform(-1, 1, (len(CLIP), 3)) * [1, 0, 1] + [0, 0.1, 0]
    stretch = np.linalg.norm(target - HIP, axis=-1) / TRACK.reach(0.0)
    target = HIP + (target - HIP) / np.maximum(1, 1.001 * stretch)[:, None]  # within reach
    turn = random.normal(size=(len(CLIP), 3)) * 0.3
    after = posed(target, turn)
    assert after.positions[:, LEFT.ankle] == pytest.approx(target, abs=1e-9)
    wanted = rotations.multiply(
        rotations.from_rotvec(turn), rotations.from_matrix(POSES.matrices[:, LEFT.ankle])
    )
    got = rotations.from_matrix(after.matrices[:, LEFT.ankle])
    assert rotations.angle_between(got, wanted) == pytest.approx(0, abs=1e-6)
    # A hinge stays one: seen from the thigh, the knee's axis is where it was.
    axis = np.einsum(
        "fji,fj->fi",
        after.matrices[:, LEFT.hip],
        np.cross(
            after.positions[:, LEFT.knee] - after.positions[:, LEFT.hip],
            after.positions[:, LEFT.ankle] - after.positions[:, LEFT.knee],
        ),
    )
    assert axis / np.linalg.norm(axis, axis=-1, keepdims=True) == pytest.approx(
        np.tile([1.0, 0, 0], (len(CLIP), 1)), abs=1e-6
    )


def test_with_the_ankle_at_its_target_nothing_changes_and_else_the_other_leg_and_the_trunk_stay():
    same = pose_leg(TRACK, TRACK.flexion, ANKLE - HIP, np.zeros((len(CLIP), 3)))
    assert same == pytest.approx(CLIP.rotations[:, LEFT[:3]], abs=1e-9)
    after = posed(ANKLE + np.array([0, 0.05, 0]), np.zeros((len(CLIP), 3)))
    others = [j for j in range(len(CLIP.skeleton)) if not CLIP.skeleton.names[j].startswith(("lf", "lt"))]
    assert after.positions[:, others] == pytest.approx(POSES.positions[:, others])
