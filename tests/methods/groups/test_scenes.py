"""Scenes that make no sense are refused; all clips at once are as free as one by one."""

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.methods.groups.configurations import Configuration
from mocap.methods.groups.flocking import APART
from mocap.methods.groups.group_graphs import Placed
from mocap.methods.groups.group_steering import steer_group
from mocap.methods.groups.planning import plan_group
from mocap.methods.groups.scenes import Exits, Obstacles, Scene
from tests.methods.groups.built import course, graph


@pytest.mark.parametrize(
    ("scene", "sentence"),
    [
        (Scene(()), "to pass or more"),
        (Scene(((3, 3),)), r"one complex number z \+ ix, got \(3, 3\)"),
        (Scene((complex(np.nan),)), "all finite"),
        (Scene((9j,), ((5j, 0.0),)), "a radius above 0"),
        (Scene((9j,), ((complex(np.inf), 1.0),)), "An obstacle has a centre"),
        (Scene((9j,), ((0.2 + 0.1j, 1.0),)), "starts inside the obstacle at x=0.1, z=0.2"),
        (Scene((9j,), near=0.0), "passed within more than 0 m .* got 0.0 m and 0.3 m"),
        (Scene((9j,), body=np.nan), "got 1.0 m and nan m"),
        (Scene((9j,), others=(np.zeros(5, complex),)), "Other groups are finite places in a table"),
        (Scene((9j,), others=(np.zeros((5, 0), complex),)), "frames by members, one or more"),
        (Scene((9j,), others=(np.full((5, 2), np.nan + 0j),)), "Other groups are finite places"),
    ],
)
def test_scenes_that_make_no_sense_are_refused(scene, sentence):
    with pytest.raises(MocapError, match=sentence):
        plan_group(graph(), scene)
    with pytest.raises(MocapError, match=sentence):
        steer_group(graph().nodes[0], scene)


def free_one_by_one(group, at, frame, scene):
    """Lay each clip on the ground, and look at all members in all frames; `Obstacles` looks at once."""
    kept = []
    for row, number in enumerate(group.leaving(at.node)):
        places = at.turn * group.clips[number].places + at.move
        clear = all((np.abs(places - spot) >= size + scene.body).all() for spot, size in scene.discs)
        for other in scene.others:
            there = other[np.minimum(frame + np.arange(len(places)), len(other) - 1)]
            clear = clear and (np.abs(places[:, :, None] - there[:, None]) >= APART).all()
        if clear:
            kept.append(row)
    return kept


@pytest.mark.parametrize("bounds", [True, False])
def test_all_clips_at_once_are_as_free_as_one_by_one(bounds):
    random, group, found = np.random.default_rng(0), graph(), []
    others = (np.linspace(20, 0, 150)[:, None] + np.array([1j, -1j]),)
    scene = Scene((9 + 0j,), course(5).discs, others=others)
    exits = [Exits(group, node) for node in range(len(group.nodes))]
    for _ in range(40):
        node, frame = int(random.integers(len(group.nodes))), int(random.integers(200))
        spot = random.choice(scene.discs)[0] + random.normal(0, 5)
        at = Placed(node, np.exp(1j * random.uniform(-3, 3)), spot)
        rows = Obstacles(scene, bounds=bounds).free(exits[node], at, frame).tolist()
        assert rows == free_one_by_one(group, at, frame, scene)
        found.append(len(rows))
    assert min(found) < 10 and max(found) == 40


def test_who_starts_nowhere_is_refused():
    start = Configuration(np.full(2, np.nan, complex), np.ones(2, complex))
    with pytest.raises(MocapError, match="A group starts at a finite place, got"):
        steer_group(start, Scene((9j,)))
