"""Where the feet of a retargeted body may be."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.editing.body_roles import FEET
from mocap.editing.copied_motion import copied
from mocap.editing.pins import pin_errors
from mocap.editing.retargeting import dips_of, floor_pins
from mocap.errors import MocapError
from tests.editing.bodies import adult, child, walk


def test_plants_are_held_at_the_heights_of_the_stance_a_flat_foot_apart():
    thick = {
        role: height + (0.02 if role.endswith("ankle") else 0.01) for role, height in child().heights.items()
    }
    stance = replace(child(), heights=thick)
    base = copied(walk(), adult(), stance)
    pins = floor_pins(base, stance)
    for side, (ankle, ball) in enumerate([(0, 1), (2, 3)]):
        both = pins.held[:, [ankle, ball], 0].all(axis=1)
        assert both.any()
        apart = np.linalg.norm(pins.low[both][:, ankle] - pins.low[both][:, ball], axis=-1)
        assert np.allclose(apart, stance.legs[side].lengths(stance.skeleton)[2])
    for column, role in enumerate(FEET):
        held = pins.held[:, column, 1]
        assert np.allclose(pins.low[held, column, 1], thick[role])
        assert np.array_equal(held, base.contacts[base.skeleton.names[stance.roles[role]]])


def test_a_body_that_stands_meets_its_pins():
    assert pin_errors(walk(), floor_pins(walk(), adult())).max() < 5e-9  # as the clip is stored


def test_a_floor_bounds_feet_in_all_other_frames():
    plants = floor_pins(walk(), adult())
    assert not plants.asked.all()
    floor = floor_pins(walk(), adult(), dict.fromkeys(FEET, 0.01))
    assert floor.asked.all()
    swings = ~floor.held[:, 0, 1]
    assert np.allclose(floor.low[swings, 0, 1], adult().heights["left ankle"] - 0.01)
    assert np.array_equal(floor.held, plants.held)
    sunk = replace(walk(), root_positions=walk().root_positions - [0, 0.05, 0])
    assert pin_errors(sunk, floor).max() == pytest.approx(0.05)
    assert dips_of(sunk, adult())["left ball"] == pytest.approx(0.05 + dips_of(walk(), adult())["left ball"])


def test_marks_are_needed():
    with pytest.raises(MocapError, match="does not say when these joints stand"):
        floor_pins(replace(walk(), contacts={}), adult())


def test_a_step_is_brought_down_to_the_level_floor():
    higher = replace(walk(), root_positions=walk().root_positions + np.array([0, 0.2, 0]))
    assert np.array_equal(floor_pins(higher, adult()).low, floor_pins(walk(), adult()).low)
