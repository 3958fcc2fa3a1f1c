"""The fit has the paper's values; each level more than halves what is left; only those concerned listen."""

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.editing.displacements import difference, spline_basis
from mocap.editing.levels import hierarchy, scattered_fit
from mocap.editing.pins import pin, pin_errors, plant_pins
from tests.editing.wishes import bar, captured, hand_at, rms, smoothness, stone, walk
from tests.refusals import refused


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


def test_each_level_more_than_halves_what_a_captured_walk_leaves(real_data):
    clip = captured(real_data)
    for pins in (stone(clip, 0.2), bar(clip, 1.35, 230)):
        motion, told = hierarchy(clip, pins)
        left = np.array([level.rms for level in told])
        assert (left[1:] * 2 <= left[:-1]).all() and left[-1] < 0.001
        assert smoothness(motion, clip) < 1.2


def test_a_hand_listens_to_its_own_frames_only():
    """As in [LS99, levels]."""
    clip = walk()
    pins = hand_at(clip, (180, 240, 300))
    assert hierarchy(clip, pins)[1][-1].worst < 0.002


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


def test_bad_input():
    clip = walk()
    pins = plant_pins(clip)
    for call, words in (
        (lambda: hierarchy(clip, pins, knots=()), "knots come nearer"),
        (lambda: hierarchy(clip, pins, knots=(0.25, 0.5)), r"got \(0.25, 0.5\)"),
        (lambda: hierarchy(clip, pins, knots=(0.25, 0.0)), "above 0 s"),
    ):
        refused(words, call)
