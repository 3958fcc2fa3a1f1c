"""Scenes that make no sense are refused; all clips at once are as free as one by one."""

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.methods.groups.flocking import APART
from mocap.methods.groups.group_graphs import Placed
from mocap.methods.groups.group_steering import steer_group
from mocap.methods.groups.planning import plan_group
from mocap.methods.groups.scenes import Exits, Obstacles, Scene
from tests.methods.groups.built import course, graph


@pytest.mark.parametrize(
    ("scene", "sentence"),
    [
        (Scene(()), "finite points z .* to pass, one or more"),
        (Scene(((3, 3),)), r"finite points z \+ ix to pass, one or more, from a start; got \(\(3, 3\),\)"),
        (Scene((complex(np.nan),)), "finite points"),
        (Scene((9j,), ((5j, 0.0),)), "a radius above 0"),
        (Scene((9j,), ((complex(np.inf), 1.0),)), "An obstacle has a centre"),
        (Scene((9j,), ((0.2 + 0.1j, 1.0),)), "starts inside the obstacle at x=0.1, z=0.2"),
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


def test_all_clips_at_once_are_as_free_as_one_by_one():
    random, group, found = np.random.default_rng(0), graph(), []
    others = (np.linspace(20, 0, 150)[:, None] + np.array([1j, -1j]),)
    scene = Scene((9 + 0j,), course(5).discs, others=others)
    exits = [Exits.of(group, node) for node in range(len(group.nodes))]
    for _ in range(40):
        node, frame = int(random.integers(len(group.nodes))), int(random.integers(200))
        spot = random.choice(scene.discs)[0] + random.normal(0, 5)
        at = Placed(node, np.exp(1j * random.uniform(-3, 3)), spot)
        rows = Obstacles(scene).free(exits[node], at, frame).tolist()
        assert rows == free_one_by_one(group, at, frame, scene)
        found.append(len(rows))
    assert min(found) < 10 and max(found) == 40
