"""Blend weights, and blending's invariants."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.interpolation import blend
from mocap.blending.weights import cubic_weights, linear_weights, quintic_weights, sine_weights
from mocap.body import rotations
from mocap.errors import MocapError, SkeletonMismatch
from tests.strategies import planar, random_motion, seeds


def pair(seed):
    a = random_motion(seed)
    return a, random_motion(seed + 1, skeleton=a.skeleton)


@given(st.sampled_from([cubic_weights, linear_weights, quintic_weights]), st.integers(1, 60))
def test_weights_fall_from_one_to_zero_alike_from_both_ends(weights, window):
    alpha = np.array([1.0, *weights(window)])  # with α(-1) in front
    assert alpha[-1] == pytest.approx(0, abs=1e-12)
    assert alpha + alpha[::-1] == pytest.approx(1)
    assert np.all(np.diff(alpha) < 0)
    assert np.all((alpha[1:] >= 0) & (alpha[1:] <= 1))


def slope_and_curve(weights, window):
    """Measure the first and second derivative at the start, by t, from the weights themselves."""
    one, two = weights(window)[:2]
    return (one - 1) * window, (two - 2 * one + 1) * window**2


def test_the_slopes_at_the_ends_are_those_promised():
    many = 20_000
    assert slope_and_curve(linear_weights, many)[0] == pytest.approx(-1)
    assert slope_and_curve(cubic_weights, many) == (pytest.approx(0, abs=1e-3), pytest.approx(-6, abs=1e-2))
    assert slope_and_curve(quintic_weights, many) == (pytest.approx(0, abs=1e-3), pytest.approx(0, abs=1e-2))


def test_sine_weights_are_the_homework_s():
    u = [(1 + np.sin(np.pi * i / 49 - np.pi / 2)) / 2 for i in range(50)]
    assert 1 - sine_weights(50) == pytest.approx(u)
    assert sine_weights(50)[[0, -1]] == pytest.approx([1, 0], abs=1e-12)
    with pytest.raises(MocapError, match="at least two frames, got 1"):
        sine_weights(1)


@given(st.integers(1, 60))
def test_cubic_weights_are_symmetric_and_level_at_both_ends(window):
    weights = np.array([1.0, *cubic_weights(window)])  # with α(-1) in front
    assert weights[-1] == pytest.approx(0, abs=1e-12)
    assert weights + weights[::-1] == pytest.approx(1)
    assert np.all(np.diff(weights) < 0)
    # Level ends: over a step 1/k the cubic leaves them by at most 3/k².
    assert 1 - weights[1] <= 3 / window**2 + 1e-12


def test_an_empty_window_has_no_weights():
    with pytest.raises(MocapError, match="got 0"):
        cubic_weights(0)


@given(seeds)
def test_the_ends_are_the_motions_themselves(seed):
    a, b = pair(seed)
    for weight, source in ((1.0, a), (0.0, b)):
        mixed = blend(a, b, np.full(5, weight))
        assert mixed.root_positions == pytest.approx(source.root_positions)
        assert rotations.angle_between(mixed.rotations, source.rotations) == pytest.approx(0, abs=1e-6)


@given(seeds, planar)
def test_moving_then_blending_is_blending_then_moving(seed, transform):
    a, b = pair(seed)
    weights = np.linspace(1, 0, 5)
    first = blend(transform.apply_motion(a), transform.apply_motion(b), weights)
    last = transform.apply_motion(blend(a, b, weights))
    assert first.root_positions == pytest.approx(last.root_positions, abs=1e-9)
    assert rotations.angle_between(first.rotations, last.rotations) == pytest.approx(0, abs=1e-6)


def test_marks_come_from_the_larger_weight():
    a, b = pair(3)
    a = replace(a, contacts={"joint5": True}, labels={"walk": True})
    b = replace(b, contacts={"joint5": False}, labels={"run": True})
    mixed = blend(a, b, [1.0, 0.6, 0.5, 0.4, 0.0])
    assert mixed.contacts["joint5"].tolist() == [True, True, True, False, False]
    assert mixed.labels["walk"].tolist() == [True, True, True, False, False]
    assert mixed.labels["run"].tolist() == [False, False, False, True, True]


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([0.5] * 4, r"got 5, 5, \(4,\)"),
        ([0.5] * 4 + [1.1], r"lie in \[0, 1\]"),
        ([np.nan] * 5, r"lie in \[0, 1\]"),
    ],
)
def test_weights_must_fit(weights, message):
    with pytest.raises(MocapError, match=message):
        blend(*pair(0), weights)


def test_skeletons_must_be_the_same():
    with pytest.raises(SkeletonMismatch):
        blend(random_motion(0), random_motion(1), np.zeros(5))
