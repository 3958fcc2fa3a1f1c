"""Features belong to the body; the table of all frames has one scale per group."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import concatenate, heading, place
from mocap.datasets.samples import sample
from mocap.errors import SkeletonMismatch
from mocap.methods.motion_matching import GROUPS, features
from mocap.methods.motion_matching.pose_database import (
    AHEAD,
    WEIGHTS,
    body_track,
    standardise,
    tabulate,
    turn_speeds,
)
from tests.bundled import clips
from tests.methods.motion_matching.matched import walks
from tests.refusals import refusals
from tests.strategies import wave


@given(st.fixed_dictionaries({name: st.floats(0.1, 10) for name in GROUPS}))
def test_each_group_spreads_as_its_weight_in_whatever_unit_it_is(units):
    unit = np.concatenate([np.full(columns.stop - columns.start, units[n]) for n, columns in GROUPS.items()])
    values, mean, scale = standardise(walks().values * unit)
    for name, columns in GROUPS.items():
        assert values[:, columns].std(axis=0).mean() == pytest.approx(WEIGHTS[name])
        assert len(set(scale[columns])) == 1
    np.testing.assert_allclose(values * scale + mean, walks().values * unit, atol=1e-9)


def test_rows_are_the_frames_of_the_clips_and_the_last_second_of_each_is_left_out():
    table = walks()
    lengths = [len(clip) for clip in table.clips]
    assert len(table) == sum(lengths)
    start = lengths[0] + 7
    np.testing.assert_array_equal(table.motion.rotations[start], table.clips[1].rotations[7])
    assert table.last[start] == lengths[0] + lengths[1] - 1
    assert (np.flatnonzero(~table.usable)[:30] == np.arange(lengths[0] - 30, lengths[0])).all()
    own = (features(table.clips[1])[7] - table.mean) / table.scale
    np.testing.assert_allclose(table.values[start], own, atol=1e-12)


def test_marks_that_a_clip_lacks_are_off_there():
    bare, marked = (replace(clip, contacts={}, labels={}) for clip in clips("walk_circle", "walk_curve_1"))
    marked = replace(marked, labels={"odd": np.ones(len(marked), bool)})
    table = tabulate([bare, marked])
    assert (
        table.motion.labels["odd"].sum() == len(marked) and not table.motion.labels["odd"][: len(bare)].any()
    )


def test_turn_speeds_are_those_of_a_steady_turn():
    (clip,) = clips("walk_circle")
    spun = replace(clip, rotations=np.tile([1.0, 0, 0, 0], (*clip.rotations.shape[:2], 1)))
    angle = np.arange(len(clip)) * 0.1 / 2
    turns = spun.rotations.copy()
    turns[:, 3] = np.stack([np.cos(angle), 0 * angle, np.sin(angle), 0 * angle], axis=-1)
    speeds = turn_speeds(replace(spun, rotations=turns))
    np.testing.assert_allclose(speeds[:, 3], [[0, 0.1 * clip.fps, 0]] * len(clip), atol=1e-9)
    assert not speeds[:, 4].any()


CLIP = clips("walk_circle")[0]
LARGE = replace(CLIP, skeleton=replace(CLIP.skeleton, offsets=2 * CLIP.skeleton.offsets))

test_what_makes_no_sense_is_refused_in_one_sentence = refusals(
    ("one clip or more, got none", tabulate, []),
    ("resample", tabulate, [sample("walk_circle"), CLIP]),
    (SkeletonMismatch, "bone", tabulate, [CLIP, LARGE]),
    ("No legs found", features, wave(40)),
    (r"longest, 'walk_circle', lasts 0.8", tabulate, [CLIP[:25]]),
    ("at least two frames", tabulate, [CLIP, CLIP[:1]]),
    ("never vary", tabulate, [concatenate([CLIP[:1]] * 60)]),
)


def test_they_are_the_same_wherever_a_clip_is_placed():
    (clip,) = clips("walk_curve_1")
    moved = place(clip, 2.5, [100.0, -30.0])
    np.testing.assert_allclose(features(moved), features(clip), atol=1e-9)


def test_they_say_where_the_body_will_be():
    """Placed by the track, the places ahead are the track itself some frames later."""
    (clip,) = clips("walk_circle")
    (ground, facing), values = body_track(clip), features(clip)
    ahead = values[:, GROUPS["places ahead"]].reshape(-1, 3, 2) @ [1j, 1]
    frames = np.arange(len(clip) - 30)
    for number, later in enumerate(np.round(AHEAD * 30).astype(int)):
        there = ground[frames] + np.exp(1j * facing[frames]) * ahead[frames, number]
        np.testing.assert_allclose(there, ground[frames + later], atol=1e-9)


def test_the_smoothed_track_does_not_sway():
    """Walking straight, the pelvis turns to and fro by 8 degrees; the track by half of it."""
    (clip,) = clips("walk_straight")
    swings = [np.ptp(track[30:200]) for track in (heading(clip.rotations[:, 0]), body_track(clip)[1])]
    assert swings[1] < 0.6 * swings[0]


def test_feet_on_the_left_are_left():
    (clip,) = clips("walk_straight")
    feet = features(clip)[:, GROUPS["feet"]]
    assert feet[:, 0].mean() > 0.03 > -0.03 > feet[:, 3].mean()
