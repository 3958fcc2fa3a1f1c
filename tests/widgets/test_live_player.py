"""Linked players without a browser: Python's side of the traits."""

import warnings

import numpy as np
import pytest

from mocap.body import spline
from mocap.errors import MocapError, MocapWarning
from mocap.widgets.live_player import draw_path, linked
from mocap.widgets.player import play
from tests.strategies import wave

pytest.importorskip("anywidget")


def test_a_frame_that_is_set_is_observed():
    player, heard = linked(play(wave(30))), []
    player.observe(lambda change: heard.append(change["new"]), "frame")
    player.frame = 29
    assert heard == [29]
    assert repr(player) == "LivePlayer('A stick figure plays wave, 1.0 s.')"


@pytest.mark.parametrize("frame", [-1, 30])
def test_a_frame_that_does_not_exist_is_refused(frame):
    player = linked(play(wave(30)))
    with pytest.raises(MocapError, match="frames 0 to 29"):
        player.frame = frame
    assert player.frame == 0


def test_frames_of_an_older_scene_do_not_count():
    canvas = draw_path(lambda path: wave(30 * len(path)), [[0, 0], [0, 1]])
    canvas.at = [0, 12]  # as the browser sends it
    assert (canvas.frame, canvas.move) == (12, [0, 0])
    canvas.path = [[0, 0], [0, 1], [0, 2]]
    assert canvas.scene["number"] == 1
    canvas.at = [0, 40]
    assert canvas.frame == 0
    canvas.at = [1, 40]
    assert canvas.frame == 40
    canvas.frame = 50
    assert canvas.move == [1, 50]


def test_warnings_stand_below_the_canvas():
    def follow(path):
        warnings.warn(f"The walk leaves the path {len(path)} times.", MocapWarning, stacklevel=1)
        return wave(30)

    canvas = draw_path(follow, [[0, 0], [0, 1]])
    assert canvas.message.splitlines() == [canvas.player.alt, "The walk leaves the path 2 times."]
    canvas.path = [[0, 0], [0, 1], [0, 2]]
    assert canvas.message.splitlines()[1] == "The walk leaves the path 3 times."


def test_a_drawn_path_becomes_a_walk():
    asked = []

    def follow(path):
        asked.append(path)
        return wave(20 * len(path))

    canvas = draw_path(follow, [[0, 0], [0, 1]])
    assert canvas.scene["frames"] == 40
    assert canvas.scene["drawable"]
    canvas.frame = 39
    canvas.path = [[0.0, 0.0], [0.0, 2.0], [1.0, 2.0]]
    assert [path.shape for path in asked] == [(2, 2), (3, 2)]
    assert canvas.scene["frames"] == 60
    assert canvas.scene["asked"] == [[0, 0], [0, 2], [1, 2]]
    assert (canvas.frame, canvas.error, canvas.message) == (0, None, canvas.player.alt)


def test_the_path_that_was_followed_is_drawn_instead_of_the_readers_line():
    def follow(path):
        followed = spline(path).points
        return play(wave(30), path=followed)

    canvas = draw_path(follow, [[0, 0], [0, 2], [1, 2]])
    assert np.array(canvas.scene["asked"]) == pytest.approx(spline(canvas.path).points, abs=1e-3)
    canvas.path = [[0, 0], [0, 1], [0, 3]]
    assert np.array(canvas.scene["asked"])[-1] == pytest.approx([0, 3])
    assert len(canvas.scene["asked"]) > 3
    assert canvas.path == [[0, 0], [0, 1], [0, 3]]


def test_a_shorter_walk_may_come_after_a_longer_one():
    canvas = draw_path(lambda path: play(wave(90 // len(path)), sources=[(0, "wave")]), np.zeros((1, 2)))
    canvas.frame = 80
    canvas.path = [[0, 0], [0, 1], [0, 2]]
    assert (canvas.frame, canvas.scene["frames"]) == (0, 30)
    assert canvas.scene["characters"][0]["sources"]


def test_an_error_is_shown_until_the_next_path():
    def follow(path):
        if len(path) > 2:
            raise MocapError("No walk goes there.")
        return wave(30)

    canvas = draw_path(follow, [[0, 0], [0, 1]])
    canvas.path = [[0, 0], [0, 1], [0, 2]]
    assert canvas.message == "MocapError: No walk goes there."
    assert isinstance(canvas.error, MocapError)
    canvas.path = [[0, 0], [0, 2]]
    assert (canvas.error, canvas.message) == (None, "A stick figure plays wave, 1.0 s.")
    with pytest.raises(MocapError, match="No walk"):
        draw_path(follow, [[0, 0], [0, 1], [0, 2]])
