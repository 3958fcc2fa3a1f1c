"""A group motion graph comes back from its file bit for bit, and plans the same ways."""

from dataclasses import fields, replace

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.methods.groups import (
    GroupGraph,
    lead_group,
    load_group,
    plan_group,
    play_group,
    random_group_walk,
    save_group,
)
from tests.methods.groups.built import around, course, graph
from tests.refusals import refused


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("groups") / "six.npz"
    save_group(graph(6, 6), path)
    return path


def changed(saved, path, **arrays):
    """Write the file again with other arrays; None takes one out."""
    with np.load(saved) as archive:
        new = {**archive, **arrays}
    np.savez(path, **{key: array for key, array in new.items() if array is not None})
    return path


def test_a_graph_comes_back_bit_for_bit(saved):
    group, back = graph(6, 6), load_group(saved)
    assert (back.members, back.tried, len(back.nodes)) == (group.members, group.tried, len(group.nodes))
    for ours, theirs in zip(group.nodes, back.nodes, strict=True):
        assert all(map(np.array_equal, ours, theirs))
    for ours, theirs in zip(group.clips, back.clips, strict=True):
        for field in fields(ours):
            one, other = getattr(ours, field.name), getattr(theirs, field.name)
            assert np.array_equal(one, other) and type(one) is type(other), field.name


def test_walks_and_plans_are_the_same_to_the_bit(saved):
    group, back = graph(6, 6), load_group(saved)
    walk = random_group_walk(group, 40, seed=2)
    assert random_group_walk(back, 40, seed=2) == walk
    assert all(map(np.array_equal, play_group(group, walk), play_group(back, walk)))
    scene = course(3, points=2, discs=3)
    assert plan_group(group, scene) == plan_group(back, scene)
    led = [lead_group(some, around(1)) for some in (group, back)]
    assert led[0][1] == led[1][1] and all(map(np.array_equal, led[0][0], led[1][0]))


def test_a_graph_saved_again_is_the_same_file(saved, tmp_path):
    save_group(load_group(saved), tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == saved.read_bytes()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda arrays: {"places": None}, "one without places"),
        (lambda arrays: {"places": arrays["places"].real}, "'places' to fit the other arrays"),
        (lambda arrays: {"orders": arrays["orders"][:, 1:]}, "'orders' to fit the other arrays"),
        (lambda arrays: {"turns": np.nan * arrays["turns"]}, "that numbers are finite"),
        (lambda arrays: {"velocities": 1e9 * arrays["velocities"]}, "that numbers are finite"),
        (lambda arrays: {"node_velocities": 0 * arrays["node_velocities"]}, "that nodes go somewhere"),
        (lambda arrays: {"tried": np.array(3)}, "that as many clips were tried or more"),
        (lambda arrays: {"ends": arrays["ends"] + 99}, "that clips lead from node to node"),
        (lambda arrays: {"starts": arrays["starts"] - 99}, "that clips lead from node to node"),
        (lambda arrays: {"orders": 0 * arrays["orders"]}, "that members keep their numbers apart"),
        (lambda arrays: {"turns": 1.1 * arrays["turns"]}, "that rotations have length 1"),
        (lambda arrays: {"places": arrays["places"] + 0.1}, "that clips begin at their nodes"),
        (lambda arrays: {"moves": arrays["moves"] + 0.1}, "that clips end at their nodes"),
        (lambda arrays: {"orders": arrays["orders"][:, ::-1]}, "that clips end at their nodes"),
        (lambda arrays: {"places": arrays["places"][:, :1], "velocities": arrays["places"][:, :1]}, "frames"),
    ],
)
def test_a_damaged_file_is_refused_with_what_is_wrong(saved, tmp_path, change, words):
    with np.load(saved) as archive:
        path = changed(saved, tmp_path / "bad.npz", **change(dict(archive)))
    refused(words, load_group, path, kind=FormatError)


def test_a_graph_whose_clips_do_not_lead_from_node_to_node_is_not_written(tmp_path):
    group = graph(6, 6)
    clip = replace(group.clips[0], translation=group.clips[0].translation + 1)
    broken = GroupGraph(group.nodes, (clip,), 1)
    words = "Cannot save a group motion graph: expected that clips end at their nodes"
    refused(words, save_group, broken, tmp_path / "group.npz")
    assert not list(tmp_path.iterdir())
    refused("written as .npz, got", save_group, group, tmp_path / "group.json")
