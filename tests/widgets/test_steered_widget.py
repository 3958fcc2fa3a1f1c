"""The widget of steered characters without a browser: what it answers, what it records, what it refuses."""

import math

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.widgets import steered_widget
from mocap.widgets.steered_widget import steered
from tests.widgets.steerable import Dot

pytest.importorskip("anywidget")


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


@pytest.mark.parametrize("speeds", [(1.0, 1.0), (-1, 2), (math.nan, 2)])
def test_speeds_rise_from_0_on(speeds):
    with pytest.raises(MocapError, match="Speeds to ask for rise from 0 on"):
        steered({"dot": Dot()}, speeds=speeds)
