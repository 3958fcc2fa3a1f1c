"""Live widgets, canvases and mixers without a browser: Python's side of the traits."""

import importlib
import sys
import warnings
from functools import cache

import numpy as np
import pytest
from matplotlib.figure import Figure

from mocap.blending import register
from mocap.body import joint_positions, spline
from mocap.errors import MocapError, MocapWarning
from mocap.steering.path_following import follow_path
from mocap.widgets import Mixer, draw_path, explore, play, steered
from mocap.widgets.live import LIVE, STILL, WIDGET
from tests.blending.registered import turned, walks
from tests.bundled import walking
from tests.refusals import refused
from tests.strategies import wave
from tests.widgets.steerable import Dot

pytest.importorskip("anywidget")


@cache
def turns():
    """Two walks that turn, to the left and to the right."""
    return register([walks()[1.1, 120], walks()[1.1, -120]])


MADE = {
    "experiment": lambda: explore(lambda n: Figure(figsize=(2, 2)), alt="Nothing at all.", n=(0, 9)),
    "player": lambda: draw_path(lambda path: wave(30), [[0, 0], [0, 1]]),
    "mixer": lambda: Mixer(turns()),
    "steered": lambda: steered({"dot": Dot()}),
}


@pytest.mark.parametrize("kind", MADE)
def test_a_cell_shows_what_stays_with_its_sentence_and_then_the_live_widget(kind, monkeypatch):
    shown = []
    monkeypatch.setattr("IPython.display.display", lambda data, **options: shown.append((data, options)))
    made = MADE[kind]()
    made._ipython_display_()
    (data, options), (widget, _) = shown
    assert set(data) == {"image/png", "text/html", "text/plain"} and STILL in data["text/html"]
    assert data["text/plain"] == options["metadata"]["image/png"]["alt"]
    assert set(widget) == {WIDGET}
    assert LIVE in getattr(made, "box", made)._dom_classes


LIVE_ONES = ("experiments", "live_player", "pointing", "steered_widget")


@pytest.mark.parametrize("gone", ["anywidget", "ipywidgets"])
@pytest.mark.parametrize("kind", LIVE_ONES)
def test_without_the_libraries_one_sentence_says_what_to_install(kind, gone, monkeypatch):
    monkeypatch.setitem(sys.modules, gone, None)
    for name in ("shared_traits", *LIVE_ONES):
        monkeypatch.delitem(sys.modules, f"mocap.widgets.{name}", raising=False)
    with pytest.raises(MocapError, match=r'needs anywidget and ipywidgets: pip install "\.\[notebooks\]"'):
        importlib.import_module(f"mocap.widgets.{kind}")


def follow(path):
    """Walk for twenty frames a point, warn of three points, and fail at four."""
    if len(path) > 3:
        raise MocapError("No walk goes there.")
    if len(path) > 2:
        warnings.warn("The walk leaves the path.", MocapWarning, stacklevel=1)
    return wave(20 * len(path))


LINE = [[0.0, 0.0], [0.0, 2.0], [1.0, 2.0], [1.0, 3.0]]


@pytest.fixture
def canvas():
    return draw_path(follow, LINE[:2])


def test_frames_of_an_older_scene_do_not_count(canvas):
    assert repr(canvas) == "LivePlayer('A figure plays wave, 1.3 s.')"
    number = canvas.scene["number"]
    canvas.at = [number, 12]  # as the browser sends it
    assert canvas.frame == 12
    canvas.path = LINE[:3]
    assert (canvas.scene["number"], canvas.frame) == (number + 1, 0)
    canvas.at = [number, 40]
    assert canvas.frame == 0
    canvas.at = [number + 1, 40]
    assert canvas.frame == 40


