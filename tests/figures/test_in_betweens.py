"""From one pose to another, at its place and in time: what is met, what it takes, and what is refused."""

from functools import cache

import in_betweens
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from in_betweens import end_bending, in_between, two_sided_search
from in_betweens.end_bending import bend_to

from mocap.body import resample, rotations
from mocap.body.planar import PlanarTransform, lay_on, on_ground, place
from mocap.datasets import samples
from mocap.errors import NoWalk
from mocap.graphs import compile_graph, from_transitions
from mocap.matching.transitions import Transition
from mocap.synthesis.walk_to_motion import require_walk
from tests.bundled import walking
from tests.conftest import SWEEP
from tests.editing.test_path_editing import slide
from tests.refusals import quietly


def met(start, end, seconds):
    """Hold a motion against every bar, measured on the motion itself."""
    graph = compile_graph(walking())
    found = quietly(in_between, graph, start, end, seconds)
    motion = found.motion
    assert len(motion) == round(seconds * motion.fps) + 1
    for frame, asked in ((0, start[:1]), (-1, end[-1 + len(end) :])):
        assert np.linalg.norm(motion.root_positions[frame] - asked.root_positions[0]) <= 1e-3
        assert np.degrees(rotations.angle_between(motion.rotations[frame], asked.rotations[0])).max() <= 0.1
    assert np.abs(found.arrived.turned).max() <= np.radians(60)
    for values in (found.arrived.steps, found.arrived.pace):
        assert values.min() >= 0.8 - 1e-6 and values.max() <= 1.25 + 1e-6
    assert slide(motion) <= 1e-4
    require_walk(graph.source, found.walk)
    return found


def ending(motion, frame, position, direction):
    """Lay a motion so that it ends with a frame at a place."""
    now = motion[frame : frame + 1]
    return lay_on(now, place(now, direction, position)).apply_motion(motion[: frame + 1])


def asked_anywhere(seed):
    """Ask for two frames of the clips at places that no walk was seen to join."""
    rng, clips = np.random.default_rng(seed), walking().source.clips
    one, other = (clips[n] for n in rng.integers(len(clips), size=2))
    seconds, way = float(rng.uniform(2.5, 6)), rng.uniform(-0.8, 0.8)
    metres = seconds * rng.uniform(0.55, 0.85)
    start = place(one[int(rng.integers(5, len(one) - 40)) :], 0.0, (0, 0))
    there = (metres * np.sin(way), metres * np.cos(way))
    frame, direction = int(rng.integers(40, len(other) - 5)), 2 * way + rng.uniform(-0.5, 0.5)
    return start, ending(other, frame, there, direction), seconds


def test_what_no_walk_gives_is_bent_and_still_met():
    for seed in range(1, 7 if SWEEP else 3):
        met(*asked_anywhere(seed))


def test_a_clip_is_its_own_in_between():
    clip = walking().source.clips[0]
    found = met(clip[200:], clip[:321], 4.0)
    np.testing.assert_allclose(found.motion.root_positions, clip.root_positions[200:321], atol=5e-3)


def test_poses_of_a_clip_that_is_not_in_the_graph_are_met_at_its_own_rate():
    clip = samples.sample("walk_straight")
    met(clip[140:], clip[:601], 5.0)


def test_what_cannot_be_met_is_refused(monkeypatch):
    graph, clip = compile_graph(walking()), walking().source.clips[0]
    with pytest.raises(NoWalk, match=r"No walk leads from one pose to the other in 2\.0 s"):
        in_between(graph, place(clip[40:], 0.0, (0, 0)), ending(clip, 200, (0, 30), 0.0), 2.0)
    monkeypatch.setattr(in_betweens, "POSE", 1e-6)
    with pytest.raises(NoWalk, match=r"The first pose of .* m is the limit"):
        in_between(graph, resample(samples.sample("walk_straight"), 30)[30:], clip, 2.0)


