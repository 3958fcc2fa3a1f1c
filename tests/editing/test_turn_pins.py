"""A trunk that is kept upright does not tip; a joint with limits stays within them; what can't be is said."""

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.editing.bodies import keep_turned, limit_turns
from mocap.editing.displacements import difference
from mocap.editing.edits import edit, hierarchy
from mocap.editing.pins import join_pins, pin_errors, plant_pins
from tests.editing.wishes import bar, captured, hand, shakes, smoothness, walk
from tests.refusals import refusals

NECK = ["lowerneck", "upperneck", "head"]


def turned(motion, base, joint):
    """By how many degrees a joint is turned otherwise in the world, at most."""
    number = base.skeleton.index(joint)
    a, b = (rotations.from_matrix(forward_kinematics(m).matrices[:, number]) for m in (motion, base))
    return np.degrees(rotations.angle_between(a, b)).max()


@pytest.mark.parametrize("real", [False, True])
def test_a_hand_reaches_and_the_trunk_stays_as_it_is(real, request):
    """A joint keeps how it is turned [Gle98, orientations], [LS99, orientations]."""
    clip = captured(request.getfixturevalue("real_data")) if real else walk()
    held = hand(clip, slice(216, 264), 240)
    upright = join_pins(held, keep_turned(clip, "thorax", slice(None)))
    made = edit(clip, upright)
    assert pin_errors(made, upright).max() < 1e-5 and turned(made, clip, "thorax") < 0.01
    assert shakes(made, clip, held) <= 1.15 and smoothness(made, clip) <= 1.15
    assert turned(edit(clip, held), clip, "thorax") > 10


def test_a_neck_stays_within_its_limits_under_a_bar(real_data):
    """Joints bend as far as they may [Gle98, joint limits], [LS99, joint limits]."""
    clip = captured(real_data)
    low, free = bar(clip, 1.35, 230), keep_turned(clip, "thorax", slice(None))
    limits = limit_turns(clip, NECK, more=5.0)
    folded, kept = (edit(clip, join_pins(low, free, *more)) for more in ((), (limits,)))
    assert pin_errors(folded, limits).max() > 0.05 and pin_errors(kept, limits).max() < 1e-5
    assert pin_errors(clip, limit_turns(clip, NECK, more=0.0)).max() < 1e-12  # as far as the clip itself
    turns = np.linalg.norm(difference(kept, clip).turns, axis=-1).max(axis=0)
    assert np.degrees(turns[[clip.skeleton.index(name) for name in NECK]]).max() < 25
    assert pin_errors(kept, low)[:, :4].max() < 1e-9


def test_turns_are_pinned_in_some_frames_and_joined():
    clip = walk()[:60]
    pins = join_pins(plant_pins(clip), keep_turned(clip, "head", [1, 2]), limit_turns(clip, NECK))
    assert [turn.joint for turn in pins.turns] == [clip.skeleton.index(n) for n in ("head", *NECK)]
    assert pin_errors(clip, pins).shape == (60, 4 + 4) and not pin_errors(clip, pins)[:, 4:].any()
    assert pins.asked[:, 4].sum() == 2
    some = pins.only([2, 3]).at([1, 2, 3])
    assert some.asked[:, 4:].sum(axis=0).tolist() == [1, 2, 2, 2]


def test_levels_keep_a_trunk_upright():
    clip = walk(30.0)
    held = join_pins(plant_pins(clip), hand(clip, slice(54, 66), 60))
    upright = join_pins(held, keep_turned(clip, "thorax", slice(None)))
    tips = [turned(hierarchy(clip, pins)[0], clip, "thorax") for pins in (held, upright)]
    assert tips[0] > 5 and tips[1] < 1


test_limits_that_are_none_are_refused = refusals(
    ("neck", limit_turns, walk()[:9], ["neck"]),
    ("0 degrees or more .* got -1", lambda: limit_turns(walk()[:9], NECK, more=-1.0)),
)
