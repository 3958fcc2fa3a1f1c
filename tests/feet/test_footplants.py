"""Plants are found where they are: against the bundled clips' true ones, and by what is known of walking."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import runs
from mocap.body import concatenate, heading, joint_positions, resample
from mocap.datasets.samples import SAMPLES, sample
from mocap.feet.footplants import find_footprints, hysteresis, mark_plants, settle, standing_tracks
from tests.refusals import refused
from tests.strategies import random_motion, seeds, wave

JOINTS = ("lfoot", "ltoes", "rfoot", "rtoes")
masks = st.lists(st.booleans(), min_size=1, max_size=80).map(lambda marks: np.array(marks, bool))


def f1(found, truth):
    """Give the harmonic mean of precision and recall over the frames of all four joints."""
    a, b = (np.concatenate([m.contacts[joint] for joint in JOINTS]) for m in (found, truth))
    return 2 * (a & b).sum() / (a.sum() + b.sum())


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("fps", [pytest.param(120.0, marks=pytest.mark.sweep), 30.0])
def test_the_plants_of_the_bundled_clips_are_found(name, fps):
    clip = resample(sample(name), fps)
    assert f1(mark_plants(replace(clip, contacts={})), clip) > 0.97


def test_noise_of_half_a_millimetre_does_not_hide_the_plants():
    clip = sample("walk_straight")
    noise = np.random.default_rng(0).normal(size=clip.root_positions.shape) * 5e-4
    found = mark_plants(replace(clip, root_positions=clip.root_positions + noise))
    # None is hidden; but feet that roll over heel and toes are slow before they stand and after.
    assert all(found.contacts[joint][clip.contacts[joint]].mean() > 0.97 for joint in JOINTS)
    assert f1(found, clip) > 0.8


def test_one_who_stands_still_stands_on_both_feet_all_the_time():
    frame = sample("stop_and_go")[100:101]
    noise = np.random.default_rng(1).normal(size=(240, 3)) * 2e-4
    still = concatenate([replace(frame, labels={}, contacts={})] * 240)
    still = replace(still, root_positions=still.root_positions + noise)
    assert all(mark_plants(still).contacts[joint].all() for joint in JOINTS)


def test_feet_that_are_never_slow_have_no_plants():
    jog = sample("jog")
    way = heading(jog.rotations[:, 0])  # on a cart that goes where the jog does: none comes towards the other
    cart = np.stack([np.sin(way), np.full(len(jog), 1.5), np.cos(way)], axis=1)
    ride = jog.root_positions + np.cumsum(cart, axis=0) / jog.fps
    assert not any(mark_plants(replace(jog, root_positions=ride)).contacts[joint].any() for joint in JOINTS)


@given(masks, st.integers(1, 8))
def test_settled_marks_have_no_short_runs_and_settle_no_further(marks, span):
    settled = settle(marks, span)
    for kind in (settled, ~settled):
        inner = [stop - start for start, stop in runs(kind) if start > 0 and stop < len(marks)]
        assert all(length >= span for length in inner)
    assert np.array_equal(settle(settled, span), settled)
    # What touches an end of the clip may last longer than the clip shows: it stays.
    assert settled[[0, -1]].tolist() == marks[[0, -1]].tolist()


def spread_by_loop(values, allowed, enter, leave):
    """Return what `hysteresis` marks, run by run."""
    marks = np.zeros(len(values), bool)
    for start, stop in runs(allowed & (values < leave)):
        marks[start:stop] = (values[start:stop] < enter).any()
    return marks


@given(st.lists(st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0, 3.0, np.nan]), max_size=60), seeds)
def test_hysteresis_is_what_a_loop_over_the_runs_finds(values, seed):
    random = np.random.default_rng(seed)
    values, allowed = np.array(values), random.random(len(values)) < random.random()
    enter, leave = random.choice([0.5, 1.0, 2.0], 2)  # in either order
    assert np.array_equal(
        hysteresis(values, allowed, enter, leave), spread_by_loop(values, allowed, enter, leave)
    )


def test_a_value_at_a_threshold_is_not_below_it():
    everywhere = np.ones(2, bool)
    assert not hysteresis(np.array([1.0, 2.0]), everywhere, 1.0, 3.0).any()
    assert hysteresis(np.array([1.0, 2.0]), everywhere, 1.5, 2.0).tolist() == [True, False]


def test_too_short_a_clip_and_legs_without_names_are_errors():
    refused("more than 12 frames; 'jog' has 12", mark_plants, sample("jog")[:12])
    assert len(mark_plants(sample("jog")[:13])) == 13
    refused("No legs found", mark_plants, random_motion(0, frames=40))


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_each_run_of_contact_is_one_print(down):
    motion = replace(wave(len(down)), contacts={"hand": down})
    stretches = [key for key, _ in groupby(down)]
    prints = find_footprints(motion)
    assert len(prints) == sum(stretches)
    covered = np.zeros(len(down), bool)
    for step in prints:
        covered[step.start : step.end] = True
        x, _, z = joint_positions(motion)[step.start : step.end, 2].mean(axis=0)
        assert (step.x, step.z) == pytest.approx((x, z))
    assert covered.tolist() == down
    assert find_footprints(replace(motion, contacts={})) == []


def test_tracks_have_gaps_where_no_joint_stands():
    motion = replace(wave(4), contacts={"hand": [1, 1, 0, 1], "root": [0, 0, 0, 0]})
    tracks = standing_tracks(motion)
    hand = joint_positions(motion)[:, motion.skeleton.index("hand")][:, [0, 2]]
    assert tracks[[0, 1, 3]] == pytest.approx(hand[[0, 1, 3]])
    assert np.isnan(tracks[[2, 4, 5, 6, 7, 8, 9]]).all()
    assert len(tracks) == 10
    assert standing_tracks(replace(wave(5), contacts={})).shape == (0, 2)
