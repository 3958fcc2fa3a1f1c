"""Keys are met and nothing changes outside them; slow motion stays smooth; and what a change is."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from mocap.body import joint_positions, resample, rotations
from mocap.datasets.samples import sample
from mocap.editing.displacements import Displacement, difference, displaced, spline_basis
from mocap.editing.keys import Key, cardinal, keys_around, offsets, scaled
from mocap.editing.retiming import at_frames, retime
from mocap.errors import SkeletonMismatch
from tests.editing.wishes import accelerations, body
from tests.refusals import refusals, refused
from tests.strategies import random_motion, seeds, wave

WALK = sample("walk_straight")[240:481]


def moved(motion, frame, *, joint="lhumerus", turn=(0.0, 0.0, 1.0), up=0.0):
    """Return one frame of a motion with a joint turned and the root lifted."""
    pose = motion[frame : frame + 1]
    turned = pose.rotations.copy()
    number = motion.skeleton.index(joint)
    turned[:, number] = rotations.multiply(turned[:, number], rotations.from_rotvec(turn))
    return replace(pose, rotations=turned, root_positions=pose.root_positions + np.array([0, up, 0]))


def test_the_curve_through_unevenly_spaced_keys():
    """As in [WP95, splines]."""
    at, values = [0, 10, 30], [0, 1, -1]
    assert cardinal(at, values, [5, 15, 20], tension=1.0) == pytest.approx([0.5, 0.6875, 0.0])
    assert cardinal(at, values, [5, 15, 20], flat=[1]) == pytest.approx([0.5, 0.6875, 0.0])


@given(st.lists(st.integers(1, 30), min_size=0, max_size=5), seeds)
def test_a_curve_meets_its_keys_is_level_outside_and_smooth(gaps, seed):
    at = np.cumsum([3, *gaps])
    values = np.random.default_rng(seed).normal(size=(len(at), 2, 3))
    assert cardinal(at, values, at) == pytest.approx(values, abs=1e-12)
    assert cardinal(at, values, [-50, at[0]]) == pytest.approx(np.stack([values[0]] * 2))
    assert cardinal(at, values, [at[-1] + 9]) == pytest.approx(values[-1:])
    step = 1e-4
    slope = np.diff(cardinal(at, values, np.arange(at[0] - 1, at[-1] + 1, step)), axis=0) / step
    assert np.abs(np.diff(slope, axis=0)).max() < 0.02  # C¹: slopes do not jump at the keys


def test_a_key_is_met_and_nothing_changes_outside():
    """As in [WP95, offset]."""
    pose = moved(WALK, 120, up=0.05)
    change = offsets(WALK, keys_around(WALK, [Key(120, pose)]))
    warped = displaced(WALK, change)
    assert joint_positions(warped)[120] == pytest.approx(joint_positions(pose)[0], abs=1e-5)  # 0.01 mm
    outside = np.r_[0:61, 180:241]
    assert np.abs(change.root[outside]).max() == np.abs(change.turns[outside]).max() == 0
    assert np.array_equal(warped.rotations[outside], WALK.rotations[outside])
    assert list(warped.contacts) == list(WALK.contacts)


@given(seeds)
@settings(max_examples=15)
def test_every_key_of_any_body_is_met(seed):
    motion = random_motion(seed, frames=30)
    poses = [random_motion(seed + 1, 1, skeleton=motion.skeleton) for _ in range(2)]
    keys = [Key(3, poses[0], flat=True), Key(11), Key(25, poses[1])]
    warped = joint_positions(displaced(motion, offsets(motion, keys)))
    for key in keys:
        asked = joint_positions(key.pose or motion[key.frame : key.frame + 1])[0]
        assert warped[key.frame] == pytest.approx(asked, abs=1e-9)


def test_a_change_near_an_end_of_the_clip_holds_to_the_end():
    keys = keys_around(WALK, [Key(20, moved(WALK, 20, up=0.1))])
    assert offsets(WALK, keys).root[:21, 1] == pytest.approx(0.1)


test_keys_curves_and_scales_that_cannot_be = refusals(
    ("needs one key or more", offsets, WALK, []),
    ("at frames of 'walk_straight', 0 to 240; got .241.", offsets, WALK, [Key(241)]),
    ("at frames of 'walk_straight'", offsets, WALK, [Key(-1)]),
    ("at numbers of frames, got .1.5", offsets, WALK, [Key(1.5)]),
    ("in order of time", offsets, WALK, [Key(50), Key(40)]),
    ("once each", offsets, WALK, [Key(50), Key(50)]),
    ("pose of a key needs one frame, got 241", offsets, WALK, [Key(50, WALK)]),
    (SkeletonMismatch, "skeletons differ", offsets, WALK, [Key(50, random_motion(1, 1))]),
    *(
        ("a frame or more to come and go", keys_around, WALK, [Key(100, moved(WALK, 100))], seconds)
        for seconds in (0.0, -1.0, float("nan"), 0.001)
    ),
    (r"finite values \(1,\) at as many times", cardinal, [0, 1], [1.0], [0]),
    (r"times that rise, got \[0. 0.\]", cardinal, [0, 0], [1.0, 2.0], [0]),
    ("finite values", cardinal, [0, np.nan], [1.0, 2.0], [0]),
    ("finite values", cardinal, [0, 1], [1.0, np.inf], [0]),
    ("lies between 0 and 1, got 1.5", lambda: cardinal([0, 1], [1.0, 2.0], [0], tension=1.5)),
    (r"Frame \d+: such a gain turns 'lhumerus' by \d+°", scaled, WALK, "lhumerus", 40.0),
    (r"one finite number, or 241, got shape \(\)", scaled, WALK, "lhumerus", np.nan),
    (r"got shape \(2,\)", scaled, WALK, "lhumerus", [1.0, 2.0]),
    ("No joint 'elbow'", scaled, WALK, "elbow", 1.0),
)


def away(motion, joint, about=None):
    turns = motion.rotations[:, motion.skeleton.index(joint)]
    reference = rotations.mean(turns) if about is None else np.asarray(about)
    return reference, rotations.to_rotvec(rotations.multiply(rotations.inverse(reference), turns))


def test_a_scale_stretches_the_swing_about_the_mean():
    """As in [WP95, scale]."""
    reference, before = away(WALK, "lhumerus")
    wide = scaled(WALK, "lhumerus", 1.5)
    assert away(wide, "lhumerus", reference)[1] == pytest.approx(1.5 * before)
    changed = np.abs(wide.rotations - WALK.rotations).max(axis=(0, 2)) > 0
    assert np.flatnonzero(changed).tolist() == [WALK.skeleton.index("lhumerus")]


FOUR_SECONDS = sample("walk_straight")[240:721]


rising = st.lists(st.integers(1, 100), min_size=1, max_size=6).map(lambda gaps: np.cumsum([0, *gaps]))


@given(st.tuples(rising, rising))
def test_time_always_rises_and_meets_its_keys(both):
    """As in [WP95, time warp]."""
    count = min(map(len, both))
    new, old = (frames[:count] for frames in both)
    clock = wave(old[-1] + 1)
    clock = replace(clock, root_positions=np.arange(len(clock))[:, None] * [0.0, 0.0, 1.0])
    shown = retime(clock, list(zip(1 + new / clock.fps, old / clock.fps, strict=True))).root_positions[:, 2]
    assert shown[new] == pytest.approx(old)
    assert np.diff(shown).min() > 0


def test_one_pace_is_the_clip_itself_and_back_again_is_where_it_began():
    """As in [WP95, time warp]."""
    same = retime(FOUR_SECONDS, [(0, 0), (FOUR_SECONDS.duration, FOUR_SECONDS.duration)])
    assert joint_positions(same) == pytest.approx(joint_positions(FOUR_SECONDS), abs=1e-9)
    keys = [(0, 0), (3, 2), (4.5, 4)]
    new = np.linspace(0, 4.5, 91)
    old = PchipInterpolator(*np.transpose(keys))(new)
    back = retime(retime(FOUR_SECONDS, keys), list(zip(old, new, strict=True)))
    gap = joint_positions(back)[:, body(FOUR_SECONDS)] - joint_positions(FOUR_SECONDS)[:, body(FOUR_SECONDS)]
    assert len(back) == len(FOUR_SECONDS)
    assert np.linalg.norm(gap, axis=-1).max() < 0.003  # metres


def test_a_retimed_clip_has_the_most_frames_at_most(monkeypatch):
    frames = round(FOUR_SECONDS.duration * FOUR_SECONDS.fps) + 1
    keys = [(0, 0), (FOUR_SECONDS.duration, FOUR_SECONDS.duration)]
    monkeypatch.setattr("mocap.editing.retiming.MAX_FRAMES", frames)
    assert len(retime(FOUR_SECONDS, keys)) == frames
    monkeypatch.setattr("mocap.editing.retiming.MAX_FRAMES", frames - 1)
    refused(f"ask for {frames} frames; at most {frames - 1}", retime, FOUR_SECONDS, keys)


def test_the_marks_come_from_the_nearest_frame():
    slow = retime(FOUR_SECONDS, [(0, 0), (8, 4)])
    assert slow.duration == 8
    for joint, mark in FOUR_SECONDS.contacts.items():
        assert slow.contacts[joint].mean() == pytest.approx(mark.mean(), abs=0.01)
    assert slow.labels["walk"].all()


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_slow_motion_is_smooth(fps):
    """By slerp it would jolt by half as much again."""
    source = resample(FOUR_SECONDS, fps)
    slow = replace(at_frames(source, np.arange(0, len(source) - 1, 0.25)), fps=4 * fps)
    assert accelerations(slow) < 1.1 * accelerations(FOUR_SECONDS)


test_times_that_cannot_be = refusals(
    ("two or more pairs", retime, FOUR_SECONDS, []),
    (r"pairs \(new, old second\) that rise, got \[\(0, 0\)\]", retime, FOUR_SECONDS, [(0, 0)]),
    ("that rise", retime, FOUR_SECONDS, [(0, 0), (1, np.nan)]),
    ("that rise", retime, FOUR_SECONDS, [(0, 0), (1, 2), (2, 2)]),
    ("that rise", retime, FOUR_SECONDS, [(0, 0), (2, 1), (1, 2)]),
    ("Second 4.5 is not on .*, which lasts 4 s", retime, FOUR_SECONDS, [(0, 0), (1, 1), (2, 4.5)]),
    ("Second -0.5 is not on", retime, FOUR_SECONDS, [(0, -0.5), (1, 2)]),
    (r"ask for 1.2e\+11 frames; at most 1000000", retime, FOUR_SECONDS, [(0, 0), (1e9, 4)]),
)


@given(seeds, seeds)
def test_adding_and_taking_the_difference_undo_each_other(motion, change):
    """As in [LS99, displacement map]."""
    base, random = random_motion(motion), np.random.default_rng(change)
    turns = random.normal(size=(5, 6, 3))
    turns *= 3.0 * random.random((5, 6, 1)) / np.linalg.norm(turns, axis=-1, keepdims=True)
    change = Displacement(random.normal(size=(5, 3)), turns)
    again = difference(displaced(base, change), base)
    np.testing.assert_allclose(again.root, change.root, atol=1e-14)
    np.testing.assert_allclose(again.turns, change.turns, atol=1e-12)


def test_what_is_not_turned_keeps_its_numbers_to_the_last_bit():
    walk = WALK[:20]
    turns = np.zeros((20, 38, 3))
    turns[:, 3, 0] = 0.1
    edited = displaced(walk, Displacement(np.zeros((20, 3)), turns))
    others = np.arange(38) != 3
    assert np.array_equal(edited.rotations[:, others], walk.rotations[:, others])
    assert np.array_equal(edited.root_positions, walk.root_positions)
    assert edited.contacts.keys() == walk.contacts.keys()


def test_a_basis_has_the_values_of_uniform_cubic_splines():
    """As in [Gle98, smooth change]."""
    basis = spline_basis(11, 5).toarray()
    np.testing.assert_allclose(basis[2], [0.036, 0.538667, 0.414667, 0.010667, 0], atol=1e-6)


@given(st.integers(1, 300), st.floats(0.1, 1000))
def test_the_splines_of_a_frame_add_up_to_1(frames, spacing):
    basis = spline_basis(frames, spacing)
    assert basis.shape == (frames, max(1, round((frames - 1) / spacing)) + 3)
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, atol=1e-12)
    assert np.diff(basis.indptr).max() <= 4 and basis.data.min() >= 0


OTHER = replace(WALK.skeleton, names=[f"x{n}" for n in WALK.skeleton.names])
SHORT = Displacement(np.zeros((10, 3)), np.zeros((10, 38, 3)))

test_what_has_no_difference_is_refused = refusals(
    (SkeletonMismatch, "joint", difference, WALK, replace(WALK, skeleton=OTHER, contacts={})),
    ("has 241 frames, 'walk_straight' has 10", difference, WALK, WALK[:10]),
    ("has 241 frames, its displacement 10", displaced, WALK, SHORT),
    *(("above 0", spline_basis, *wrong) for wrong in ((0, 1), (5, 0), (5, -1), (5, np.nan))),
)