def test_a_drawn_path_becomes_a_walk_and_warnings_and_errors_stand_below_it(canvas):
    for count, frames, below, error in [
        (2, 40, ["A figure plays wave, 1.3 s."], type(None)),
        (3, 60, ["A figure plays wave, 2.0 s.", "The walk leaves the path."], type(None)),
        (4, 60, ["MocapError: No walk goes there."], MocapError),
        (2, 40, ["A figure plays wave, 1.3 s."], type(None)),
    ]:
        canvas.path = LINE[:count]
        assert (canvas.scene["frames"], canvas.scene["asked"]) == (frames, LINE[: frames // 20])
        assert canvas.message.splitlines() == below and isinstance(canvas.error, error)
        assert canvas.scene["drawable"] and canvas.frame == 0
    refused("No walk", draw_path, follow, LINE)


def test_the_best_walk_so_far_is_told_while_a_search_is_under_way(monkeypatch):
    monkeypatch.setattr("mocap.widgets.live_player.REPORT_INTERVAL", 0.0)
    graph, told = walking(), []
    canvas = draw_path(lambda path: follow_path(graph, spline(path)).motion(), [[0, 0], [0, 2]])
    canvas.observe(lambda change: told.append(np.array(change["new"])), "best")
    canvas.path = [[0.0, 0.0], [0.0, 2.0], [0.3, 4.0]]
    assert canvas.error is None and len(told) > 5
    assert np.linalg.norm(told[-1][-1] - [0.3, 4.0]) < 0.7 and np.linalg.norm(told[-1][0]) < 0.3
    follow_path(graph, spline([[0, 0], [1, 3]]))
    assert np.linalg.norm(np.array(canvas.best)[-1] - [0.3, 4.0]) < 0.7  # another search is not the canvas's


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


@pytest.fixture
def mixer():
    return Mixer(turns(), [1, 0])


def shown(mixer):
    return mixer.player.player.motions[0]


def test_what_was_played_stays_and_the_rest_changes(mixer):
    before = shown(mixer)
    mixer.player.at = [mixer.player.scene["number"], 45]  # as the browser sends it
    mixer.sliders[1].value = 1.0
    mixer.sliders[0].value = 0.0
    after = shown(mixer)
    np.testing.assert_allclose(joint_positions(after)[:45], joint_positions(before)[:45], atol=1e-6)
    assert np.abs(joint_positions(after)[-1] - joint_positions(before)[-1]).max() > 0.3
    assert turned(before) > 60 and turned(after) < 0.5 * turned(before)


def test_the_player_goes_on_from_the_frame_that_it_showed(mixer):
    mixer.player.at = [mixer.player.scene["number"], 40]
    mixer.sliders[1].value = 0.5
    assert mixer.player.frame == 40
    assert mixer.player.move == [mixer.player.scene["number"], 40]
    assert mixer.player.scene["autoplay"] and mixer.player.scene["reports"]


def test_changes_after_the_frame_are_forgotten(mixer):
    for frame, value in ((60, 1.0), (20, 0.5), (25, 0.0)):
        mixer.player.at = [mixer.player.scene["number"], frame]
        mixer.sliders[1].value = value
    assert [begin for begin, _ in mixer.changes] == pytest.approx([20 / 30, 25 / 30])
    assert mixer.weights(0, 9).tolist() == [1, 0]
    assert mixer.weights(0, 20 / 30).tolist() == [1, 0]
    weights = np.array([mixer.weights(0, t) for t in np.linspace(0, 3, 200)])
    np.testing.assert_allclose(weights.sum(axis=1), 1)


def test_all_sliders_at_0_change_nothing_and_clips_of_one_name_are_numbered(mixer):
    mixer.sliders[0].value = 0.0
    assert not mixer.changes and "2 clips" in repr(mixer)
    assert [slider.description for slider in mixer.sliders] == ["walk 1", "walk 2"]
    assert Mixer(mixer.registration).start.tolist() == [0.5, 0.5]


def test_weights_that_do_not_add_up_are_refused():
    refused("add up to 1", Mixer, turns(), [1, 1])
