"""Groups are matched by the best order, against all orders, and by a good turn, against 72 of them."""

from itertools import permutations

import numpy as np
import pytest

from mocap.errors import MocapWarning
from mocap.methods.groups import Configuration
from mocap.methods.groups.configurations import SECONDS, assignment_costs, cluster, compare, seen_from_itself
from tests.methods.groups.built import flock
from tests.refusals import refusals, unwarned

ALL_AROUND = tuple(2 * np.pi * k / 72 for k in range(72))


def drawn(count, pairs, seed=1):
    """Draw pairs of configurations from a simulation, each seen from itself."""
    places, velocities = flock(count, 400.0)
    seen, _, _ = seen_from_itself(Configuration(places, velocities))
    rows = np.random.default_rng(seed).choice(len(places), (2, pairs))
    return tuple(Configuration(seen.places[row], seen.velocities[row]) for row in rows)


def test_the_match_is_as_good_as_the_best_of_all_orders():
    """And better: `compare` turns the second, too."""
    first, second = drawn(6, 25)
    costs = assignment_costs(first, second, np.ones(25), np.zeros(25))
    orders = np.array(list(permutations(range(6))))
    best = costs[:, np.arange(6), orders].mean(axis=-1).min(axis=1)
    assert (compare(first, second).rms <= np.sqrt(best) + 1e-12).all()


def test_a_group_turned_moved_and_renumbered_is_the_same_and_its_mirror_image_is_not():
    group = Configuration(flock().places[500], flock().velocities[500])
    shuffled = np.random.default_rng(0).permutation(12)
    places, velocities = group.places * np.exp(2j) + 3 - 4j, group.velocities * np.exp(2j)
    other = Configuration(places[shuffled], velocities[shuffled])
    match = compare(group, other)
    assert match.rms < 1e-9
    np.testing.assert_array_equal(shuffled[match.order], np.arange(12))
    assert match.turn == pytest.approx(np.exp(-2j))
    mirrored = Configuration(group.places.conj(), group.velocities.conj())
    assert compare(group, mirrored, starts=ALL_AROUND).rms > 0.3


def test_the_match_says_how_to_lay_the_second_on_the_first():
    first, second = drawn(12, 5)
    match = compare(first, second)
    for row in range(5):
        there = match.turn[row] * second.places[row][match.order[row]] + match.move[row]
        going = match.turn[row] * second.velocities[row][match.order[row]]
        change = SECONDS * np.abs(first.velocities[row] - going)
        square = np.abs(first.places[row] - there) ** 2 + change**2
        assert np.sqrt(square.mean()) == pytest.approx(match.rms[row])


def test_seen_from_itself_a_group_stands_in_the_middle_and_goes_ahead():
    group = Configuration(flock().places, flock().velocities)
    seen, turn, move = seen_from_itself(group)
    np.testing.assert_allclose(seen.places.mean(axis=-1), 0, atol=1e-12)
    np.testing.assert_allclose(np.angle(seen.velocities.mean(axis=-1)), 0, atol=1e-12)
    np.testing.assert_allclose(turn[:, None] * seen.places + move[:, None], group.places, atol=1e-9)


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
    with pytest.warns(MocapWarning, match=r"1 nodes are within 0.3 m of \d+% of what was simulated"):
        cluster(flock(12, 60.0), nodes=1, reach=0.3)


def test_it_ends_where_all_are_covered():
    assert len(unwarned(cluster, flock(6, 60.0), nodes=50, reach=2.0).nodes) < 50
