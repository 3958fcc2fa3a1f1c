"""Blend weights: where they start and end, and how smoothly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.weights import cubic_weights, linear_weights, quintic_weights, sine_weights
from tests.refusals import refused


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
    """As in [KGP02, Eq. 7]."""
    many = 20_000
    assert slope_and_curve(linear_weights, many)[0] == pytest.approx(-1)
    assert slope_and_curve(cubic_weights, many) == (pytest.approx(0, abs=1e-3), pytest.approx(-6, abs=1e-2))
    assert slope_and_curve(quintic_weights, many) == (pytest.approx(0, abs=1e-3), pytest.approx(0, abs=1e-2))


def test_sine_weights_are_the_homework_s():
    u = [(1 + np.sin(np.pi * i / 49 - np.pi / 2)) / 2 for i in range(50)]
    assert 1 - sine_weights(50) == pytest.approx(u)
    for window in (2, 50):
        assert sine_weights(window)[[0, -1]] == pytest.approx([1, 0], abs=1e-12)
    refused("at least two frames, got 1", sine_weights, 1)


def test_an_empty_window_has_no_weights():
    refused("got 0", cubic_weights, 0)
