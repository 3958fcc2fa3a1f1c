"""From one pose to another, at its position and in time: what is met, what it takes, and what is refused."""

import numpy as np
import pytest

from mocap.body import resample, rotations
from mocap.body.planar import align_frames, place
from mocap.datasets import samples
from mocap.errors import NoWalk
from mocap.graphs import compile_graph
from mocap.methods.in_betweening import fill_gap, in_between, in_betweens
from mocap.synthesis.walk_to_motion import require_walk
from tests.bundled import walking
from tests.conftest import SWEEP
from tests.editing.test_path_editing import slide
from tests.refusals import quietly
from tests.tuning import tune


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
    return align_frames(now, place(now, direction, position)).apply_motion(motion[: frame + 1])


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
    """Request 18 ends on a straight leg: without its last step it slides by 0.74 mm."""
    for seed in (*range(1, 13), 18) if SWEEP else (1, 18):
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
    with pytest.raises(NoWalk, match=r"from one pose to the other, 30\.0 m in 2\.0 s"):
        in_between(graph, place(clip[40:], 0.0, (0, 0)), ending(clip, 200, (0, 30), 0.0), 2.0)
    tune(monkeypatch, in_betweens, pose=1e-6)
    with pytest.raises(NoWalk, match=r"The first pose of .* m is the limit"):
        in_between(graph, resample(samples.sample("walk_straight"), 30)[30:], clip, 2.0)


@pytest.mark.parametrize("seconds", [1.0, 2.5])
def test_a_gap_continues_the_motion_on_both_sides(seconds):
    """A clip that is not in the graph: the root keeps its speed at both ends, within 0.15 m/s."""
    clip = samples.sample("walk_straight")[100:900]
    stop = 240 + round(seconds * 120)
    found = quietly(fill_gap, compile_graph(walking()), clip[:241], clip[stop:], seconds).motion
    for frame, asked in ((0, 240), (-1, stop)):
        assert np.linalg.norm(found.root_positions[frame] - clip.root_positions[asked]) < 1e-6
        assert rotations.angle_between(found.rotations[frame], clip.rotations[asked]).max() < 1e-6
    speeds = np.linalg.norm(np.diff(found.root_positions, axis=0), axis=1) * found.fps
    beside = np.linalg.norm(np.diff(clip.root_positions, axis=0), axis=1) * clip.fps
    assert abs(speeds[0] - beside[239]) < 0.15 and abs(speeds[-1] - beside[stop]) < 0.15
    assert slide(found) <= 1e-4


def test_a_gap_beside_single_frames_is_filled():
    clip = walking().source.clips[0]
    found = quietly(fill_gap, compile_graph(walking()), clip[200:201], clip[260:261], 2.0).motion
    np.testing.assert_allclose(found.root_positions[[0, -1]], clip.root_positions[[200, 260]], atol=1e-6)
