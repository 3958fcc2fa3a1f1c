"""Toes stay above the floor under every edit, and an edit of a window leaves all other frames as they are."""

from dataclasses import replace

import numpy as np
import pytest

from mocap import load
from mocap.body import joint_positions, resample, rotations
from mocap.body.foot_joints import feet_of, toe_tips
from mocap.body.limbs import find_legs
from mocap.datasets.samples import SKELETON, sample
from mocap.editing import bend, edit, pin, pin_errors, plant_pins, retarget, solve
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.stages import closing_stages
from mocap.editing.stances import Stance
from mocap.editing.toes import bend_toes, lowest_allowed, lowest_heights
from mocap.editing.warp_plans import load_plan, warp
from mocap.feet.footplants import mark_plants
from tests.editing.bodies import adult, walk, without
from tests.refusals import told, unwarned

TIPS = [SKELETON.index("ltoes_end"), SKELETON.index("rtoes_end")]
FEET = [joint for leg in find_legs(SKELETON) for joint in (leg.ankle, leg.ball)]
NOSE_DOWN = rotations.from_rotvec([0.4, 0, 0])
LONG = 1.8  # times the length of the bundled toes


def tip_heights(motion, tips=TIPS):
    return joint_positions(motion)[:, tips, 1]


def with_sinking_toes(motion=None):
    """Return a walk whose toes are bent down, so that their tips are 2 cm lower than they ever were."""
    motion = walk() if motion is None else motion
    turned = motion.rotations.copy()
    for leg in find_legs(SKELETON):
        turned[:, leg.ball] = rotations.multiply(turned[:, leg.ball], NOSE_DOWN)
    return replace(motion, rotations=turned)


def with_sliding_feet():
    """Return a walk that goes 4 % less far than its steps do, with contacts."""
    return replace(walk(), root_positions=walk().root_positions * [1, 1, 0.96])


def jolt(motion):
    """Return the largest acceleration of toe tips, m/s²."""
    steps = np.diff(joint_positions(motion)[:, TIPS], 2, axis=0)
    return np.linalg.norm(steps, axis=-1).max() * motion.fps**2


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_tips_are_as_high_as_they_may_be_and_nothing_but_toes_moves(fps):
    sinking = with_sinking_toes(resample(walk(), fps))
    assert tip_heights(sinking).min() < -0.005
    allowed = lowest_allowed(resample(walk(), fps), feet_of(walk()))
    raised = bend_toes(sinking, allowed, feet_of(sinking))
    assert (tip_heights(raised) > allowed[:, TIPS] - 0.0011).all()
    others = [joint for joint in range(len(SKELETON)) if joint not in TIPS]
    assert np.array_equal(joint_positions(raised)[:, others], joint_positions(sinking)[:, others])
    assert jolt(raised) < 1.5 * jolt(sinking)


def test_toes_bend_no_more_than_they_must():
    sinking = with_sinking_toes()
    raised = bend_toes(sinking, lowest_allowed(walk(), feet_of(walk())), feet_of(walk()))
    high = tip_heights(sinking).min(axis=1) > 0.1
    angles = rotations.angle_between(raised.rotations[:, 5], sinking.rotations[:, 5])
    assert angles[high].max(initial=0.0) == 0
    assert 0.2 < angles.max() < 0.6


def test_without_tips_below_the_floor_a_motion_is_itself():
    assert bend_toes(walk(), lowest_allowed(walk(), feet_of(walk())), feet_of(walk())) is walk()
    bare = without(walk(), "ltoes_end", "rtoes_end")
    assert bend_toes(bare, lowest_allowed(bare, feet_of(bare)) + 1.0, feet_of(bare)) is bare
    assert toe_tips(bare.skeleton, find_legs(bare.skeleton)[0]) == []


def test_joints_may_be_on_the_floor_or_where_they_were():
    lying = replace(walk(), root_positions=walk().root_positions - [0, 0.05, 0])
    allowed = lowest_allowed(lying, feet_of(lying))
    heights = joint_positions(lying)[..., 1]
    assert (allowed <= np.maximum(heights, 0)).all()
    assert (allowed[:, FEET] <= heights[:, FEET]).all()
    assert np.array_equal(allowed[:, TIPS], np.minimum(heights, 0)[:, TIPS])
    hand = SKELETON.index("lwrist")
    assert not allowed[:, hand].any()
    raised = lowest_allowed(lying, feet_of(lying), lowest_heights([walk()]))
    assert raised[:, TIPS].min() == tip_heights(walk()).min()


@pytest.fixture
def millimetre(tmp_path):
    """Return a function that asks a hand for a millimetre in the middle of a motion, as `mocap warp` does."""

    def ask(motion, hand):
        (tmp_path / "keys.txt").write_text(f"at {len(motion) // 2} {hand} 0 0.001 0\n")
        return warp(motion, load_plan(tmp_path / "keys.txt", motion))

    return ask


def unchanged(motion, source):
    """Return the frames that are the same to the last bit, with their contacts."""
    same = (motion.rotations == source.rotations).all(axis=(1, 2))
    same &= (motion.root_positions == source.root_positions).all(axis=1)
    for name, mark in source.contacts.items():
        same &= motion.contacts[name] == mark
    return same


