"""One call: stones, bars, hands and rails; feet stand to the last digit, and what cannot be is said."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.editing.displacements import difference, spline_basis
from mocap.editing.edits import edit, hierarchy, scattered_fit
from mocap.editing.pins import join_pins, pin, pin_errors, plant_pins
from mocap.errors import MocapWarning
from tests.editing.wishes import (
    bar,
    between,
    bones,
    captured,
    far_hand,
    hand,
    neck,
    plants_kept,
    rms,
    shakes,
    smoothness,
    stone,
    walk,
)
from tests.refusals import refusals


@pytest.fixture(autouse=True)
def warnings_are_errors():
    with warnings.catch_warnings():
        warnings.simplefilter("error", MocapWarning)
        yield


def check(motion, base, pins, most):
    assert pin_errors(motion, pins).max() < 1e-9
    assert plants_kept(motion, base) == 1
    assert smoothness(motion, base) <= most
    assert bones(motion) < 1e-12


@pytest.mark.parametrize(("fps", "height"), [(120.0, 0.15), (120.0, 0.5), (30.0, 0.15), (30.0, 0.5)])
def test_a_stone_under_a_step(fps, height):
    clip = walk(fps)
    pins = stone(clip, height)
    check(edited := edit(clip, pins), clip, pins, 1.15)
    assert shakes(edited, clip, pins) <= 1.15


@pytest.mark.parametrize("height", [0.2, 0.5])
@pytest.mark.parametrize("file", ["cmu/16/16_15.amc", "hw3/walk_fwd_curve1.AMC"])
def test_stones_under_a_captured_step(real_data, file, height):
    clip = captured(real_data, file)  # the second one's knee jumps where its leg is straight
    pins = stone(clip, height)
    check(edited := edit(clip, pins), clip, pins, 1.15)
    assert shakes(edited, clip, pins) <= 1.15


def test_a_bar_to_duck_under(real_data):
    for clip, middle, height in ((captured(real_data), 230, 1.35), (walk(), 250, 1.4)):
        pins = bar(clip, height, middle)
        edited = edit(clip, pins)
        errors = pin_errors(edited, pins)
        assert errors[:, :4].max() < 1e-9 and errors.max() < 1e-5
        assert plants_kept(edited, clip) == 1
        assert smoothness(edited, clip) < (1.05 if clip.name == "16_15" else 1.2)
        assert shakes(edited, clip, pins) <= 1.15
        assert (between(*neck(edited)) - between(*neck(clip))).max() < 45
        head = joint_positions(edited)[:, clip.skeleton.index("head")]
        low = pins.high[:, pins.joints.index(clip.skeleton.index("head")), 1]
        assert (head[:, 1] - low).max() < 1e-5


def test_a_hand_held_while_the_body_walks_on(real_data):
    for clip, around in ((captured(real_data), 240), (walk(), 250)):
        still = hand(clip, slice(around - 24, around + 24), around)
        pins = join_pins(plant_pins(clip), still)
        check(edited := edit(clip, still), clip, pins, 1.25)
        assert shakes(edited, clip, pins) <= 1.15
        assert between(neck(edited)[0], neck(clip)[0]).max() < 15


def test_a_hand_on_a_rail_slides_along_it(real_data):
    clip = captured(real_data)
    wrist, frames = clip.skeleton.index("rwrist"), slice(180, 300)
    place = joint_positions(clip)[frames, wrist].mean(axis=0) + np.array([0.05, 0.15, 0])
    low, high = (np.where([False, False, True], end, place) for end in (-np.inf, np.inf))
    rail = pin(clip, wrist, frames, low, high)
    assert 0.1 < pin_errors(clip, rail).max() < 0.3
    edited = edit(clip, rail)
    check(edited, clip, join_pins(plant_pins(clip), rail), 1.1)
    assert np.ptp(joint_positions(edited)[frames, wrist, 2]) > 0.5


def test_nothing_asked_changes_nothing():
    clip = walk()
    assert edit(clip, pin(clip, "lwrist", [], [0, 0, 0])) is clip


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
def test_a_few_frames_are_enough(frames):
    clip = walk()[240 : 240 + frames]
    wrist = joint_positions(clip)[0, clip.skeleton.index("lwrist")]
    pins = pin(clip, "lwrist", [0], wrist + np.array([0, 0.1, 0]))
    assert pin_errors(edit(clip, pins), pins).max() < 1e-4  # no frame shows the elbow's hinge


def test_what_cannot_be_is_said():
    clip = walk()
    wrist, elbow = (clip.skeleton.index(name) for name in ("rwrist", "rradius"))
    at = joint_positions(clip)
    apart = [pin(clip, j, [240], at[240, j] + np.array([0, y, 0])) for j, y in ((wrist, 0.1), (elbow, -0.1))]
    with pytest.warns(MocapWarning, match=r"frame 240: 'r\w+' is \d+\S* mm off its pin") as told:
        both = edit(clip, join_pins(*apart))
    assert all(len(str(warning.message)) <= 200 for warning in told)
    errors = [pin_errors(both, one)[240, 0] for one in apart]
    assert min(errors) > 0.03 and max(errors) < 1.3 * min(errors)  # each gives way by as much


def test_the_fit_of_one_datum_and_of_two_has_the_papers_values():
    """As in [LS99, scattered data]."""
    basis = spline_basis(11, 5)
    one = scattered_fit(basis, np.array([[1.0]]), np.array([5]))
    np.testing.assert_allclose(one[1:4, 0], [1 / 3, 4 / 3, 1 / 3], atol=1e-12)
    np.testing.assert_allclose((basis @ one)[[5, 6], 0], [1, 0.9636], atol=1e-4)
    two = scattered_fit(basis, np.array([[1.0], [0.0]]), np.array([5, 6]))
    np.testing.assert_allclose((basis @ two)[[5, 6], 0], [0.527, 0.491], atol=1e-3)


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_each_level_more_than_halves_what_a_stone_leaves(fps):
    """As in [LS99, levels]."""
    clip = walk(fps)
    pins = stone(clip, 0.15)
    motion, told = hierarchy(clip, pins)
    left = np.array([level.rms for level in told])
    assert (left[1:-1] * 2 <= left[:-2]).all()
    assert left[-1] < 0.001 and rms(pin_errors(motion, pins), pins) == pytest.approx(left[-1], rel=0.3)
    assert smoothness(motion, clip) < 1.2
    assert told[-1].worst == pytest.approx(pin_errors(motion, pins).max())
    assert [level.knots for level in told] == [0.5, 0.25, 0.125, 0.06, 0.03][: len(told)]


def test_levels_do_not_fold_a_neck_under_a_bar(real_data):
    for clip, height, middle in ((walk(), 1.4, 250), (captured(real_data), 1.35, 230)):
        pins = bar(clip, height, middle)
        motion, _ = hierarchy(clip, pins)
        turns = np.degrees(np.linalg.norm(difference(motion, clip).turns, axis=-1)).max()
        assert turns < 40
        below = pins.high[..., 1] - joint_positions(motion)[:, pins.joints, 1]
        under = np.where(pins.high[..., 1] < 2, below, np.inf).min(axis=1)
        assert np.median(under[np.isfinite(under)]) < 0.04


def test_the_levels_end_where_the_pins_are_met():
    clip = walk()
    for pins in (plant_pins(clip), pin(clip, "lwrist", [], [0, 0, 0])):
        motion, told = hierarchy(clip, pins)
        assert motion is clip and not told


def levels(*knots):
    return hierarchy(walk(), plant_pins(walk()), knots=knots)


test_what_cannot_be_edited_is_refused = refusals(
    (r"Frame 24\d: 'rwrist' would be 5.\d+ m from '\w+', the bones", edit, walk(), far_hand(walk())),
    ("mark_plants finds out", edit, replace(walk(), contacts={}), hand(walk(), [240], 240)),
    ("knots come nearer", levels),
    (r"got \(0.25, 0.5\)", levels, 0.25, 0.5),
    ("above 0 s", levels, 0.25, 0.0),
)
