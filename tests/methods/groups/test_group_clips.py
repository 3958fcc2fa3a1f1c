"""Clips end exactly on their node, nobody comes nearer than 0.60 m, and their bounds hold all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.methods.groups.configurations import compare
from mocap.methods.groups.flocking import APART, RATE, Configuration, Flock, Trajectories, nearest_two
from mocap.methods.groups.group_clips import HARDEST, accelerations, bend_to, part, run_from
from tests.methods.groups.built import flock, graph

every_graph = pytest.mark.parametrize(("count", "nodes"), [(12, 8), (6, 6)])


@every_graph
def test_clips_end_on_their_nodes_nobody_is_jerked_or_nearer_than_60_cm_and_bounds_hold_all(count, nodes):
    """As in [LCF05, clips] and [LCF05, bounds]."""
    group = graph(count, nodes)
    assert min(nearest_two(clip.places).min() for clip in group.clips) >= APART
    assert max(accelerations(clip.places).max() for clip in group.clips) <= HARDEST
    for clip in group.clips[::9]:
        start, end = group.nodes[clip.start], group.nodes[clip.end]
        np.testing.assert_allclose(clip.places[0], start.places, atol=1e-12)
        np.testing.assert_allclose(clip.velocities[0], start.velocities, atol=1e-12)
        assert sorted(clip.order) == list(range(count))
        laid = clip.turn * end.places[clip.order] + clip.move
        np.testing.assert_allclose(clip.places[-1], laid, atol=1e-12)
        np.testing.assert_allclose(clip.velocities[-1], clip.turn * end.velocities[clip.order], atol=1e-12)
        assert len(clip.places) == 41
        centre, radius = clip.disc
        assert np.abs(clip.places - centre).max() <= radius + 1e-12


@pytest.mark.parametrize(
    ("count", "nodes"), [(12, 8), (6, 6), pytest.param(24, 8, marks=pytest.mark.exhaustive)]
)
@pytest.mark.filterwarnings("ignore:.*nodes are within")  # of 24
def test_most_clips_are_kept_and_all_pairs_joined(count, nodes):
    """As in [LCF05, graph]."""
    group = graph(count, nodes)
    assert len(group.clips) >= (0.9 if count < 24 else 0.8) * group.tried
    assert len({(clip.start, clip.end) for clip in group.clips}) == len(group.nodes) ** 2


def test_drawn_to_its_place_each_member_comes_much_nearer_than_freely():
    """The constrained simulation [LCF05, clips]: what is left to bend is less than half."""
    nodes, bends = graph().nodes, np.zeros(8)
    starts = Configuration(*(np.tile(part, (8, 1)) for part in nodes[0]))
    free = run_from(starts, bends, Flock(), np.random.default_rng(0))
    ends = Configuration(*(part[-1] for part in free))
    goal = nodes[-1]  # a column
    match = compare(ends, goal)
    places, velocities = (match.turn[:, None] * part[match.order] for part in goal)
    goals = Configuration(places + match.move[:, None], velocities)
    drawn = run_from(starts, bends, Flock(), np.random.default_rng(0), goals)
    left = np.abs(drawn.places[-1] - goals.places)
    assert np.sqrt((left**2).mean()) < 0.5 * np.sqrt((np.abs(ends.places - goals.places) ** 2).mean())
    assert nearest_two(drawn.places).min() >= APART


@given(st.complex_numbers(max_magnitude=2.0), st.complex_numbers(max_magnitude=1.0))
def test_bending_meets_place_and_velocity_and_keeps_the_start(missing, change):
    walked = Trajectories(flock(6).places[:41], flock(6).velocities[:41])
    goal = Configuration(walked.places[-1] + missing, walked.velocities[-1] + change)
    bent = bend_to(walked, goal)
    np.testing.assert_allclose(bent[-1], goal.places, atol=1e-9)
    np.testing.assert_allclose(bent[0], walked.places[0], atol=1e-12)
    added = bent - walked.places
    assert np.abs(added[1]).max() * RATE <= 0.1 * (abs(missing) + abs(change)) + 1e-9  # it starts at rest
    np.testing.assert_allclose((bent[-1] - bent[-2]) * RATE, goal.velocities, atol=1e-9)


def test_ends_do_not_move_when_members_are_pushed_apart():
    steps = np.linspace(0, 4, 41)
    crossing = np.stack([steps + 0.05j, 4 - steps - 0.05j], axis=1)
    free, done = part(crossing)
    assert done
    np.testing.assert_array_equal(free[[0, 1, -2, -1]], crossing[[0, 1, -2, -1]])


def test_who_starts_too_near_cannot_be_freed():
    near = np.stack([np.linspace(0, 4, 41) + 0j, np.linspace(0, 4, 41) + 0.3j], axis=1)
    assert not part(near)[1]
