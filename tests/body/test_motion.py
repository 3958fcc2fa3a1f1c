"""What a motion refuses; slices, rates and sequences of motions."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import concatenate, resample, rotations
from mocap.errors import SkeletonMismatch
from tests.refusals import refusals
from tests.strategies import random_motion, seeds, wave


def bad_rotations(motion, value):
    changed = motion.rotations.copy()
    changed[3, 2] = value
    return changed


def changed(**fields):
    return replace(random_motion(0), **fields)


GIVEN = random_motion(0)

test_a_bad_motion_is_refused = refusals(
    ("has no frames", lambda: changed(root_positions=np.zeros((0, 3)))),
    (r"got \(4, 3\) and \(5, 6, 4\)", lambda: changed(root_positions=GIVEN.root_positions[:4])),
    (r"got \(5, 3\) and \(5, 5, 4\)", lambda: changed(rotations=GIVEN.rotations[:, :5])),
    ("not finite in frame 3", lambda: changed(rotations=bad_rotations(GIVEN, np.nan))),
    ("frame 3, joint 'joint2'.*length 1", lambda: changed(rotations=bad_rotations(GIVEN, 0.9))),
    ("frame rate above 0, got 0", lambda: changed(fps=0)),
    ("frame rate above 0", lambda: changed(fps=np.inf)),
    ("No joint 'tail'", lambda: changed(contacts={"tail": True})),
    (r"'walk' needs 5 booleans, got shape \(2,\)", lambda: changed(labels={"walk": [True, False]})),
    ("forwards only; got a step of -1", lambda: GIVEN[::-1]),
    ("no frames", lambda: GIVEN[4:4]),
    ("above 0, got -3", resample, GIVEN, -3),
    ("one clip or more, got none", concatenate, []),
    ("30 Hz, 'wave' at 60 Hz", concatenate, [wave(3), replace(wave(3), fps=60)]),
    (SkeletonMismatch, "'random1' and 'wave': The skel", concatenate, [random_motion(1), wave(3)]),
)


def test_a_single_boolean_marks_every_frame():
    walk = replace(random_motion(0), labels={"walk": True})
    assert walk.labels["walk"].tolist() == [True] * 5


def test_a_motion_can_be_copied_and_sent_to_another_process():
    motion = random_motion(1)
    for twin in (copy.deepcopy(motion), pickle.loads(pickle.dumps(motion))):
        assert np.array_equal(twin.rotations, motion.rotations)


def test_slices_keep_marks_and_divide_the_rate():
    motion = random_motion(2, frames=9)
    part = motion[2:8:3]
    assert len(part) == 2
    assert part.fps == 10
    assert np.array_equal(part.rotations, motion.rotations[[2, 5]])
    assert np.array_equal(part.contacts["joint5"], motion.contacts["joint5"][[2, 5]])


@given(seeds, st.integers(2, 5))
def test_resampling_up_and_back_down_gives_the_motion_back(seed, factor):
    motion = random_motion(seed)
    back = resample(resample(motion, motion.fps * factor), motion.fps)
    assert len(back) == len(motion)
    assert back.root_positions == pytest.approx(motion.root_positions, abs=1e-9)
    assert rotations.angle_between(back.rotations, motion.rotations) == pytest.approx(0, abs=1e-6)
    assert np.array_equal(back.contacts["joint5"], motion.contacts["joint5"])


@given(st.floats(1, 500), st.integers(1, 200))
def test_resampling_keeps_the_duration_to_a_frame(fps, frames):
    after = resample(wave(frames), fps)
    assert after.duration <= wave(frames).duration + 1e-6
    assert after.duration > wave(frames).duration - 1 / fps


def test_resampling_a_smooth_motion_stays_on_it():
    coarse, fine = wave(100), resample(wave(100), 117.0)
    t = 2 * np.pi * np.arange(len(fine)) / 117 * 30 / 40
    assert fine.root_positions[:, 1] == pytest.approx(1 + 0.02 * np.sin(2 * t), abs=5e-3)
    assert fine.name == coarse.name
    assert resample(coarse, coarse.fps) is coarse
    assert wave(31).duration == 1.0


def test_concatenation_keeps_frames_and_fills_missing_marks():
    skeleton = random_motion(0).skeleton
    a = random_motion(1, 3, skeleton=skeleton)
    b = replace(random_motion(2, 2, skeleton=skeleton), contacts={})
    both = concatenate([a, replace(b, labels={"run": True})], "both")
    assert both.name == "both"
    assert np.array_equal(both.rotations, np.concatenate([a.rotations, b.rotations]))
    assert both.labels["run"].tolist() == [False] * 3 + [True] * 2
    assert both.contacts["joint5"].tolist() == [*a.contacts["joint5"], False, False]