def tiny():
    """Make a graph so small that all its walks can be listed."""
    clip = resample(samples.sample("walk_circle"), 30)[:200]
    moves = [(40, 90), (60, 150), (100, 30), (120, 60), (140, 110)]
    ways = [PlanarTransform(0.2 * n, 0.1 * n, 0.3) for n in range(len(moves))]
    found = [Transition(0, i, 0, j - 10, 0.02, way) for (i, j), way in zip(moves, ways, strict=True)]
    return compile_graph(from_transitions([clip], found, window=10))


@cache
def every_walk(frames):
    """List the walks of the tiny graph from frame 20 to frame 160 in so many frames, slowly and clearly."""
    graph, found = tiny(), []

    def go(edges, length):
        node, goal = graph.edges[edges[-1]][1], (0, 160)
        for number, (start, end, _) in enumerate(graph.edges):
            if start != node or length > 1.25 * frames:
                continue
            if not graph.blended[number] and start[1] <= goal[1] < end[1]:
                found.append(([*edges, number], length + goal[1] - start[1]))
            go([*edges, number], length + int(graph.frames[number]))

    first = next(n for n, (a, b, _) in enumerate(graph.edges) if a[1] <= 20 < b[1] and not graph.blended[n])
    go([first], graph.edges[first][1][1] - 20)
    return found


def first_half(graph, edges, frames):
    """Give a walk's edges up to the first point at half of the frames or later."""
    ends = np.cumsum([graph.edges[edges[0]][1][1] - 20, *(int(graph.frames[edge]) for edge in edges[1:])])
    return tuple(edges[: int((ends >= frames / 2).argmax()) + 1])


@pytest.mark.parametrize("frames", [100, 140, 200])
def test_the_search_finds_an_end_for_every_first_half_that_a_full_search_finds(monkeypatch, frames):
    graph = tiny()
    clip = graph.source.clips[0]
    monkeypatch.setattr(two_sided_search, "MOST", 1)
    near = tuple(
        two_sided_search.choices(graph, some, way=way, limit=np.inf)
        for some, way in ((clip[20:], 1), (clip[:161], -1))
    )
    found = two_sided_search.TwoSided(graph, near, frames).best(1000)
    most = 1.25**0.85
    lengths = {tuple(edges): n for edges, n in every_walk(frames) if 1 / most <= n / frames <= most}
    walks = [tuple(joined.edges.tolist()) for joined in found]
    assert [joined.frames for joined in found] == [lengths[walk] for walk in walks]
    found, every = ({first_half(graph, walk, frames) for walk in some} for some in (walks, lengths))
    assert found == every


@settings(max_examples=15)
@given(x=st.floats(-0.8, 0.8), z=st.floats(-0.4, 0.4), turn=st.floats(-0.8, 0.8))
@example(x=0.0, z=0.0, turn=0.0)
def test_a_walk_is_bent_to_any_end_near_its_own(x, z, turn):
    walk = samples.sample("walk_straight")[:481:4]
    bent = bend_to(walk, len(walk), on_ground(walk.root_positions[-1]) + z + 1j * x, turn)
    assert bent.lack < 1e-4 and (bent.pace == 1).all()
    assert abs(bent.turned.sum() / walk.fps - turn) < 1e-6
    assert np.abs(bent.turned[[0, -1]]).max() < 0.05  # radians per second: level at both ends
    assert np.abs(bent.steps[[0, -1]] - 1).max() < 0.02
    if x == z == turn == 0:
        np.testing.assert_allclose(bent.motion.root_positions, walk.root_positions, atol=1e-6)


def test_turning_is_held_to_its_limit_where_there_is_a_way(monkeypatch):
    walk = samples.sample("walk_straight")[:481:4]
    end = on_ground(walk.root_positions[-1]) + 1.2j
    monkeypatch.setattr(end_bending, "MOST_TURN", 10.0)
    free = bend_to(walk, len(walk), end, 0.0)
    limit = 0.9 * np.abs(free.turned).max()
    monkeypatch.setattr(end_bending, "MOST_TURN", limit)
    held = bend_to(walk, len(walk), end, 0.0)
    assert held.lack < 1e-3 and np.abs(held.turned).max() <= limit
