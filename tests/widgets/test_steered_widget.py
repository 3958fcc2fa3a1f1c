"""Characters that step together, each on its own time, and the widget that steers them, without a browser."""

import cmath
import math
import warnings
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body.kinematics import joint_positions
from mocap.errors import MocapError, MocapWarning
from mocap.steering.characters import CommandClock, as_motion, between
from mocap.widgets import steered, steered_widget
from mocap.widgets.company import START, Company
from tests.refusals import refusals
from tests.widgets.steerable import Dot

pytest.importorskip("anywidget")


@settings(max_examples=15)
@given(st.lists(st.floats(0, 0.1), min_size=1, max_size=6))
def test_frames_are_counted_by_seconds_however_they_are_asked_for(pieces):
    company = Company({"slow": Dot(fps=30.0), "fast": Dot(fps=120.0)})
    walked = [company.walk(START, seconds) for seconds in pieces]
    for member, frames in zip(company.members, zip(*walked, strict=True), strict=True):
        assert sum(len(one.poses) for one in frames) == member.steps - 1
        assert member.steps == 1 + round(sum(pieces) * member.character.fps)
        firsts = np.cumsum([1, *(len(one.poses) for one in frames)])[:-1]
        assert [one.report["first"] for one in frames] == firsts.tolist()


def test_places_are_the_joints_at_which_bones_end():
    company = Company({"dot": Dot()})
    (walked,) = company.walk((1.0, 1.1, ""), 0.3)
    motion = as_motion(company.members[0].character, walked.poses)
    joints, body = company.members[0].joints, company.members[0].body
    np.testing.assert_allclose(walked.positions, joint_positions(motion)[:, joints], atol=1e-12)
    assert joints[0] == 0 and max(max(line[:2]) for line in body["bones"]) < len(joints)


class Odd(Dot):
    """It does something with each command before it obeys."""

    def __init__(self, first):
        super().__init__()
        self.first = first

    def step(self, heading, speed, label=""):
        return super().step(*self.first(heading, speed, label))


def stumble(heading, speed, label):
    if label == "fly":
        raise MocapError("No clip flies.")
    return math.nan if heading > 1 else heading, speed, label


def test_who_fails_stands_still_until_the_order_changes_and_says_why():
    company = Company({"sure": Dot(), "stumbling": Odd(stumble)})
    company.walk((0, 1, "fly"), 0.2)
    _, forgotten = company.walk(START, 0.2)
    assert forgotten.report["fault"] == "" and np.ptp(forgotten.positions, axis=0).max() > 0.1
    for order, why in [((0, 1, "fly"), "MocapError: No clip flies."), ((2.0, 1.1, ""), "not finite")]:
        sure, stumbling = company.walk(order, 0.5)
        assert why in stumbling.report["fault"] and len(stumbling.report["fault"]) <= 200
        assert np.ptp(stumbling.positions, axis=0).max() == 0
        assert (sure.report["fault"], len(sure.poses)) == ("", len(stumbling.poses))
        assert np.ptp(sure.positions, axis=0).max() > 0.3


def test_an_error_at_the_first_step_is_raised():
    with pytest.raises(ZeroDivisionError):
        Company({"broken": Odd(lambda *_: 1 / 0)})


def test_warnings_are_kept_once_each():
    def warn(*command):
        warnings.warn("5 m/s is too fast.", MocapWarning, stacklevel=1)
        return command

    company = Company({"warning": Odd(warn)})
    company.walk((0, 5, ""), 0.2)
    assert company.notes == ["5 m/s is too fast."] and company.cost > 0


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


def two():
    return steered({"quick": Dot(math.radians(240)), "slow": Dot(math.radians(40))})


@pytest.fixture(scope="module")
def page():
    page = two()
    page.sent = []
    page.send = lambda content, buffers=(): page.sent.append((content, buffers))
    return page


def ask(page, **change):
    asked = {"kind": "ask", "view": 0.5, "number": 3, "seconds": 0.2, "command": [0.5, 1.0, ""]}
    page.answer(page, asked | change, [])
    return page.sent[-1]


