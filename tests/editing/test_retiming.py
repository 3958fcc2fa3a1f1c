"""Warping in time: time rises, slow motion stays smooth, and a cycle closes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from mocap.body import joint_positions, resample
from mocap.datasets.samples import sample
from mocap.editing.retiming import at_frames, retime
from tests.editing.wishes import accelerations, body
from tests.refusals import refusals
from tests.strategies import wave

WALK = sample("walk_straight")[240:721]


rising = st.lists(st.integers(1, 100), min_size=1, max_size=6).map(lambda gaps: np.cumsum([0, *gaps]))


@given(st.tuples(rising, rising))
def test_time_always_rises_and_meets_its_keys(both):
    """As in [WP95, time warp]."""
    count = min(map(len, both))
    new, old = (frames[:count] for frames in both)
    clock = wave(old[-1] + 1)
    clock = replace(clock, root_positions=np.arange(len(clock))[:, None] * [0.0, 0.0, 1.0])
    shown = retime(clock, list(zip(new / clock.fps, old / clock.fps, strict=True))).root_positions[:, 2]
    assert shown[new] == pytest.approx(old)
    assert np.diff(shown).min() > 0


def test_one_pace_is_the_clip_itself_and_back_again_is_where_it_began():
    """As in [WP95, time warp]."""
    same = retime(WALK, [(0, 0), (WALK.duration, WALK.duration)])
    assert joint_positions(same) == pytest.approx(joint_positions(WALK), abs=1e-9)
    keys = [(0, 0), (3, 2), (4.5, 4)]
    new = np.linspace(0, 4.5, 91)
    old = PchipInterpolator(*np.transpose(keys))(new)
    back = retime(retime(WALK, keys), list(zip(old, new, strict=True)))
    gap = joint_positions(back)[:, body(WALK)] - joint_positions(WALK)[:, body(WALK)]
    assert len(back) == len(WALK)
    assert np.linalg.norm(gap, axis=-1).max() < 0.003  # metres


def test_the_marks_come_from_the_nearest_frame():
    slow = retime(WALK, [(0, 0), (8, 4)])
    assert slow.duration == 8
    for joint, mark in WALK.contacts.items():
        assert slow.contacts[joint].mean() == pytest.approx(mark.mean(), abs=0.01)
    assert slow.labels["walk"].all()


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_slow_motion_is_smooth(fps):
    """By slerp it would jolt by half as much again."""
    source = resample(WALK, fps)
    slow = replace(at_frames(source, np.arange(0, len(source) - 1, 0.25)), fps=4 * fps)
    assert accelerations(slow) < 1.1 * accelerations(WALK)


def test_a_steady_glide_stays_steady_up_to_both_ends():
    motion = replace(WALK[:9], root_positions=np.arange(9)[:, None] * [0.0, 0.0, 1.0])
    assert at_frames(motion, [0.25, 3.5, 7.75]).root_positions[:, 2] == pytest.approx([0.25, 3.5, 7.75])


test_times_that_cannot_be = refusals(
    ("two or more pairs", retime, WALK, []),
    (r"pairs \(new, old second\) that rise, got \[\(0, 0\)\]", retime, WALK, [(0, 0)]),
    ("that rise", retime, WALK, [(0, 0), (1, np.nan)]),
    ("that rise", retime, WALK, [(0, 0), (1, 2), (2, 2)]),
    ("that rise", retime, WALK, [(0, 0), (2, 1), (1, 2)]),
    ("Second 4.5 is not on 'walk_straight', which lasts 4 s", retime, WALK, [(0, 0), (1, 4.5)]),
    ("Second -0.5 is not on", retime, WALK, [(0, -0.5), (1, 2)]),
    (r"ask for 1.2e\+11 frames; at most 1000000", retime, WALK, [(0, 0), (1e9, 4)]),
)
