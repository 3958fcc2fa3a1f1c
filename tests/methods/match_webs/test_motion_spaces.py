"""Blends are drawn evenly, and are measured as the clips are."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kstest
from walking import generate_walk

from mocap.blending import mix, register
from mocap.body import Motion, PlanarTransform, Skeleton, arcs, rotations
from mocap.methods.match_webs import blend_of, hand_target, mean_speed, sample_space, turn
from mocap.methods.match_webs.motion_spaces import random_weights
from tests.methods.match_webs.spaces_of_walks import gait, space
from tests.refusals import refusals, refused


@cache
def speeds():
    return register([generate_walk([[0, 0], [0, 3]], speed=speed) for speed in (0.8, 1.0, 1.2)])


def test_examples_are_samples_and_all_samples_are_what_their_blends_do():
    """As in [KG04, sampling]."""
    made = space(100)
    count = len(made.examples.clips)
    assert np.array_equal(made.weights[:count], np.eye(count))
    assert repr(made) == f"MotionSpace({count} examples, {count + 100} samples of 2 numbers)"
    for number in (0, 5, count, count + 50):
        blend = blend_of(made.examples, made.weights[number], fps=30)
        assert gait(blend) == pytest.approx(made.values[number], abs=0.3)
    with pytest.raises(ValueError, match="read-only"):
        made.values[0] = 0


def test_a_blend_by_few_is_the_blend_of_all():
    few = blend_of(speeds(), [0, 0.3, 0.7])
    every = mix(speeds(), [0, 0.3, 0.7])
    assert np.abs(few.rotations - every.rotations)[:, 1:].max() < 1e-9
    assert few.contacts.keys() == every.contacts.keys()
    step = [np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) for motion in (few, every)]
    assert np.allclose(*step, atol=1e-9)
    assert len(blend_of(speeds(), [0, 1, 0])) == len(mix(speeds(), [0, 1, 0]))


def test_without_a_scale_numbers_count_by_how_much_they_vary():
    made = sample_space(speeds(), lambda motion: (mean_speed(motion), 7.0), count=4)
    assert made.scale == pytest.approx([np.ptp(made.values[:, 0]) / 2, 1.0])


def sampled(measure):
    return sample_space(speeds(), measure, count=3)


test_hostile_input_is_one_sentence = refusals(
    ("A measure of 3 numbers needs 4 examples, got 3", sampled, lambda m: (1.0, 2.0, 3.0)),
    (r"1 finite numbers for each blend; .* gave \[nan\]", sampled, lambda m: np.nan),
    ("gives 1 finite numbers for each blend", sampled, lambda m: [1.0] * (1 + (mean_speed(m) > 1))),
    ("finite numbers for each blend", sampled, lambda m: [[1.0]]),
    ("A blend of 3 clips needs 3 weights", lambda: blend_of(speeds(), [0.5, 0.5])),
    ("A measure of 2 numbers needs 3 examples, got 2.", random_weights, [[1.0, 2], [3, 4]], 5),
    (r"Examples need finite values of shape \(C, d\), got shape \(2,\)", random_weights, [1.0, 2], 5),
    ("Examples need finite values", random_weights, [[np.nan], [1]], 5),
)


VALUES = np.random.default_rng(3).normal(size=(9, 2)) * [20, 0.3]


@given(st.integers(1, 4), st.integers(0, 6), st.floats(0, 0.5), st.integers(0, 99))
def test_weights_add_up_to_one_and_stay_within_the_spread(numbers, more, spread, seed):
    """As in [KG04, accessible region]."""
    values = np.random.default_rng(seed).normal(size=(numbers + 1 + more, numbers))
    weights = random_weights(values, 30, spread=spread, seed=seed)
    assert np.allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert weights.min() >= -spread - 1e-12 and weights.max() <= 1 + spread + 1e-12
    assert ((weights != 0).sum(axis=1) <= numbers + 1).all()


def test_two_weights_are_even_over_what_is_allowed():
    weights = random_weights([[0.0], [1.0]], 4000, spread=0.1)[:, 0]
    assert kstest((weights + 0.1) / 1.2, "uniform").pvalue > 0.01


def test_partners_are_the_nearest_by_scaled_values():
    weights = random_weights(VALUES, 200, near=3, seed=1)
    scaled = VALUES / VALUES.std(axis=0)
    distance = np.linalg.norm(scaled[:, None] - scaled, axis=-1)
    ranks = distance.argsort(axis=1).argsort(axis=1)
    for row in weights:
        chosen = np.flatnonzero(row)
        assert min(ranks[first][chosen].max() for first in chosen) <= 3


def test_a_seed_gives_the_same_again_and_another_one_others():
    one, same, other = (random_weights(VALUES, 5, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


def walk(degrees, speed=1.2):
    return generate_walk(arcs((0, 0), 0, [(5, np.radians(degrees))]).points, speed=speed)


@pytest.mark.parametrize("degrees", [-240, -60, 0, 90, 300])
def test_a_turn_counts_past_half_a_circle_and_to_the_left(degrees):
    assert np.degrees(turn(walk(degrees))) == pytest.approx(degrees, abs=15)


@pytest.mark.parametrize("speed", [0.7, 1.4])
def test_the_speed_is_that_of_the_path(speed):
    assert mean_speed(walk(90, speed)) == pytest.approx(speed, rel=0.05)


def test_one_frame_has_no_speed_and_no_turn():
    frame = walk(0)[:1]
    assert mean_speed(frame) == turn(frame) == 0


def test_measures_do_not_depend_on_where_a_clip_was_captured():
    here = walk(70)
    there = PlanarTransform(2.0, 50.0, -9.0).apply_motion(here)
    for measure in (turn, mean_speed, hand_target):
        assert np.allclose(measure(here), measure(there), atol=1e-9)


def test_the_hand_is_measured_where_the_arm_is_longest():
    arm = Skeleton(["root", "s", "e", "h"], [-1, 0, 1, 2], [[0, 0, 0], [0, 1, 0], [0, 0, 0.3], [0, 0, 0.3]])
    bend = np.tile(rotations.IDENTITY, (3, 4, 1))
    bend[[0, 2], 2] = rotations.about_y(1.0)
    bend[:, 0] = rotations.about_y(0.7)
    punch = Motion(arm, [[5, 0.2, 5]] * 3, bend, 30.0)
    assert hand_target(punch, "h", "s") == pytest.approx([0, 1.2, 0.6])
    refused("rhand", hand_target, punch)
