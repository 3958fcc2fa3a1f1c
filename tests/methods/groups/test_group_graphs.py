"""Places, turns and members' numbers multiply up: hours of a crowd, smooth at each seam."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.planar import PlanarTransform
from mocap.methods.groups import GroupGraph, build_group, compare, make_clips, play_group, random_group_walk
from mocap.methods.groups.flocking import APART, RATE, Configuration, nearest_two
from mocap.methods.groups.group_clips import bend_to, run_from, separate
from mocap.methods.groups.tuned import TUNED
from tests.methods.groups.built import accelerations, flock, graph
from tests.refusals import refusals, told

every_graph = pytest.mark.parametrize(("count", "nodes"), [(12, 8), (6, 6)])


@every_graph
def test_400_seconds_at_random_never_collide_and_seams_are_as_smooth_as_all_else(count, nodes):
    """As in [LCF05, graph; playing]."""
    group = graph(count, nodes)
    walk = random_group_walk(group, 100, seed=3)
    played = play_group(group, walk)
    assert len(played.positions) == 4001
    assert nearest_two(played.positions).min() >= APART
    hard = accelerations(played.positions).max(axis=1)
    seams = np.arange(40, 4000, 40) - 1
    assert hard[seams].max() <= max(accelerations(clip.positions).max() for clip in group.clips)
    np.testing.assert_allclose(np.abs(np.diff(played.positions, axis=0)).max(), 0.15, atol=0.05)


def test_a_walk_starts_where_it_is_placed():
    group = graph(6, 6)
    walk = random_group_walk(group, 3)
    here, there = play_group(group, walk), play_group(group, walk, PlanarTransform(np.pi / 2, 2.0, 5.0))
    np.testing.assert_allclose(there.positions, 1j * here.positions + 5 + 2j, atol=1e-9)
    np.testing.assert_allclose(there.velocities, 1j * here.velocities, atol=1e-9)


def numbered(**ends):
    """Give the number of a clip of the group of six."""
    clips = enumerate(graph(6, 6).clips)
    return next(n for n, clip in clips if all(getattr(clip, end) == node for end, node in ends.items()))


def from_0_to_1_and_no_further():
    group = graph(6, 6)
    only = GroupGraph(group.nodes, (group.clips[numbered(start=0, end=1)],), group.tried)
    return random_group_walk(only, 5)


def much_too_near():
    node = graph(6, 6).nodes[0]
    return make_clips([Configuration(node.positions * 0.1, node.velocities)])


test_clips_and_walks_that_cannot_be_are_refused = refusals(
    ("No clip leaves node 1", from_0_to_1_and_no_further),
    ("one clip or more", lambda: play_group(graph(6, 6), [])),
    (
        "A group at node 1 cannot go on by .* leaves 0",
        lambda: play_group(graph(6, 6), [numbered(end=1), numbered(start=0)]),
    ),
    ("at node 1 .* leaves 2", lambda: play_group(graph(6, 6), [numbered(end=1), numbered(start=2)])),
    ("None of 15 clips can be kept: members come nearer than 0.6 m", much_too_near),
)


def test_pairs_without_a_clip_are_warned_of():
    nodes = graph(6, 6).nodes
    far = Configuration(nodes[1].positions * 8.0, nodes[1].velocities)
    told(r"No clip joins \d of 4 pairs of nodes", make_clips, [nodes[0], far])


def test_a_seed_gives_the_same_graph():
    few = {"nodes": 2, "corridors": [1.5], "simulated": 40.0, "reach": 0.8, "seed": 5}
    one, again = (build_group(4, **few) for _ in range(2))
    np.testing.assert_array_equal(one.clips[0].positions, again.clips[0].positions)
    assert one.members == 4 and len(flock(4).positions) == 1200


@every_graph
def test_clips_end_on_their_nodes_nobody_is_jerked_or_nearer_than_60_cm_and_bounds_hold_all(count, nodes):
    """As in [LCF05, clips] and [LCF05, bounds]."""
    group = graph(count, nodes)
    assert min(nearest_two(clip.positions).min() for clip in group.clips) >= APART
    assert max(accelerations(clip.positions).max() for clip in group.clips) <= TUNED.hardest
    for clip in group.clips[::9]:
        start, end = group.nodes[clip.start], group.nodes[clip.end]
        np.testing.assert_allclose(clip.positions[0], start.positions, atol=1e-12)
        np.testing.assert_allclose(clip.velocities[0], start.velocities, atol=1e-12)
        assert sorted(clip.order) == list(range(count))
        aligned = clip.rotation * end.positions[clip.order] + clip.translation
        np.testing.assert_allclose(clip.positions[-1], aligned, atol=1e-12)
        np.testing.assert_allclose(
            clip.velocities[-1], clip.rotation * end.velocities[clip.order], atol=1e-12
        )
        assert len(clip.positions) == 41
        centre, radius = clip.disc
        assert np.abs(clip.positions - centre).max() <= radius + 1e-12


@every_graph
def test_most_clips_are_kept_and_all_pairs_joined(count, nodes):
    """As in [LCF05, graph]."""
    group = graph(count, nodes)
    assert len(group.clips) >= 0.9 * group.tried
    assert len({(clip.start, clip.end) for clip in group.clips}) == len(group.nodes) ** 2


def test_drawn_to_its_place_each_member_comes_much_nearer_than_freely():
    """The constrained simulation [LCF05, clips]: what is left to bend is less than half."""
    nodes, bends = graph().nodes, np.zeros(8)
    starts = Configuration(*(np.tile(part, (8, 1)) for part in nodes[0]))
    free = run_from(starts, bends, np.random.default_rng(0))
    ends = Configuration(*(part[-1] for part in free))
    goal = nodes[-1]  # a column
    match = compare(ends, goal)
    places, velocities = (match.rotation[:, None] * part[match.order] for part in goal)
    goals = Configuration(places + match.translation[:, None], velocities)
    drawn = run_from(starts, bends, np.random.default_rng(0), goals)
    left = np.abs(drawn.positions[-1] - goals.positions)
    assert np.sqrt((left**2).mean()) < 0.5 * np.sqrt((np.abs(ends.positions - goals.positions) ** 2).mean())
    assert nearest_two(drawn.positions).min() >= APART


@given(st.complex_numbers(max_magnitude=2.0), st.complex_numbers(max_magnitude=1.0))
def test_bending_meets_place_and_velocity_and_keeps_the_start(missing, change):
    walked = Configuration(flock(6).positions[:41], flock(6).velocities[:41])
    goal = Configuration(walked.positions[-1] + missing, walked.velocities[-1] + change)
    bent = bend_to(walked, goal)
    np.testing.assert_allclose(bent[-1], goal.positions, atol=1e-9)
    np.testing.assert_allclose(bent[0], walked.positions[0], atol=1e-12)
    added = bent - walked.positions
    assert np.abs(added[1]).max() * RATE <= 0.1 * (abs(missing) + abs(change)) + 1e-9  # it starts at rest
    np.testing.assert_allclose((bent[-1] - bent[-2]) * RATE, goal.velocities, atol=1e-9)


def test_ends_do_not_move_when_members_are_pushed_apart_and_who_starts_too_near_cannot_be_freed():
    steps = np.linspace(0, 4, 41)
    crossing = np.stack([steps + 0.05j, 4 - steps - 0.05j], axis=1)
    free, done = separate(crossing)
    assert done and not separate(np.stack([steps, steps + 0.3j], axis=1))[1]
    np.testing.assert_array_equal(free[[0, 1, -2, -1]], crossing[[0, 1, -2, -1]])


def test_members_who_meet_for_a_moment_are_displaced_for_a_second_only():
    steps = np.linspace(0, 4, 41)
    paths = np.stack([steps + 0.1j, 4 - steps - 0.1j], axis=1)  # they meet in frame 20
    displacements = np.abs(separate(paths)[0] - paths)[:, 0]
    assert np.flatnonzero(displacements)[[0, -1]].tolist() == [14, 26]
    assert displacements.max() == pytest.approx(0.204, abs=1e-3)


def test_frames_near_the_fixed_ends_of_a_path_are_pushed_less():
    """Two members side by side, 0.5 m apart except at the ends."""
    steps = np.linspace(0, 4, 41)
    lateral = np.pad(np.full(35, 0.5), 3, constant_values=0.7)
    paths = np.stack([steps, steps + 1j * lateral], axis=1)
    pushed = (separate(paths)[0] - paths)[:, 1].imag
    assert pushed[[0, 1, -2, -1]].tolist() == [0, 0, 0, 0]
    assert (np.diff(pushed[1:6]) > 0).all() and (np.diff(pushed[-6:-1]) < 0).all()
    assert 0.08 < pushed[10:30].min() <= pushed[10:30].max() < 0.11