def test_a_warp_of_sliding_feet_changes_no_frame_outside_its_window_and_leaves_no_jump(millimetre):
    source = with_sliding_feet()
    warped = unwarned(millimetre, source, "lhand")
    same = unchanged(warped, source)
    middle = len(source) // 2
    assert same[: middle - 59].all()
    assert same[middle + 60 :].all()
    assert not same[middle - 50 : middle + 50].any()
    assert tip_heights(warped).min() > tip_heights(source).min() - 0.002
    before, after = (np.abs(np.diff(joint_positions(clip), 2, axis=0)).max() for clip in (source, warped))
    assert after < 1.3 * before


def test_a_millimetre_asked_of_a_captured_walk_pushes_no_toe_through_the_floor(real_data, millimetre):
    source = mark_plants(load(real_data / "cmu/16/16_15.amc"))
    warped = millimetre(source, "lhand")
    tips = [tip for leg in find_legs(source.skeleton) for tip in toe_tips(source.skeleton, leg)]
    assert tip_heights(warped, tips).min() > tip_heights(source, tips).min() - 0.01
    assert joint_positions(warped)[..., 1].min() > joint_positions(source)[..., 1].min() - 0.003
    middle = len(source) // 2
    same = unchanged(warped, source)
    assert same[: middle - 59].all()
    assert same[middle + 60 :].all()


def test_an_edit_of_some_frames_meets_its_constraints_and_leaves_the_others():
    hand = joint_positions(walk())[240, SKELETON.index("lwrist")]
    wish = pin(walk(), "lwrist", range(238, 243), hand + 0.1 * np.array([0, 1, 0]))
    edited = edit(walk(), wish, frames=slice(180, 300))
    assert unchanged(edited, walk())[:180].all()
    assert unchanged(edited, walk())[300:].all()
    assert pin_errors(edited, wish).max() < 1e-8


def test_too_few_frames_for_a_curve_stay_as_they_are():
    hand = joint_positions(walk())[240, SKELETON.index("lwrist")]
    wish = pin(walk(), "lwrist", [240], hand + 0.01)
    assert unchanged(
        solve(walk(), wish, closing_stages()[:1], quiet=True, frames=slice(240, 240)).motion, walk()
    ).all()
    one = solve(walk(), wish, closing_stages()[:1], frames=slice(240, 241)).motion
    assert np.flatnonzero(~unchanged(one, walk())).tolist() == [240]
    assert pin_errors(one, wish).max() < 1e-8


def test_an_edit_of_no_frame_changes_nothing_and_says_what_is_missed():
    hand = joint_positions(walk(1.0))[60, SKELETON.index("lwrist")]
    wish = pin(walk(1.0), "lwrist", [60], hand + 0.05)
    edited = told("mm off its pin", edit, walk(1.0), wish, frames=slice(60, 60))
    assert unchanged(edited, walk(1.0)).all()


def test_a_foot_that_is_asked_under_the_floor_goes_there():
    clip = walk(1.0)
    place = joint_positions(clip)[60, SKELETON.index("ltoes")]
    step = pin(clip, "ltoes", [60], place - 0.1 * np.array([0, 1, 0]))
    assert pin_errors(edit(clip, step), step).max() < 1e-6


def test_longer_toes_bend_at_toe_off_and_the_feet_still_stand():
    offsets = SKELETON.offsets.copy()
    offsets[TIPS] *= LONG
    body = Stance(replace(SKELETON, offsets=offsets), adult().roles, adult().turns, adult().heights)
    worn = retarget(walk(2.0), body, adult())
    assert tip_heights(worn).min() > min(0.0, tip_heights(walk(2.0)).min()) - 0.002
    assert joint_positions(worn)[..., 1].min() > -0.002
    for name, planted in walk(2.0).contacts.items():
        heights = joint_positions(worn)[planted, SKELETON.index(name), 1]
        assert np.ptp(heights) < 1e-4


def test_a_bent_walk_keeps_the_tips_of_its_toes_as_high_as_they_were():
    clip = sample("walk_curve_1")[:300]
    bent = bend(clip, [[0, 0], [0, 3], [2, 1]]).motion
    assert tip_heights(bent).min() > tip_heights(clip).min() - 0.0011


def test_cleaned_feet_that_sink_rise_with_their_plants():
    """Toes cannot bend so far here: the balls themselves are too low."""
    low = replace(walk(1.5), root_positions=walk(1.5).root_positions - [0, 0.035, 0])
    assert joint_positions(low)[:, FEET, 1].min() < -0.008
    cleaned = clean_feet(low, lowest_heights([walk(1.5)]))
    assert joint_positions(cleaned)[:, FEET, 1].min() > -1e-4
    assert pin_errors(cleaned, plant_pins(cleaned)).max() < 1e-6


def test_cleaned_feet_keep_their_toes_above_the_floor_of_the_clips():
    sinking = with_sinking_toes(with_sliding_feet())
    lowest = lowest_heights([walk()])
    cleaned = clean_feet(sinking, lowest)
    assert (tip_heights(cleaned) > lowest[TIPS] - 0.0011).all()
