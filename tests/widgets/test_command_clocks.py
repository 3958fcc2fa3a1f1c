"""The clock of a command gives the delays that `measure_delay` gives, and ignores what is no turn."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.steering import measure_delay
from mocap.widgets.command_clocks import CommandClock, between
from tests.widgets.steerable import Dot


class Clocked(Dot):
    """A dot that carries a clock along while `measure_delay` commands it."""

    def __init__(self, rate):
        super().__init__(rate)
        self.clock = CommandClock(self.fps)

    def step(self, heading, speed, label=""):
        pose = super().step(heading, speed, label)
        self.clock.command(heading)
        self.clock.step(complex(pose.root_position[2], pose.root_position[0]))
        return pose


@given(st.floats(-50, 50), st.floats(-50, 50))
def test_headings_differ_by_less_than_half_a_turn_whatever_their_numbers(a, b):
    assert between(a, b) == pytest.approx(abs(cmath.phase(cmath.exp(1j * a) / cmath.exp(1j * b))), abs=1e-6)
    assert 0 <= between(a, b) <= math.pi


@pytest.mark.parametrize("rate", [60, 120, 1000])
def test_the_delays_are_those_of_measure_delay(rate):
    dot = Clocked(math.radians(rate))
    mean = measure_delay(dot, turns=60).mean
    # `measure_delay` counts its first turn, too, which comes before there is any way.
    assert len(dot.clock.delays) >= 57
    assert np.mean(dot.clock.delays) == pytest.approx(mean, rel=0.03)


def drive(clock, headings, dot):
    for heading in headings:
        clock.command(heading)
        pose = dot.step(heading, 1.0)
        clock.step(complex(pose.root_position[2], pose.root_position[0]))


def test_a_heading_that_is_dragged_along_starts_the_clock_again_but_a_tremor_does_not():
    clock, dot = CommandClock(30.0), Dot(math.radians(90))
    drive(clock, [0.0] * 40, dot)
    drive(clock, np.linspace(0, 1.5, 45), dot)
    assert clock.waited < 0.2 and not clock.obeyed
    drive(clock, 1.5 + 0.02 * np.sin(np.arange(60)), dot)
    assert clock.obeyed and 0 < clock.waited < 2


def test_a_small_turn_and_one_that_was_given_up_do_not_count():
    clock, dot = CommandClock(30.0), Dot(math.radians(60))
    drive(clock, [0.0] * 40 + [0.3] * 60, dot)  # 17 degrees
    assert clock.obeyed and clock.delays == []
    drive(clock, [3.0] * 5, dot)
    drive(clock, [0.4] * 60, dot)
    assert clock.delays == []
    drive(clock, [0.4 + math.pi / 2] * 90, dot)
    assert len(clock.delays) == 1
