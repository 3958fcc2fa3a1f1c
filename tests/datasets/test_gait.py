"""The tables of figures: in their bounds, and the two sides alike."""

import numpy as np
import pytest

from mocap.datasets.footsteps import foot_pitch
from mocap.datasets.gait import (
    JOG,
    SNEAK,
    WALK,
    Gait,
    joint_angles,
    knee_flexion,
    mix,
    mix_rolls,
    pelvis_drift,
)
from mocap.datasets.walking_body import SKELETON

GAITS = pytest.mark.parametrize("gait", [WALK, JOG, SNEAK], ids=lambda gait: gait.name)
PHASE = np.linspace(-1.3, 2.1, 50)


@GAITS
def test_the_right_arm_does_half_a_cycle_later_what_the_left_one_does_mirrored(gait: Gait):
    now = joint_angles(gait, PHASE, np.ones(50))
    later = joint_angles(gait, PHASE + 0.5, np.ones(50))
    for joint in gait.arm:
        assert later["r" + joint] == pytest.approx(now["l" + joint] * [1, -1, -1], abs=1e-12)


@GAITS
def test_the_middle_is_its_own_mirror_image_half_a_cycle_later(gait: Gait):
    now, later = (joint_angles(gait, PHASE + shift, np.ones(50)) for shift in (0, 0.5))
    for joint in gait.trunk:
        assert later[joint] == pytest.approx(now[joint] * [1, -1, -1], abs=1e-12)
    sway, rise, surge = pelvis_drift(gait, PHASE, np.ones(50)).T
    later = pelvis_drift(gait, PHASE + 0.5, np.ones(50))
    assert later == pytest.approx(np.stack([-sway, rise, surge], axis=-1))


@GAITS
def test_without_amplitude_everything_rests(gait: Gait):
    angles = joint_angles(gait, PHASE, np.zeros(50))
    assert all(np.ptp(turn, axis=0).max() == 0 for turn in angles.values())
    assert np.ptp(pelvis_drift(gait, PHASE, np.zeros(50)), axis=0).max() == 0


@GAITS
def test_every_joint_named_is_the_skeleton_s(gait: Gait):
    assert set(joint_angles(gait, PHASE, np.ones(50))) <= set(SKELETON.names)


@GAITS
def test_a_standing_knee_bends_one_way_and_not_too_far(gait: Gait):
    degrees = np.degrees(knee_flexion(gait, np.linspace(0, gait.roll.lift, 100)))
    assert degrees.min() > 10
    assert degrees.max() < 60


@GAITS
def test_a_walker_loads_the_leg_on_whose_side_the_pelvis_is(gait: Gait):
    middle_of_left_stance = gait.roll.lift / 2
    assert pelvis_drift(gait, [middle_of_left_stance], [1.0])[0, 0] > 0


def test_speeds_are_what_people_do():
    assert WALK.speed == pytest.approx(1.18, abs=0.01)
    assert JOG.speed == pytest.approx(2.85, abs=0.01)
    assert SNEAK.speed == pytest.approx(0.51, abs=0.01)


def test_a_mix_lies_as_far_between_as_its_weights_say():
    weights = np.stack([1 - np.linspace(0, 1, 5), np.linspace(0, 1, 5)])
    assert mix([2.0, 6.0], weights).tolist() == [2, 3, 4, 5, 6]
    assert mix([np.zeros((5, 3)), np.ones((5, 3))], weights) == pytest.approx(
        np.repeat(weights[1:].T, 3, axis=1)
    )
    assert mix([PHASE], np.ones((1, 50))).tolist() == PHASE.tolist()


def test_a_mixed_roll_begins_and_ends_as_the_two():
    rolls = [WALK.roll, JOG.roll]
    assert mix_rolls(rolls, np.array([1.0, 0.0])) is WALK.roll
    assert mix_rolls(rolls, np.array([0.0, 1.0])) is JOG.roll
    near = mix_rolls(rolls, np.array([1e-6, 1 - 1e-6]))
    phase = np.linspace(JOG.roll.lift, 1, 50)
    assert np.degrees(foot_pitch(near, phase) - foot_pitch(JOG.roll, phase)) == pytest.approx(0, abs=0.5)
    half = mix_rolls(rolls, np.array([0.5, 0.5]))
    assert half.lift == pytest.approx((WALK.roll.lift + JOG.roll.lift) / 2)
    assert half.swing == pytest.approx(np.mean([roll.swing for roll in rolls], axis=0))
