"""A foot's way from footplant to footplant."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.datasets.footsteps import Roll, Steps, foot_path, foot_pitch, smooth_path, winding
from mocap.datasets.gait import JOG, SNEAK, WALK, mix_rolls
from mocap.datasets.walking_body import FOOT
from tests.strategies import seeds

HALF = np.array([0.5, 0.5])
ROLLS = pytest.mark.parametrize(
    "roll",
    [
        WALK.roll,
        JOG.roll,
        SNEAK.roll,
        mix_rolls([WALK.roll, JOG.roll], HALF),
        mix_rolls([WALK.roll, SNEAK.roll], HALF),
    ],
    ids=["walk", "jog", "sneak", "walk-jog", "walk-sneak"],
)


def steps_on(roll: Roll, stride: float, turn: float = 0.0) -> Steps:
    """Return nine steps ahead, each turned by `turn` radians."""
    yaws = turn * np.arange(9)
    strides = stride * np.stack([np.sin(yaws), np.cos(yaws)], axis=-1)
    return Steps(np.arange(9.0), np.cumsum(strides, axis=0), yaws, np.ones(8), [roll] * 8)


def test_a_winding_path_turns_as_its_stretches_say():
    points = winding([(2.0, 0), (3.0, 180), (2.0, 0)])
    assert points[0].tolist() == [0, 0]
    assert np.linalg.norm(np.diff(points, axis=0), axis=-1) == pytest.approx(0.05)
    assert points[-1, 0] == pytest.approx(2 * 3.0 / np.pi, abs=0.1)  # back beside the start, to its left
    assert points[-1, 1] == pytest.approx(0, abs=0.1)


@ROLLS
def test_a_foot_is_flat_between_its_times_and_points_up_when_it_strikes(roll):
    assert foot_pitch(roll, [roll.flat, roll.heel_off, 1 + roll.flat]) == pytest.approx(0)
    assert foot_pitch(roll, 1.0) > 0
    assert foot_pitch(roll, roll.lift) < -0.2


@ROLLS
def test_a_planted_foot_stands_still(roll):
    steps = steps_on(roll, 1.3)
    phase = np.linspace(2, 6, 2000)
    path = foot_path(steps, phase, FOOT)
    for n in range(2, 6):
        flat = path.flat & (phase > n) & (phase < n + 0.9)
        expected = [steps.places[n, 0], FOOT.ankle, steps.places[n, 1]]
        assert path.ankle[flat] == pytest.approx(np.tile(expected, (flat.sum(), 1)), abs=1e-12)
        assert path.planted[flat].all()


@pytest.mark.parametrize("to", [JOG.roll, SNEAK.roll], ids=["jog", "sneak"])
def test_a_foot_that_rolls_otherwise_each_step_stands_still_and_moves_without_a_jump(to):
    weights = np.linspace(0, 1, 8)
    rolls = [mix_rolls([WALK.roll, to], np.array([1 - weight, weight])) for weight in weights]
    steps = steps_on(WALK.roll, 1.3)._replace(rolls=rolls)
    phase = np.linspace(1, 7, 60001)
    path = foot_path(steps, phase, FOOT)
    speed = np.diff(path.ankle, axis=0) / (phase[1] - phase[0])
    assert np.abs(np.diff(speed, axis=0)).max() < 0.15
    assert np.abs(np.diff(path.load)).max() < 0.01
    assert (path.flat <= path.planted).all()
    for n in range(1, 7):
        middle = np.searchsorted(phase, n + (rolls[n - 1].flat + rolls[n].heel_off) / 2)
        expected = [steps.places[n, 0], FOOT.ankle, steps.places[n, 1]]
        assert path.flat[middle - 50 : middle + 50].all()
        assert path.ankle[middle - 50 : middle + 50] == pytest.approx(np.tile(expected, (100, 1)), abs=1e-12)


@ROLLS
def test_a_foot_moves_without_a_jump_in_place_or_speed(roll):
    phase = np.linspace(2, 6, 40001)
    path = foot_path(steps_on(roll, 1.3, 0.3), phase, FOOT)
    step = phase[1] - phase[0]
    speed = np.diff(path.ankle, axis=0) / step
    assert np.abs(speed).max() < 12
    assert np.abs(np.diff(speed, axis=0)).max() < 0.15  # a jump would stand out by far: 10⁻⁴ cycle a step


@ROLLS
@pytest.mark.parametrize("stride", [0.5, 1.3, 2.2])
def test_toes_and_heel_stay_above_the_floor(roll, stride):
    path = foot_path(steps_on(roll, stride), np.linspace(2, 6, 2000), FOOT)
    up = FOOT.ankle - FOOT.ball
    ball = path.ankle[:, 1] + FOOT.instep * np.sin(path.pitch) - up * np.cos(path.pitch)
    heel = path.ankle[:, 1] - FOOT.heel * np.sin(path.pitch) - FOOT.ankle * np.cos(path.pitch)
    assert ball.min() > FOOT.ball - 0.004
    assert (ball + FOOT.toe * np.sin(path.toe)).min() > FOOT.ball - 1e-9
    assert heel.min() > -1e-3


def test_a_foot_swings_round_a_turn_and_not_across_it():
    radius, turn = 1.0, 0.8
    yaws = turn * np.arange(9)
    places = radius * np.stack([1 - np.cos(yaws), np.sin(yaws)], axis=-1)
    steps = Steps(np.arange(9.0), places, yaws, np.ones(8), [WALK.roll] * 8)
    path = foot_path(steps, np.linspace(2, 6, 500), FOOT)
    away = np.linalg.norm(path.ankle[:, [0, 2]] - [radius, 0], axis=-1)
    chord = radius * np.cos(turn / 2)
    assert away.min() > 0.6 * radius + 0.4 * chord
    assert away.max() < 1.1 * radius


def test_a_foot_that_waits_stays_loaded():
    steps = steps_on(WALK.roll, 0.6)._replace(strikes=np.array([0, 1, 2, 5, 6, 7, 8, 9, 10.0]))
    path = foot_path(steps, np.linspace(2.3, 4.4, 50), FOOT)
    assert path.flat[:40].all()
    assert path.load[:30] == pytest.approx(1)
    assert path.stance.max() < WALK.roll.lift


def test_a_smooth_path_on_a_circle_is_as_long_and_turns_as_much():
    angle = np.linspace(0, np.pi, 60)
    path = smooth_path(2 * np.stack([1 - np.cos(angle), np.sin(angle)], axis=-1))
    along = np.linspace(0, path.length, 200)
    assert path.length == pytest.approx(2 * np.pi, rel=1e-3)
    assert np.ptp(path.heading(along)) == pytest.approx(np.pi, rel=0.02)
    assert np.ptp(np.linalg.norm(np.diff(path.at(along), axis=0), axis=-1)) < 1e-4


@given(st.floats(-5, 15))
def test_a_straight_smooth_path_goes_straight_on_past_its_ends(along):
    path, along = smooth_path([[1, 0], [1, 4], [1, 10]]), np.array([along])
    assert path.at(along)[0] == pytest.approx([1, along[0]], abs=1e-9)
    assert path.heading(along) == pytest.approx(0, abs=1e-9)


@given(seeds)
def test_a_smooth_path_passes_its_points_and_its_heading_is_its_direction(seed):
    """Bends of up to 0.6 radians, a metre apart."""
    bends = np.cumsum(np.random.default_rng(seed).uniform(-0.6, 0.6, 9))
    points = np.cumsum(np.stack([np.sin(bends), np.cos(bends)], axis=1), axis=0)
    path = smooth_path(points)
    along = np.linspace(0, path.length, 1000)
    for point in points:
        assert np.hypot(*(path.at(along) - point).T).min() < 0.01
    step = path.at(along + 1e-5) - path.at(along - 1e-5)
    assert np.hypot(*step.T) / 2e-5 == pytest.approx(1, abs=0.01)
    directions = np.arctan2(*step.T) - path.heading(along)
    assert np.cos(directions) == pytest.approx(1, abs=1e-6)
