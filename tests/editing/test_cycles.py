"""The best cycle in a clip: a stride, not a held pose; closed without a jump."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import concatenate, joint_positions, resample
from mocap.body.planar import align_frames, heading
from mocap.datasets import samples
from mocap.editing.cycles import Loop, _best, find_loop, loop, repeated, seam_jolt
from mocap.errors import MocapWarning
from mocap.feet.footplants import mark_plants
from mocap.files import load_save
from mocap.matching.point_clouds import point_cloud
from mocap.quality.seam_measures import jumps, sliding_per_frame
from tests.refusals import refusals
from tests.strategies import wave

WALK = resample(samples.sample("walk_straight"), 60)


def travelled(motion):
    """Return how far hands and feet go, seen from the root, metres."""
    places = joint_positions(motion) - motion.root_positions[:, None]
    ends = [motion.skeleton.index(name) for name in ("lfoot", "rfoot", "lhand", "rhand")]
    return np.linalg.norm(np.diff(places[:, ends], axis=0), axis=-1).sum()


def test_a_held_pose_is_no_cycle():
    """Of who walks, and then stands for five seconds: its seam is the smallest, and it goes nowhere."""
    bare = replace(WALK, contacts={}, labels={})
    clip = concatenate([bare, *[bare[-1:]] * 300], name="mostly held")
    found = find_loop(clip)
    assert found.seam > 1e-3 and travelled(clip[found.first : found.last + 1]) > 2.0


def test_a_cycle_moves_three_quarters_as_much_as_its_clip():
    """A stand, and then poses all around it, none of which returns: the stand alone would cost least."""
    poses = np.random.default_rng(0).normal(size=(60, 20))
    points = np.concatenate([np.zeros((40, 20)), poses])
    distances = np.linalg.norm(points[:, None] - points, axis=-1).astype(np.float32)
    first, length, _ = _best(distances, 6, 20)
    steps = np.diagonal(distances, 1)
    assert steps[first : first + length].mean() > 0.75 * steps.mean()
    assert first + length > 43


def test_bounds_that_only_a_held_pose_meets_give_a_held_pose():
    """All motion is in the first and the last frames: no cycle of 90 frames has three quarters of it."""
    places = np.cumsum(np.r_[0.0, np.ones(8), np.zeros(82), np.ones(9)])
    distances = np.abs(np.subtract.outer(places, places)).astype(np.float32)
    _, length, missed = _best(distances, 80, 90)
    assert 80 <= length <= 90
    assert np.isfinite(missed)


def test_the_jolt_of_a_seam_is_told():
    smooth = loop(WALK)
    roots = smooth.root_positions.copy()
    roots[-2] += [0, 0.1, 0]
    assert seam_jolt(WALK, smooth) < 1.5
    assert seam_jolt(WALK, replace(smooth, root_positions=roots)) > 5


@pytest.mark.parametrize("name", ["walk_straight", "walk_circle", "jog", "stop_and_go"])
def test_one_stride_is_found(name):
    clip = resample(samples.sample(name), 60)[:900]
    found = find_loop(clip)
    left = clip.contacts["lfoot"][found.first : found.last]
    steps = np.flatnonzero(np.diff(np.concatenate([left, left[:1]]).astype(int)) == 1)
    assert len(steps) == 1  # the left foot comes down once
    assert found.seam < 0.03


@pytest.mark.parametrize("clean", [False, True])
@pytest.mark.parametrize("straight", [False, True])
def test_rounds_go_on_without_a_jump(straight, clean):
    clip = resample(samples.sample("walk_circle"), 60)
    cycle = loop(clip, find_loop(clip), straight=straight, clean=clean)
    first, last = align_frames(cycle, cycle, len(cycle) - 1).apply_motion(cycle[:1]), cycle[-1:]
    assert np.abs(joint_positions(first) - joint_positions(last)).max() < 1e-9
    rounds = repeated(cycle, 4)
    for order in (2, 3):  # velocities, and accelerations
        mine, clips = (np.diff(point_cloud(motion), order, axis=0) for motion in (rounds, clip))
        assert (mine**2).sum(-1).mean(-1).max() < 1.1**2 * (clips**2).sum(-1).mean(-1).max()
    turn = np.unwrap(heading(cycle.rotations[:, 0]))
    assert (abs(turn[-1] - turn[0]) < 1e-9) == straight
    if straight:  # four rounds go four times as far, in one line
        ends = [np.subtract(*c.root_positions[[-1, 0]][:, [0, 2]]) for c in (cycle, rounds)]
        assert np.allclose(4 * ends[0], ends[1], atol=1e-9)


@pytest.mark.parametrize("name", ["walk_circle", "sneak"])
def test_feet_that_a_straight_path_turns_are_put_back(name):
    clip = resample(samples.sample(name), 30)
    found = find_loop(clip)
    slides = {
        clean: sliding_per_frame(
            mark_plants(repeated(loop(clip, found, straight=True, clean=clean), 3))
        ).sum()
        for clean in (False, True)
    }
    assert slides[False] > 3  # cm, all joints of the feet together
    assert slides[True] < 0.1 * slides[False]


def test_real_walks_and_runs(real_data):
    for name, least, most in (("02/02_01", 0.9, 1.4), ("16/16_35", 0.5, 1.0), ("16/16_15", 0.9, 2.6)):
        clip = load_save.load(real_data / f"cmu/{name}.amc")
        found = find_loop(clip)
        assert least < (found.last - found.first) / clip.fps < most
        rounds = repeated(loop(clip, found), 3)
        assert jumps(rounds).max() < 1.1 * jumps(clip).max()


test_what_cannot_be_looped_is_refused = refusals(
    *(
        (rf"'wave' lasts {long} s: to find a cycle takes 0\.6 to 300 s", find_loop, wave(frames))
        for frames, long in ((15, r"0\.467"), (1, "0"), (9100, "303"))
    ),
    *(
        ("from one bound to a larger one", lambda seconds=seconds: find_loop(wave(200), seconds=seconds))
        for seconds in ((2.0, 1.0), (0.0, 1.0), (0.1, 1.0), (1.0, np.inf), (np.nan, 1.0))
    ),
    *(
        (f"from frame {a} to {b} of 200 leaves no room for a seam of 6", loop, wave(200), Loop(a, b, 0, 0))
        for a, b in ((-1, 40), (40, 40), (0, 3), (0, 194), (50, 40))
    ),
    *(("cannot be repeated", repeated, WALK[:frames], times) for frames, times in ((9, 0), (9, -1), (1, 2))),
)


def test_plants_that_are_let_go_are_told_as_a_share_of_the_cycle():
    """The rounds around it are cleaned up as well, but their frames are nobody's."""
    leaps = 0.1 * np.outer(np.arange(len(WALK)) % 22 == 0, [0, 1, 0])
    shaken = replace(WALK, root_positions=WALK.root_positions + leaps, contacts={})
    with pytest.warns(MocapWarning) as caught:
        loop(shaken, find_loop(shaken), clean=True)
    (said,) = caught
    assert str(said.message).startswith("'walk_straight_loop': 18% of the planted frames are let go")


def test_a_clip_far_from_the_origin_has_the_same_cycle():
    """As recorded by a satellite's coordinates, 900 km from where they begin."""
    far = replace(WALK, root_positions=WALK.root_positions + np.array([5e5, 0, 9e5]))
    assert find_loop(far)[:2] == find_loop(WALK)[:2]
    assert find_loop(far)[2:] == pytest.approx(find_loop(WALK)[2:], rel=1e-4)
