"""Ways to hold the plants of a bent walk, compared: what each leaves, and how much it shakes."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from mocap.body.ground_path import s_curve
from mocap.body.motion import Motion
from mocap.editing.bodies import body_of
from mocap.editing.copied_motion import copied
from mocap.editing.displacements import displaced
from mocap.editing.edits import edit
from mocap.editing.path_editing import on_path, ride_of
from mocap.editing.pins import Pins, pin_errors, plant_pins
from mocap.editing.solver import REACH, solve
from mocap.editing.stances import proportioned, stance_of
from mocap.editing.steps import Basis
from mocap.feet.footskate import clean_up
from tests.editing.wishes import captured, plants_kept, smoothness, walk


def bent(clip: Motion) -> tuple[Motion, Pins]:
    """Lay a walk on an S of two bends of 162° each: its plants slide by centimetres."""
    ride = ride_of(clip)
    laid = on_path(clip, s_curve(ride.path.length), ride)
    return laid, plant_pins(laid)


def smoothed_in_turn(clip: Motion, pins: Pins, times: int) -> Motion:
    """Close each frame's gaps, smooth what that took over 0.05 s, and again: a quick way of many editors."""
    body = body_of(clip, pins.joints)
    for _ in range(times):
        change = gaussian_filter1d(
            solve(clip, pins, [REACH], body).change, 0.05 * clip.fps, axis=0, mode="nearest"
        )
        clip = displaced(clip, body.displacement(change, len(clip.skeleton)))
    return clip


def left(motion, pins):
    return 1000 * pin_errors(motion, pins).max()


@pytest.fixture(params=["bundled", "captured"])
def clip(request):
    return walk() if request.param == "bundled" else captured(request.getfixturevalue("real_data"))


def test_each_frame_by_itself_shakes(clip):
    laid, pins = bent(clip)
    assert left(laid, pins) > 45
    alone = solve(laid, pins, [REACH]).motion
    assert left(alone, pins) < 0.3
    assert smoothness(alone, clip) > 3


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_smoothing_in_turn_leaves_centimetres(clip):
    laid, pins = bent(clip)
    motions = [smoothed_in_turn(laid, pins, times) for times in (1, 7)]
    assert left(motions[0], pins) > 30 and left(motions[1], pins) > 10
    assert smoothness(motions[1], clip) < 1.1


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_on_a_child_with_long_steps_few_knots_miss_and_many_shake(clip):
    source = stance_of(clip)
    child = proportioned(source, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    worn = copied(clip, source, child, scale=1.4 * 0.55)
    pins = plant_pins(worn)
    assert left(worn, pins) > 70
    motions = [solve(worn, pins, [Basis(knots)]).motion for knots in (1.0, 0.25, 0.125, 0.03)]
    motions.append(solve(worn, pins, [REACH]).motion)
    errors = [left(motion, pins) for motion in motions]
    shakes = [smoothness(motion, worn) for motion in motions]
    assert errors[0] > 20 and errors[1] < 4.5 and errors[2] < 2 and errors[3] < 0.6 and errors[4] < 0.4
    assert shakes[2] < 1.35 and shakes[3] > 3 and shakes[4] > 14


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_spacetime_comes_the_nearer_the_denser_its_knots_until_it_shakes(clip):
    laid, pins = bent(clip)
    motions = [solve(laid, pins, [Basis(knots)]).motion for knots in (0.5, 0.25, 0.125, 0.06)]
    errors, shakes = (
        [way(m) for m in motions] for way in (lambda m: left(m, pins), lambda m: smoothness(m, clip))
    )
    assert np.array(errors) == pytest.approx(sorted(errors, reverse=True))
    assert errors[0] < 9.5 and errors[1] < 2.5 and errors[2] < 1.4 and errors[3] < 0.8
    assert max(shakes[:3]) < 1.1 < 1.14 < shakes[3]


def test_a_clean_up_holds_plants_exactly_before_spacetime_and_after(clip):
    laid, pins = bent(clip)
    for motion in (clean_up(laid), edit(laid, pins)):
        assert left(motion, pins) < 1e-6
        assert plants_kept(motion, clip) == 1
        assert smoothness(motion, clip) < 1.1