def test_a_question_is_answered_by_frames_and_numbers(page):
    content, buffers = ask(page)
    assert (content["kind"], content["view"], content["number"]) == ("walked", 0.5, 3)
    for member, packed, buffer in zip(content["members"], page.scene["members"], buffers, strict=True):
        frames = len(member["waited"])
        assert frames == len(member["obeyed"]) == len(member["blending"]) == 6
        numbers = np.frombuffer(buffer, "<f4").reshape(frames, packed["joints"], 3)
        assert np.isfinite(numbers).all()
    after, _ = ask(page)
    assert after["members"][0]["first"] == content["members"][0]["first"] + 6


def test_the_frames_go_on_where_the_last_ones_ended(page):
    before, after = (np.frombuffer(ask(page)[1][0], "<f4").reshape(-1, 3) for _ in range(2))
    joints = page.scene["members"][0]["joints"]
    assert np.linalg.norm(after[0] - before[-joints]) < 0.05


@pytest.mark.parametrize(
    "change",
    [{"command": [0.5]}, {"command": [math.nan, 1, ""]}, {"command": [0, -1, ""]}, {"seconds": "long"}],
)
def test_a_question_that_makes_no_sense_is_refused_and_nobody_moves(page, change):
    steps = page.company.members[0].steps
    content, _ = ask(page, **change)
    assert content["kind"] == "refused" and len(content["why"]) <= 200
    assert page.company.members[0].steps == steps


@pytest.mark.parametrize("seconds", [-5.0, 1e9, math.nan])
def test_no_answer_is_longer_than_a_second(page, seconds):
    content, _ = ask(page, seconds=seconds)
    assert content["kind"] == "refused" or len(content["members"][0]["waited"]) <= 30


def test_python_reads_the_delays_and_sets_the_command(page):
    for heading in (0.5, 2.0):
        ask(page, command=[heading, 1.0, ""], seconds=1.0)
        ask(page, command=[heading, 1.0, ""], seconds=1.0)
    assert 0.3 < page.delays["quick"][-1] < 1.2
    assert min(page.delays["slow"]) > max(page.delays["quick"])
    page.command = [1.0, 0.7, "walk"]
    with pytest.raises(MocapError, match="finite heading"):
        page.command = [math.inf, 1, ""]
    assert page.command == [1.0, 0.7, "walk"]


def test_the_recording_shows_all_side_by_side_and_turns_as_it_says():
    page = two()
    assert set(map(len, page.delays.values())) == {0}  # they are the reader's
    data, metadata = page.still
    assert "4 s to the left" in data["text/html"] and "mocap-player" in data["text/html"]
    assert metadata["image/png"]["alt"] == page.alt == "Figures obey one command: quick, slow."
    dots = [member.character for member in page.company.members]
    assert dots[0].heading == pytest.approx(-math.pi / 4, abs=0.02)
    motions = steered_widget._recorded(steered_widget.Company({"a": Dot(), "b": Dot()}), 1.0)
    starts = np.array([motion.root_positions[0] for motion in motions])
    np.testing.assert_allclose(starts[:, [0, 2]], [[-0.75, 0], [0.75, 0]], atol=0.05)


def test_one_alone_is_dark_and_its_speed_may_be_asked_for(page):
    alone = steered({"dot": Dot()}, speeds=(0.3, 0.9))
    assert alone.command[1] == 0.9
    assert alone.scene["members"][0]["colour"] == "#333333"
    assert len({member["colour"] for member in page.scene["members"]}) == 2


DOT = Dot()

test_one_to_four_are_steered_none_twice_and_speeds_rise_from_0_on = refusals(
    *(
        (
            f"One to 4 characters walk side by side, got {count}",
            Company,
            {str(n): Dot() for n in range(count)},
        )
        for count in (0, 5)
    ),
    ("two names", Company, {"a": DOT, "b": DOT}),
    *(
        ("Speeds to ask for rise from 0 on", partial(steered, {"dot": DOT}, speeds=speeds))
        for speeds in ((1.0, 1.0), (-1, 2), (math.nan, 2))
    ),
)
