"""The generated jump: it falls freely, its feet stand, and it moves within what five captured jumps do."""

from functools import cache

import numpy as np
import pytest
from jumping import generate_jump, plan_jump
from walking.walking_body import FOOT, SKELETON

import mocap
from mocap.body.kinematics import joint_positions
from mocap.datasets import SAMPLES, sample
from mocap.quality.clip_flaws import inspect
from mocap.quality.falling import centre_of_mass, gravity
from tests.datasets.walking_limits import check_floor, check_limits
from tests.quality.test_falling import FLIGHTS

JUMP = sample("jump")
PLAN = plan_jump(0.3)
AIR = slice(int(PLAN.take_off * 120) + 2, int(PLAN.landing * 120))


def bend(motion, places):
    """Return the angle of the left knee, degrees."""
    hip, knee, ankle = (places[:, motion.skeleton.index(name)] for name in ("lfemur", "ltibia", "lfoot"))
    thigh, shank = knee - hip, ankle - knee
    cosine = (thigh * shank).sum(-1) / np.linalg.norm(thigh, axis=-1) / np.linalg.norm(shank, axis=-1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def lean(motion, places):
    """Return the angle of the trunk to the vertical, degrees."""
    up = places[:, motion.skeleton.index("thorax")] - places[:, 0]
    return np.degrees(np.arccos(up[:, 1] / np.linalg.norm(up, axis=-1)))


def measure(motion, first, last):
    """Measure a jump: metres, seconds, degrees, m/s²."""
    centre, places = centre_of_mass(motion)[:, 1], joint_positions(motion)
    push = np.gradient(np.gradient(centre)) * motion.fps**2
    knee, low = bend(motion, places), int(centre[:first].argmin())
    accelerations = np.linalg.norm(np.diff(places, 2, axis=0), axis=-1) * motion.fps**2
    return {
        "above standing": centre.max() - centre[0],
        "crouch": centre[0] - centre[low],
        "landing": centre[0] - centre[last : last + 60].min(),
        "flight": (last - first) / motion.fps,
        "push": (first - low) / motion.fps,
        "knee standing": knee[0],
        "knee lowest": knee[low],
        "knee in the air": knee[first:last].max(),
        "trunk lowest": lean(motion, places)[low],
        "acceleration": push.max(),
        "foot": accelerations[:, motion.skeleton.index("lfoot")].max(),
        "head": accelerations[:, motion.skeleton.index("head")].max(),
    }


# The least and the most of five captured jumps. Their flights, and so their push, are read off by eye.
REAL = {
    "above standing": (0.26, 0.51),
    "crouch": (0.17, 0.32),
    "landing": (0.08, 0.24),
    "flight": (0.28, 0.52),
    "push": (0.25, 0.31),
    "knee standing": (16.9, 22),
    "knee lowest": (83.8, 99),
    "knee in the air": (28, 44),
    "trunk lowest": (29, 65),
    "acceleration": (34, 60),
    "foot": (99, 227),
    "head": (53, 178),
}


@cache
def captured(folder):
    clips = {name: mocap.load(folder / "cmu" / name[:2] / f"{name}.amc") for name in FLIGHTS}
    return [measure(clips[name], *flight) for name, flight in FLIGHTS.items()]


def test_the_limits_are_those_of_five_captured_jumps(real_data):
    for key, (low, high) in REAL.items():
        values = [found[key] for found in captured(real_data)]
        assert min(values) >= low, key
        assert max(values) <= high, key
        assert min(values) + max(values) == pytest.approx(low + high, rel=0.06), key


@pytest.mark.parametrize("key", REAL)
def test_the_jump_moves_as_people_do(key):
    value = measure(JUMP, round(PLAN.take_off * 120), round(PLAN.landing * 120))[key]
    low, high = REAL[key]
    if key in ("acceleration", "foot", "head"):
        low = 0  # a captured jump has noise as well
    assert low <= value <= high


@pytest.mark.parametrize("rise", [0.15, 0.3, 0.5])
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
    assert not np.array_equal(generate_jump(seed=1).rotations, JUMP.rotations)
