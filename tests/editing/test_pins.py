"""One box stands for holds, rails, floors and bars; what is no box is refused."""

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.editing.pins import Pins, join_pins, pin, pin_errors, plant_pins
from tests.editing.wishes import walk
from tests.refusals import refusals
from tests.strategies import random_motion

INF = np.inf


def box(low, high=None, joint=1):
    low = np.asarray(low, float)
    return Pins((joint,), low.reshape(1, 1, 3), np.asarray(low if high is None else high).reshape(1, 1, 3))


BOXES = [
    ([1, 2, 3], [1, 2, 3], [1, 2, 3]),  # a hold
    ([1, 2, -INF], [1, 2, INF], [1, 2, 0]),  # a rail along z
    ([-INF, 0.5, -INF], [INF] * 3, [0, 0.5, 0]),  # a floor above the joint
    ([-INF] * 3, [INF, -0.5, INF], [0, -0.5, 0]),  # a bar below it
    ([-1, -1, -1], [1, 1, 1], [0, 0, 0]),  # a box that it is in
]


@pytest.mark.parametrize(("low", "high", "gap"), BOXES)
def test_the_gap_is_the_way_into_the_box(low, high, gap):
    """As in [Gle98, constraints]."""
    pins = box(low, high)
    assert pins.gap(np.zeros((1, 1, 3)))[0, 0].tolist() == gap
    assert pins.held[0, 0].tolist() == [a == b for a, b in zip(low, high, strict=True)]
    assert pins.asked.all()
    assert not box([-INF] * 3, [INF] * 3).asked.any()


def test_a_pin_asks_in_its_frames_only():
    clip = random_motion(0, frames=9)
    for frames in (slice(3, 5), [3, 4], np.arange(9) // 2 == 2, np.array([4, 3])):
        pins = pin(clip, "joint2", frames, [0, 1, 2])
        rows = [4, 5] if np.asarray(frames).dtype == bool else [3, 4]
        assert np.flatnonzero(pins.asked).tolist() == rows
        assert pins.joints == (2,) and pins.low[4, 0].tolist() == [0, 1, 2]
    path = np.arange(6.0).reshape(2, 3)
    assert pin(clip, 2, [3, 4], path).low[[3, 4], 0].tolist() == path.tolist()
    assert np.flatnonzero(pin(clip, 2, slice(0, 9), [0, 0, 0]).only([2]).asked).tolist() == [2]
    assert len(pin(clip, 2, slice(0, 9), [0, 0, 0]).at(slice(2, 4))) == 2


def test_of_two_holds_the_later_goes_before_and_a_hold_goes_before_a_box():
    hold, floor = box([1, 2, 3]), box([-INF, 9, -INF], [INF] * 3)
    for several in ((hold, floor), (floor, hold)):
        joined = join_pins(*several)
        assert joined.low.ravel().tolist() == joined.high.ravel().tolist() == [1, 2, 3]
    assert join_pins(hold, box([4, 5, 6])).low.ravel().tolist() == [4, 5, 6]
    under = join_pins(floor, box([-INF] * 3, [INF, 10, INF]))
    assert (under.low[0, 0, 1], under.high[0, 0, 1]) == (9, 10)
    above = join_pins(box([-INF] * 3, [INF, 8, INF]), floor)
    assert (above.low[0, 0, 1], above.high[0, 0, 1]) == (9, INF)  # they have nothing in common: the later one
    both = join_pins(hold, box([0, 0, 0], joint=4))
    assert both.joints == (1, 4) and both.held.all()


def test_plants_are_held_at_one_place_each():
    clip = walk()
    pins = plant_pins(clip)
    assert [clip.skeleton.names[j] for j in pins.joints] == ["lfoot", "ltoes", "rfoot", "rtoes"]
    for column, joint in enumerate(pins.joints):
        marks = clip.contacts[clip.skeleton.names[joint]]
        assert np.array_equal(pins.held[:, column].all(axis=-1), marks)
        places = np.unique(pins.low[marks, column].round(6), axis=0)
        assert 3 <= len(places) <= 5  # one for each plant
    assert pin_errors(clip, pins).max() < 5e-9  # the clip is stored to half a nanometre
    away = joint_positions(clip)[:, pins.joints[0]] + [0, 0.3, 0]
    np.testing.assert_allclose(pin_errors(clip, pin(clip, "lfoot", range(len(clip)), away))[:, 0], 0.3)


CLIP = random_motion(0, frames=9)

test_bad_pins_are_named = refusals(
    ("No joint 'hand'", pin, CLIP, "hand", [0], [0, 0, 0]),
    ("No joint 6: there are 6", pin, CLIP, 6, [0], [0, 0, 0]),
    ("No joint -1", pin, CLIP, -1, [0], [0, 0, 0]),
    ("'random0' has 9 frames, counted from 0", pin, CLIP, 2, [9], [0, 0, 0]),
    ("frames are their numbers, a slice", pin, CLIP, 2, [0.5], [0, 0, 0]),
    (r"'joint2': a place is \(3,\) or \(1, 3\) metres, got \(2,\)", pin, CLIP, "joint2", [3], [0, 0]),
    ("Frame 3, joint 2: a pin needs low ≤ high, got nan", pin, CLIP, 2, [3], [0, np.nan, 0]),
    ("Frame 3, joint 2: .* got inf", pin, CLIP, 2, [3], [0, INF, 0]),
    ("Frame 3, joint 2: .* got 2 and 1 for y", pin, CLIP, 2, [3], [0, 2, 0], [0, 1, 0]),
    ("Frame 0, joint 2", lambda: Pins((2,), np.ones((4, 1, 3)), np.zeros((4, 1, 3)))),
    ("2 different joints need", lambda: Pins((2, 2), np.ones((4, 2, 3)), np.ones((4, 2, 3)))),
    ("1 different joints need", lambda: Pins((2,), np.ones((4, 3)), np.ones((4, 3)))),
    ("same number of frames, got none", join_pins),
    ("got 1, 9", join_pins, box([0, 0, 0]), pin(CLIP, 2, [3], [0, 0, 0])),
    ("'random0' has 9 frames, its pins have 1", pin_errors, CLIP, box([0, 0, 0])),
    ("No joint 8", pin_errors, CLIP[:1], box([0, 0, 0], joint=8)),
    ("No legs found", plant_pins, CLIP),
)
