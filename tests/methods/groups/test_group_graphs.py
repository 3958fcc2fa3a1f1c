"""Places, turns and members' numbers multiply up: hours of a crowd, smooth at each seam."""

import numpy as np
import pytest

from mocap.errors import MocapWarning
from mocap.methods.groups import GroupGraph
from mocap.methods.groups.configurations import Configuration
from mocap.methods.groups.flocking import APART, nearest_two
from mocap.methods.groups.group_clips import accelerations
from mocap.methods.groups.group_graphs import Placed, build_group, make_clips, play_group, random_group_walk
from tests.methods.groups.built import flock, graph
from tests.refusals import refused

every_graph = pytest.mark.parametrize(("count", "nodes"), [(12, 8), (6, 6)])


@every_graph
def test_400_seconds_at_random_never_collide_and_seams_are_as_smooth_as_all_else(count, nodes):
    """As in [LCF05, graph; playing]."""
    group = graph(count, nodes)
    walk = random_group_walk(group, 100, seed=3)
    played = play_group(group, walk)
    assert len(played.places) == 4001
    assert nearest_two(played.places).min() >= APART
    hard = accelerations(played.places).max(axis=1)
    seams = np.arange(40, 4000, 40) - 1
    assert hard[seams].max() <= max(accelerations(clip.places).max() for clip in group.clips)
    np.testing.assert_allclose(np.abs(np.diff(played.places, axis=0)).max(), 0.15, atol=0.05)


def test_a_walk_starts_where_it_is_placed():
    group = graph(6, 6)
    walk = random_group_walk(group, 3)
    here, there = play_group(group, walk), play_group(group, walk, Placed(0, 1j, 5 + 2j))
    np.testing.assert_allclose(there.places, 1j * here.places + 5 + 2j, atol=1e-9)
    np.testing.assert_allclose(there.velocities, 1j * here.velocities, atol=1e-9)


def test_a_node_that_no_clip_leaves_ends_a_random_walk():
    group = graph(6, 6)
    only = GroupGraph(group.nodes, tuple(c for c in group.clips if c.end == 1 and c.start == 0), group.tried)
    refused("No clip leaves node 1", random_group_walk, only, 5)


@pytest.mark.parametrize(
    ("walk", "start", "sentence"),
    [
        ([], None, "one clip or more"),
        ([0], Placed(1), "A group at node 1 cannot go on by a clip that leaves 0"),
    ],
)
def test_walks_that_are_none_are_refused(walk, start, sentence):
    refused(sentence, play_group, graph(6, 6), walk, start)


def test_clips_that_do_not_follow_one_another_are_refused():
    group = graph(6, 6)
    to_one = next(n for n, clip in enumerate(group.clips) if clip.end == 1)
    from_two = next(n for n, clip in enumerate(group.clips) if clip.start == 2)
    refused("A group at node 1 cannot go on by a clip that leaves 2", play_group, group, [to_one, from_two])


def test_bends_that_are_too_sharp_leave_no_clip_and_it_says_why():
    nodes = graph(6, 6).nodes
    close = Configuration(nodes[0].places * 0.1, nodes[0].velocities)
    refused(r"None of 3 clips can be kept: members come nearer than 0.6 m", make_clips, [close], bends=[0.0])


def test_pairs_without_a_clip_are_warned_of():
    nodes = graph(6, 6).nodes
    far = Configuration(nodes[1].places * 8.0, nodes[1].velocities)
    with pytest.warns(MocapWarning, match=r"No clip joins \d of 4 pairs of nodes"):
        make_clips([nodes[0], far], bends=[0.0])


def test_a_seed_gives_the_same_graph():
    few = {"nodes": 2, "corridors": [1.5], "simulated": 40.0, "reach": 0.8, "seed": 5}
    one, again = (build_group(4, **few) for _ in range(2))
    np.testing.assert_array_equal(one.clips[0].places, again.clips[0].places)
    assert one.members == 4 and len(flock(4).places) == 1200
