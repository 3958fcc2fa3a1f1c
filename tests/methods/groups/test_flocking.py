"""A flock walks as people do: at their pace, apart, each with a will of its own; and a seed is a seed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.methods.groups import RATE, Configuration, nearest_two
from mocap.methods.groups.flocking import APART, BODY, Flock, advance, push_apart, simulate, steering_force
from mocap.methods.groups.group_steering import away_from
from tests.methods.groups.built import flock
from tests.refusals import refusals


def test_a_flock_keeps_its_pace_and_its_distance():
    """As in [LCF05, simulation]."""
    for count in (6, 12, 24):
        places, velocities = flock(count)
        speeds = np.abs(velocities)
        assert 0.9 < speeds.mean() < 1.2
        assert np.percentile(speeds, 1) > 0.5 and np.percentile(speeds, 99) < 1.6
        assert nearest_two(places).min() > APART
        assert np.abs(places - places.mean(axis=1, keepdims=True)).max() < 7  # it stays together


def test_velocities_are_those_of_the_places():
    places, velocities = flock(6)
    np.testing.assert_allclose(np.diff(places, axis=0) * RATE, velocities[1:], atol=1e-9)


def test_each_rule_pulls_where_it_should():
    """As in [LCF05, simulation]."""
    quiet = dict.fromkeys(("separate", "gather", "align", "steer", "keep"), 0.0)
    two = Configuration(np.array([0j, 1 + 0j]), np.array([1 + 0j, 1j]))
    wish = np.array([1 + 0j, 1 + 0j])

    def force(**weights):
        return steering_force(two, wish, Flock(**{**quiet, **weights}))

    assert force(separate=1)[0].real < 0 < force(separate=1)[1].real
    np.testing.assert_allclose(force(gather=1), [1, -1])
    np.testing.assert_allclose(force(align=1), [1j - 1, 1 - 1j])
    np.testing.assert_allclose(force(steer=1), [0, 1 - 1j])
    np.testing.assert_allclose(force(keep=1), [0.1, 0.1j])
    assert np.abs(force(gather=100)).max() == pytest.approx(Flock().accelerate)


def test_who_sees_nobody_is_pulled_by_nobody():
    far = Configuration(np.array([0j, 100 + 0j]), np.ones(2, complex))
    alone = steering_force(far, np.ones(2, complex), Flock(keep=0))
    np.testing.assert_allclose(alone, 0, atol=1e-12)


def test_a_disc_pushes_away_from_two_metres_on():
    pushed = away_from([(1.5 + 0j, 0.5)], np.array([0j, 50j, -1.1 + 0j, -0.9 + 0j]))
    np.testing.assert_allclose(pushed, [-3, 0, 0, -0.3], atol=1e-9)


def test_in_a_corridor_a_flock_keeps_between_the_walls_its_pace_and_its_distance():
    places, velocities = simulate(12, 30, corridor=2.0)
    assert np.abs(places.imag).max() < 1.0 - BODY + 0.05
    assert nearest_two(places).min() > APART and 0.8 < np.abs(velocities).mean() < 1.2
    assert places[-1].real.min() > places[0].real.max() + 20


def test_runs_side_by_side_are_the_runs_one_by_one():
    random = np.random.default_rng(1)
    places = random.normal(size=(4, 5)) + 1j * random.normal(size=(4, 5))
    velocities = np.exp(1j * random.normal(size=(4, 5)))
    wish = np.exp(1j * random.normal(size=(4, 5)))
    together = advance(Configuration(places, velocities), wish, Flock())
    for row in range(4):
        alone = advance(Configuration(places[row], velocities[row]), wish[row], Flock())
        np.testing.assert_allclose(together.places[row], alone.places, atol=1e-12)
        np.testing.assert_allclose(together.velocities[row], alone.velocities, atol=1e-12)


@given(st.complex_numbers(min_magnitude=0.01, max_magnitude=2.0))
def test_two_are_pushed_just_apart(gap):
    places = np.array([1 + 1j, 1 + 1j + gap])
    moved = places + push_apart(places, 0.6)
    assert np.abs(moved[1] - moved[0]) == pytest.approx(max(abs(gap), 0.6))
    assert moved.mean() == pytest.approx(places.mean())


test_what_makes_no_sense_is_refused = refusals(
    *((f"two members or more, got {count}", simulate, count, 5.0) for count in (1, 2.5, np.nan)),
    ("wider than 1.3 m, got 1.2 m", lambda: simulate(4, 5.0, corridor=1.2)),
)


def test_who_is_alone_has_nobody_near():
    assert nearest_two(np.zeros((2, 1), complex)).tolist() == [np.inf, np.inf]
