"""Clips end exactly on their node, nobody comes nearer than 0.60 m, and their bounds hold all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.errors import MocapWarning
from mocap.methods.groups.configurations import Configuration
from mocap.methods.groups.flocking import APART, RATE, Trajectories, nearest_two
from mocap.methods.groups.group_clips import HARDEST, accelerations, bend_to, part
from mocap.methods.groups.group_graphs import build_group, play_group, random_group_walk
from tests.methods.groups.built import flock, graph

every_graph = pytest.mark.parametrize(("count", "nodes"), [(12, 8), (6, 6)])


@every_graph
def test_a_clip_starts_and_ends_exactly_on_its_nodes(count, nodes):
    """As in [LCF05, clips]."""
    group = graph(count, nodes)
    for clip in group.clips:
        start, end = group.nodes[clip.start], group.nodes[clip.end]
        np.testing.assert_allclose(clip.places[0], start.places, atol=1e-12)
        np.testing.assert_allclose(clip.velocities[0], start.velocities, atol=1e-12)
        assert sorted(clip.order) == list(range(count))
        np.testing.assert_allclose(
            clip.places[-1], clip.turn * end.places[clip.order] + clip.move, atol=1e-12
        )
        np.testing.assert_allclose(clip.velocities[-1], clip.turn * end.velocities[clip.order], atol=1e-12)


@every_graph
def test_nobody_comes_nearer_than_60_cm_and_nobody_is_jerked(count, nodes):
    for clip in graph(count, nodes).clips:
        assert nearest_two(clip.places).min() >= APART
        assert accelerations(clip.places).max() <= HARDEST
        assert len(clip.places) == 41


@every_graph
def test_the_bounds_hold_every_member_in_every_frame(count, nodes):
    """As in [LCF05, bounds]."""
    for clip in graph(count, nodes).clips:
        centre, radius = clip.disc
        assert np.abs(clip.places - centre).max() <= radius + 1e-12


@every_graph
def test_nearly_all_clips_are_kept_and_all_pairs_joined(count, nodes):
    group = graph(count, nodes)
    assert group.drawn.kept == len(group.clips) >= 0.95 * group.drawn.tried
    assert len({(clip.start, clip.end) for clip in group.clips}) == len(group.nodes) ** 2


@pytest.mark.exhaustive
def test_twenty_four_members_collide_often_and_are_parted():
    with pytest.warns(MocapWarning, match="nodes are within"):
        group = build_group(24, nodes=6)
    before, after = group.drawn.collided.mean(axis=0)
    assert before > 0.15 and after <= 0.03  # those that are not parted are dropped
    assert group.drawn.kept >= 0.95 * group.drawn.tried
    assert len({(clip.start, clip.end) for clip in group.clips}) == 36
    played = play_group(group, random_group_walk(group, 100))
    assert nearest_two(played.places).min() >= APART


def test_pushing_apart_is_needed_and_frees_all():
    """Of bent clips of twelve, some collide; none does afterwards."""
    before, after = graph().drawn.collided.mean(axis=0)
    assert before > 0.02 and after == 0


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
