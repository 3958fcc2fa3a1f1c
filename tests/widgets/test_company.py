"""Characters that step together: each on its own time, and one that fails does not stop the others."""

import cmath
import math
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError, MocapWarning
from mocap.steering.characters import as_motion
from mocap.steering.delays import CommandClock, between
from mocap.widgets.company import START, Company
from tests.refusals import refused
from tests.widgets.steerable import Dot


@settings(max_examples=15)
@given(st.lists(st.floats(0, 0.1), min_size=1, max_size=6))
def test_frames_are_counted_by_seconds_however_they_are_asked_for(pieces):
    company = Company({"slow": Dot(fps=30.0), "fast": Dot(fps=120.0)})
    walked = [company.walk(START, seconds) for seconds in pieces]
    for member, frames in zip(company.members, zip(*walked, strict=True), strict=True):
        assert sum(len(one.poses) for one in frames) == member.steps - 1
        assert member.steps == 1 + round(sum(pieces) * member.character.fps)
        firsts = np.cumsum([1, *(len(one.poses) for one in frames)])[:-1]
        assert [one.told["first"] for one in frames] == firsts.tolist()


def test_places_are_the_joints_at_which_bones_end():
    company = Company({"dot": Dot()})
    (walked,) = company.walk((1.0, 1.1, ""), 0.3)
    motion = as_motion(company.members[0].character, walked.poses)
    drawn = company.members[0].drawn
    np.testing.assert_allclose(walked.places, joint_positions(motion)[:, drawn.joints], atol=1e-12)
    assert drawn.joints[0] == 0 and max(max(line[:2]) for line in drawn.bones) < len(drawn.joints)


class Stumbling(Dot):
    def step(self, heading, speed, label=""):
        if label == "fly":
            raise MocapError("No clip flies.")
        if heading > 1:
            return super().step(math.nan, speed)
        return super().step(heading, speed, label)


def test_who_fails_stands_still_until_the_order_changes_and_says_why():
    company = Company({"sure": Dot(), "stumbling": Stumbling()})
    company.walk((0, 1, "fly"), 0.2)
    _, forgotten = company.walk(START, 0.2)
    assert forgotten.told["fault"] == "" and np.ptp(forgotten.places, axis=0).max() > 0.1
    for order, why in [((0, 1, "fly"), "MocapError: No clip flies."), ((2.0, 1.1, ""), "not finite")]:
        sure, stumbling = company.walk(order, 0.5)
        assert why in stumbling.told["fault"] and len(stumbling.told["fault"]) <= 200
        assert np.ptp(stumbling.places, axis=0).max() == 0
        assert (sure.told["fault"], len(sure.poses)) == ("", len(stumbling.poses))
        assert np.ptp(sure.places, axis=0).max() > 0.3


def test_an_error_at_the_first_step_is_raised():
    class Broken(Dot):
        def step(self, heading, speed, label=""):
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        Company({"broken": Broken()})


def test_warnings_are_kept_once_each():
    class Warning_(Dot):
        def step(self, heading, speed, label=""):
            warnings.warn("5 m/s is too fast.", MocapWarning, stacklevel=1)
            return super().step(heading, speed)

    company = Company({"warning": Warning_()})
    company.walk((0, 5, ""), 0.2)
    assert company.notes == ["5 m/s is too fast."] and company.cost > 0


def test_one_to_four_walk_side_by_side_and_none_twice():
    for count in (0, 5):
        with pytest.raises(MocapError, match=f"One to 4 characters walk side by side, got {count}"):
            Company({str(number): Dot() for number in range(count)})
    dot = Dot()
    refused("two names", Company, {"a": dot, "b": dot})


@given(st.floats(-50, 50), st.floats(-50, 50))
def test_headings_differ_by_less_than_half_a_turn_whatever_their_numbers(a, b):
    assert between(a, b) == pytest.approx(abs(cmath.phase(cmath.exp(1j * a) / cmath.exp(1j * b))), abs=1e-6)
    assert 0 <= between(a, b) <= math.pi


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
    drive(clock, [0.0] * 40 + [0.1] * 60, dot)  # 6 degrees
    assert clock.heading == clock.started == 0.1
    drive(clock, [0.4] * 60, dot)  # 17 degrees more
    assert clock.obeyed and clock.delays == []
    drive(clock, [3.0] * 5, dot)
    drive(clock, [0.4] * 60, dot)
    assert clock.delays == []
    drive(clock, [0.4 + math.pi / 2] * 90, dot)
    assert len(clock.delays) == 1
