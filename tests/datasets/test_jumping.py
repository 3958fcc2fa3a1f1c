"""The generated jump: it falls freely, its feet stand, and it keeps to the limits of joints."""

import numpy as np
import pytest
from jumping import generate_jump, plan_jump
from walking.walking_body import FOOT, SKELETON

from mocap.body.kinematics import joint_positions
from mocap.datasets import SAMPLES, sample
from mocap.quality.clip_flaws import inspect
from mocap.quality.falling import centre_of_mass, gravity
from tests.datasets.walking_limits import check_floor, check_limits

JUMP = sample("jump")
PLAN = plan_jump(0.3)
AIR = slice(int(PLAN.take_off * 120) + 2, int(PLAN.landing * 120))


@pytest.mark.parametrize("rise", [0.15, 0.5])
def test_in_the_air_the_centre_of_mass_falls_freely_and_rises_as_asked(rise):
    jump, plan = generate_jump(rise), plan_jump(rise)
    first, last = int(plan.take_off * 120) + 1, int(plan.landing * 120)
    assert gravity(jump, first, last) == pytest.approx(9.81, abs=1e-4)
    centre = centre_of_mass(jump)
    assert centre[first:last, 1].max() - 1.055 == pytest.approx(rise, abs=1e-3)
    assert np.ptp(centre[first:last, [0, 2]], axis=0).max() < 1e-6


def test_the_jump_as_it_is_made_keeps_to_the_ground_and_the_limits():
    made = generate_jump()
    push = np.gradient(np.gradient(centre_of_mass(made)[:, 1])) * 120**2
    assert push.min() > -9.82  # the ground never pulls
    check_floor(made, heel=1e-9)
    check_limits(made, hip=(-100, 35), ankle=(-45, 60))
    places = joint_positions(made)
    for joint, mark in made.contacts.items():
        track = places[:, SKELETON.index(joint)]
        assert np.ptp(track[mark], axis=0).max() < 1e-9
        assert track[mark, 1] == pytest.approx(FOOT.ankle if "foot" in joint else FOOT.ball, abs=1e-9)
        assert len(np.flatnonzero(np.diff(mark.astype(int)))) == 2
        assert not mark[AIR].any()
    assert list(JUMP.labels) == ["stand", "jump"]
    assert np.array_equal(JUMP.labels["stand"], ~JUMP.labels["jump"])
    assert not inspect(JUMP).flaws
    frames = JUMP.rotations.reshape(len(JUMP), -1)
    assert len(np.unique(frames.round(6), axis=0)) == len(frames)


def test_the_jump_is_a_sample_but_no_walk():
    assert "jump" not in SAMPLES
    assert sample("jump") is JUMP
