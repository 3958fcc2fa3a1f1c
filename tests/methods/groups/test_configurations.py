"""A flock walks as people do; groups are matched by the best order, and by a good rotation, against all."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.methods.groups import RATE, Configuration, nearest_two
from mocap.methods.groups.configurations import assignment_costs, cluster, compare, seen_from_itself
from mocap.methods.groups.flocking import APART, BODY, Flock, advance, push_apart, simulate, steering_force
from mocap.methods.groups.tuned import TUNED
from tests.methods.groups.built import flock
from tests.refusals import refusals, told, unwarned

ALL_AROUND = tuple(2 * np.pi * k / 72 for k in range(72))


def drawn(count, pairs, seed=1):
    """Draw pairs of configurations from a simulation, each seen from itself."""
    places, velocities = flock(count, 400.0)
    seen, _, _ = seen_from_itself(Configuration(places, velocities))
    rows = np.random.default_rng(seed).choice(len(places), (2, pairs))
    return tuple(Configuration(seen.positions[row], seen.velocities[row]) for row in rows)


def test_the_match_is_as_good_as_the_best_of_all_orders():
    """And better: `compare` turns the second, too."""
    first, second = drawn(6, 25)
    costs = assignment_costs(first, second, np.ones(25), np.zeros(25))
    orders = np.array(list(permutations(range(6))))
    best = costs[:, np.arange(6), orders].mean(axis=-1).min(axis=1)
    assert (compare(first, second).rms <= np.sqrt(best) + 1e-12).all()


def test_a_group_turned_moved_and_renumbered_is_the_same_and_its_mirror_image_is_not():
    group = Configuration(flock().positions[500], flock().velocities[500])
    shuffled = np.random.default_rng(0).permutation(12)
    places, velocities = group.positions * np.exp(2j) + 3 - 4j, group.velocities * np.exp(2j)
    other = Configuration(places[shuffled], velocities[shuffled])
    match = compare(group, other)
    assert match.rms < 1e-9
    np.testing.assert_array_equal(shuffled[match.order], np.arange(12))
    assert match.rotation == pytest.approx(np.exp(-2j))
    mirrored = Configuration(group.positions.conj(), group.velocities.conj())
    assert compare(group, mirrored, starts=ALL_AROUND).rms > 0.3


def test_the_match_says_how_to_lay_the_second_on_the_first():
    first, second = drawn(12, 5)
    match = compare(first, second)
    for row in range(5):
        there = match.rotation[row] * second.positions[row][match.order[row]] + match.translation[row]
        going = match.rotation[row] * second.velocities[row][match.order[row]]
        change = TUNED.velocity_seconds * np.abs(first.velocities[row] - going)
        square = np.abs(first.positions[row] - there) ** 2 + change**2
        assert np.sqrt(square.mean()) == pytest.approx(match.rms[row])


def test_seen_from_itself_a_group_stands_in_the_middle_and_goes_ahead():
    group = Configuration(flock().positions, flock().velocities)
    seen, rotation, translation = seen_from_itself(group)
    np.testing.assert_allclose(seen.positions.mean(axis=-1), 0, atol=1e-12)
    np.testing.assert_allclose(np.angle(seen.velocities.mean(axis=-1)), 0, atol=1e-12)
    np.testing.assert_allclose(
        rotation[:, None] * seen.positions + translation[:, None], group.positions, atol=1e-9
    )


def lined_up(count, velocities=1):
    return Configuration(1j * np.arange(count), np.array(velocities) * np.ones(count, complex))


test_groups_that_cannot_be_matched_are_refused = refusals(
    ("Groups of 3 and 2 members cannot be matched", compare, lined_up(3), lined_up(2)),
    ("moves by 0.00 m/s on average has no direction", seen_from_itself, lined_up(2, [1j, -1j])),
    ("moves by nan m/s on average has no direction", seen_from_itself, lined_up(2, np.nan)),
)


@pytest.mark.parametrize(("count", "nodes", "covered"), [(12, 8, 0.85), (6, 6, 0.85)])
def test_few_nodes_cover_most_of_a_simulation(count, nodes, covered):
    """As in [LCF05, nodes]."""
    found = cluster(flock(count, 300.0), nodes=nodes)
    assert len(found.nodes) <= nodes and found.covered >= covered
    near = (found.distances[found.frames // 10] < 0.5).any(axis=0)
    assert near.mean() == pytest.approx(found.covered)


def test_each_node_has_the_most_others_near():
    """As in [LCF05, nodes]."""
    found = cluster(flock(6, 120.0), nodes=3)
    near, chosen = found.distances < 0.5, found.frames // 10
    for number, node in enumerate(chosen):  # of those that no node before it has
        assert (near & ~near[chosen[:number]].any(axis=0)).sum(axis=1).argmax() == node


def test_where_nodes_cover_little_it_says_so():
    told(r"1 nodes are within 0.3 m of \d+% of the simulation", cluster, flock(12, 60.0), nodes=1, reach=0.3)


def test_it_ends_where_all_are_covered():
    assert len(unwarned(cluster, flock(6, 60.0), nodes=50, reach=2.0).nodes) < 50


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
    desired = np.array([1 + 0j, 1 + 0j])

    def force(**weights):
        return steering_force(two, desired, Flock(**{**quiet, **weights}))

    assert force(separate=1)[0].real < 0 < force(separate=1)[1].real
    np.testing.assert_allclose(force(gather=1), [1, -1])
    np.testing.assert_allclose(force(align=1), [1j - 1, 1 - 1j])
    np.testing.assert_allclose(force(steer=1), [0, 1 - 1j])
    np.testing.assert_allclose(force(keep=1), [0.1, 0.1j])
    assert np.abs(force(gather=100)).max() == pytest.approx(Flock().accelerate)


def test_in_a_corridor_a_flock_keeps_between_the_walls_its_pace_and_its_distance():
    places, velocities = simulate(12, 30, corridor=2.0)
    assert np.abs(places.imag).max() < 1.0 - BODY + 0.05
    assert nearest_two(places).min() > APART and 0.8 < np.abs(velocities).mean() < 1.2
    assert places[-1].real.min() > places[0].real.max() + 20


def test_runs_side_by_side_are_the_runs_one_by_one():
    random = np.random.default_rng(1)
    places = random.normal(size=(4, 5)) + 1j * random.normal(size=(4, 5))
    velocities = np.exp(1j * random.normal(size=(4, 5)))
    desired = np.exp(1j * random.normal(size=(4, 5)))
    together = advance(Configuration(places, velocities), desired, Flock())
    for row in range(4):
        alone = advance(Configuration(places[row], velocities[row]), desired[row], Flock())
        np.testing.assert_allclose(together.positions[row], alone.positions, atol=1e-12)
        np.testing.assert_allclose(together.velocities[row], alone.velocities, atol=1e-12)


@given(st.complex_numbers(min_magnitude=0.01, max_magnitude=2.0))
def test_two_are_pushed_just_apart(gap):
    places = np.array([1 + 1j, 1 + 1j + gap])
    moved = places + push_apart(places, 0.6)
    assert np.abs(moved[1] - moved[0]) == pytest.approx(max(abs(gap), 0.6))
    assert moved.mean() == pytest.approx(places.mean())


test_what_makes_no_sense_is_refused = refusals(
    *((f"two members or more, got {count}", simulate, count, 5.0) for count in (1, 2.5, np.nan, np.inf)),
    ("wider than 1.3 m, got 1.29", lambda: simulate(4, 5.0, corridor=2 * BODY + APART)),
)
