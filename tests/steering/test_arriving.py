"""From one pose to another, at its place and in time: what is met, what it takes, and what is refused."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, resample
from mocap.body.planar import PlanarTransform, heading, lay_on, on_ground, place
from mocap.body.skeleton import Skeleton
from mocap.datasets import samples
from mocap.editing.displacements import difference
from mocap.errors import MocapWarning, NoWalk, SkeletonMismatch
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.motion_graph import from_transitions
from mocap.matching.transitions import Transition
from mocap.steering import end_bending, in_betweens, two_sided_search
from mocap.steering.end_bending import bend_to
from mocap.steering.in_betweens import in_between, meet_poses
from mocap.steering.two_sided_search import TwoSided, choices
from mocap.synthesis.random_walks import random_walk
from mocap.synthesis.walk_to_motion import require_walk, to_motion, with_plants
from tests.bundled import bundled, walking
from tests.conftest import SWEEP
from tests.editing.test_path_editing import slide
from tests.refusals import quietly, refusals

OWN = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight", "stop_and_go")


def accelerations(motions):
    parts = [np.diff(joint_positions(motion), 2, axis=0) for motion in motions]
    return np.percentile(np.linalg.norm(np.concatenate(parts), axis=-1), 99)


def ending(motion, frame, position, direction):
    """Lay a motion so that it ends with a frame at a place."""
    now = motion[frame : frame + 1]
    return lay_on(now, place(now, direction, position)).apply_motion(motion[: frame + 1])


def met(graph, start, end, seconds):
    """Hold a motion against every bar, measured on the motion itself."""
    found = quietly(in_between, graph, start, end, seconds)
    fps = found.motion.fps
    assert len(found.motion) == round(seconds * fps) + 1
    for frame, asked in ((0, start[:1]), (-1, end[-1 + len(end) :])):
        motion = found.motion
        assert np.linalg.norm(motion.root_positions[frame] - asked.root_positions[0]) <= 1e-3
        apart = float(heading(motion.rotations[frame, 0]) - heading(asked.rotations[0, 0]))
        assert abs(np.degrees((apart + np.pi) % (2 * np.pi) - np.pi)) <= 0.1
        assert np.degrees(rotations.angle_between(motion.rotations[frame], asked.rotations[0])).max() <= 0.1
    assert np.abs(found.arrived.turned).max() <= np.radians(60)
    for values in (found.arrived.steps, found.arrived.pace):
        assert values.min() >= 0.8 - 1e-6
        assert values.max() <= 1.25 + 1e-6
    assert slide(found.motion) <= 1e-4
    assert found.kept >= 0.85
    return found


def pair_that_clips_can_give(graph, seed):
    """Take two frames of a random walk: what is asked is what the clips give."""
    rng = np.random.default_rng(seed)
    seconds = rng.uniform(2.0, 6.0)
    walk = to_motion(graph, random_walk(graph, seconds=seconds + 1, seed=seed), clean=True)
    first, frames = int(rng.integers(5, 20)), round(seconds * graph.fps)
    return walk[first:], walk[: first + frames + 1], frames / graph.fps


def require_pairs(graph, seeds):
    compiled, plants = compile_graph(graph), with_plants(graph)
    for seed in seeds:
        start, end, seconds = pair_that_clips_can_give(plants, seed)
        found = met(compiled, start, end, seconds)
        # Clips differ, and a motion plays some of them: so it is measured against what it plays.
        assert accelerations([found.motion]) <= 1.3 * accelerations([to_motion(plants, found.walk)])


def test_what_the_clips_can_give_is_met():
    require_pairs(bundled(*OWN), range(20 if SWEEP else 3))


def asked_anywhere(graph, seed):
    """Ask for two frames of the clips at places that no walk was seen to join."""
    rng = np.random.default_rng(seed)
    one, other = (graph.source.clips[n] for n in rng.integers(len(graph.source.clips), size=2))
    seconds, way = float(rng.uniform(2.5, 6)), rng.uniform(-0.8, 0.8)
    metres = seconds * rng.uniform(0.55, 0.85)
    start = place(one[int(rng.integers(5, len(one) - 40)) :], 0.0, (0, 0))
    there = (metres * np.sin(way), metres * np.cos(way))
    frame, direction = int(rng.integers(40, len(other) - 5)), 2 * way + rng.uniform(-0.5, 0.5)
    return start, ending(other, frame, there, direction), seconds


def test_what_no_walk_gives_is_bent_and_still_met():
    graph = walking()
    for seed in range(6 if SWEEP else 3):
        start, end, seconds = asked_anywhere(graph, seed)
        require_walk(graph.source, met(graph, start, end, seconds).walk)


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_poses_of_a_clip_that_is_not_in_the_graph_are_met(fps):
    clip = resample(samples.sample("walk_straight"), fps)
    frames = [round(seconds * fps) for seconds in (1.0, 5.0)]
    # It walks faster than the graph's clips, and straight on where they turn: they need a second more.
    met(walking(), clip[frames[0] :], clip[: frames[1] + 1], 5.0)
    if fps == 30:  # poses alone, which do not say how fast they move
        met(walking(), *(clip[frame : frame + 1] for frame in frames), 5.0)


def test_plants_that_are_let_go_are_warned_of(monkeypatch):
    """A clean-up that lets the second half go: that of the package holds all, 6 cm above the clips, too."""
    graph = walking()
    clip = graph.source.clips[0]
    high = replace(clip, root_positions=clip.root_positions + np.array([0, 0.06, 0]))
    assert in_between(graph, high[40:], high[:131], 3.0).kept == 1

    def careless(motion):
        early = np.arange(len(motion)) < len(motion) / 2
        return replace(motion, contacts={joint: mark & early for joint, mark in motion.contacts.items()})

    monkeypatch.setattr(in_betweens, "stand", careless)
    with pytest.warns(MocapWarning, match="% of the planted frames are let go"):
        found = in_between(graph, clip[40:], clip[:131], 3.0)
    assert found.kept < 1


@pytest.mark.parametrize(("first", "last", "off"), [(300, 307, 2e-3), (200, 320, 5e-3)])
def test_a_clip_is_its_own_in_between_also_on_one_stretch(first, last, off):
    clip, seconds = walking().source.clips[0], (last - first) / 30
    found = met(walking(), clip[first:], clip[: last + 1], seconds)
    assert {walking().source.graph.edges[edge]["kind"] for edge in found.walk} == {"clip"}
    np.testing.assert_allclose(found.motion.root_positions, clip.root_positions[first : last + 1], atol=off)


# ---------------------------------------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("there", "direction", "seconds", "sentence"),
    [
        ((0, 30), 0.0, 2.0, r"walks end 2\d\.\d m from the place that is 30.0 m away: give about \d+\.\d s"),
        ((0, -1.5), 0.0, 1.0, "give about|another time"),
        ((0, 0.1), np.pi, 1.0, "give about|another time"),
        pytest.param((0, 9), 0.0, 5.0, r"give about \d+\.\d s", marks=pytest.mark.sweep),
    ],
)
def test_too_little_time_is_refused_with_what_would_help(there, direction, seconds, sentence):
    clip = walking().source.clips[0]
    start, end = place(clip[40:], 0.0, (0, 0)), ending(clip, 200, there, direction)
    with pytest.raises(NoWalk, match=sentence) as refused:
        in_between(walking(), start, end, seconds)
    assert len(str(refused.value)) <= 200
    if seconds == 5:  # and it does help
        more = float(str(refused.value).split("about ")[1].split(" s")[0]) + 1
        met(walking(), start, end, more)


def test_turns_beyond_the_limit_are_refused_with_what_would_help(monkeypatch):
    graph = walking()
    start, end, seconds = asked_anywhere(graph, 6)
    for module in (end_bending, in_betweens, two_sided_search):
        monkeypatch.setattr(module, "MOST_TURN", 0.02)
    monkeypatch.setattr(in_betweens, "POSE", 1.0)
    with pytest.raises(NoWalk, match=r"turned by \d+° per second; the limit is \d+°: give about"):
        in_between(graph, start, end, seconds)


CLIP = resample(samples.sample("walk_circle"), 30)
TURNED = rotations.multiply(CLIP.rotations[:, :1], rotations.from_rotvec([np.pi / 2, 0, 0]))
FALLEN = replace(CLIP, rotations=np.concatenate([TURNED, CLIP.rotations[:, 1:]], axis=1))
WHOLE = from_transitions([CLIP], [], window=10)
DOT = Motion(Skeleton(["root"], [-1], [[0, 0, 0]]), [[0, 0, 0]], [[[1, 0, 0, 0]]], 30.0)


def joined(start, end, seconds, graph=None):
    return in_between(graph or walking(), start, end, seconds)


test_what_has_no_in_between_is_refused = refusals(
    (NoWalk, "The first pose of .* nearest pose of the clips, and 0.1 m", joined, FALLEN[7:], CLIP[:91], 3.0),
    (NoWalk, r"leads from one pose to the other in 4\.0 s", joined, CLIP[700:], CLIP[:31], 4.0, WHOLE),
    *(
        (r"A motion lasts from 0\.07 to 120 s, got", joined, CLIP[3:], CLIP[:91], seconds)
        for seconds in (0.0, -1.0, np.nan, np.inf, 1e9)
    ),
    (SkeletonMismatch, "joints", joined, DOT, CLIP, 3.0),
)


# ---------------------------------------------------------------------------------------------- parts
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
        choices(graph, some, way=way, limit=np.inf) for some, way in ((clip[20:], 1), (clip[:161], -1))
    )
    found = TwoSided(graph, near, frames).best(1000)
    most = 1.25**0.85
    lengths = {tuple(edges): n for edges, n in every_walk(frames) if 1 / most <= n / frames <= most}
    walks = [tuple(joined.edges.tolist()) for joined in found]
    assert [joined.frames for joined in found] == [lengths[walk] for walk in walks]
    found, every = ({first_half(graph, walk, frames) for walk in some} for some in (walks, lengths))
    assert found == every
    for walk in walks:
        require_walk(graph.source, [graph.edges[edge] for edge in walk])


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
    np.testing.assert_allclose(bent.motion.root_positions[0], walk.root_positions[0], atol=1e-9)
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
    assert held.lack < 1e-3
    assert np.abs(held.turned).max() <= limit


def test_a_walk_that_is_played_slower_keeps_its_pace_at_both_ends():
    walk = samples.sample("walk_straight")[:101]
    slower = bend_to(walk, 111, on_ground(walk.root_positions[-1]), 0.0)
    assert len(slower.motion) == 111 and 0.87 < slower.pace.min() < 0.91
    assert slower.pace[[0, -1]] == pytest.approx([1, 1], abs=0.01)


def test_poses_fade_within_half_a_second_and_are_exact():
    clip = walking().source.clips[0]
    walk = clip[200:291]
    faded = meet_poses(walk, clip[201:], clip[:289])
    for frame, asked in ((0, 201), (-1, 288)):
        assert rotations.angle_between(faded.rotations[frame], clip.rotations[asked]).max() < 1e-6
    added = difference(faded, walk)
    assert np.abs(added.turns[15:-15]).max() == 0
    assert np.abs(added.root[15:-15]).max() == 0
