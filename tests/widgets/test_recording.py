"""Experiments recorded for pages without Python."""

import base64
import io
import json

import matplotlib.pyplot as plt
import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from PIL import Image

from mocap.widgets import recording
from mocap.widgets.experiments import explore

ALT = "Points at random, as many as the slider says."


def noise(**control):
    """Show an experiment whose pictures are hard to compress."""
    (name,) = control

    def draw(value):
        figure = plt.figure(figsize=(2, 1.5))
        figure.add_axes([0, 0, 1, 1]).imshow(np.random.default_rng(int(500 + 4 * value)).random((75, 100)))
        return figure

    def named(first=0):
        return draw(first)

    def titled(grow_by=False):
        return draw(grow_by)

    return explore(named if name == "first" else titled, alt=ALT, **control)


def opened(recorded):
    return [Image.open(io.BytesIO(base64.b64decode(png))) for png in recorded["pictures"]]


@pytest.mark.parametrize(
    ("control", "labels"),
    [
        ((0, 3), ["0", "1", "2", "3"]),
        ((0.0, 1.0, 0.25), ["0", "0.25", "0.5", "0.75", "1"]),
        ({"none": 0, "some": 5}, ["none", "some"]),
        ([4, 0], ["4", "0"]),
        (False, ["off", "on"]),
    ],
)
def test_each_kind_of_control_has_its_positions(control, labels):
    experiment = noise(first=control)
    recorded = recording.record(experiment, room=10**7)
    assert (recorded["name"], recorded["labels"], recorded["alt"]) == ("first", labels, ALT)
    assert recorded["at"] == (1 if control == [4, 0] else 0)
    assert len({picture.tobytes() for picture in opened(recorded)}) == len(labels)
    assert experiment.values() == {"first": 0}  # it is back in its place


@pytest.mark.parametrize(("count", "at"), [(1001, 0), (404, 3), (502, 500), (18, 0), (16, 7), (15, 14)])
def test_long_ranges_keep_their_ends_and_the_place_at_rest(count, at):
    places = recording._spread(count, at, 15)
    assert places == sorted(set(places))
    assert len(places) == 15
    assert {0, at, count - 1} <= set(places)


@pytest.mark.parametrize("room", [pytest.param(40_000, marks=pytest.mark.sweep), 20_000])
def test_the_pictures_fit_the_room(room):
    recorded = recording.record(noise(first=(0, 20)), room=room)
    assert sum(len(base64.b64decode(png)) for png in recorded["pictures"]) <= room
    assert 5 <= len(recorded["pictures"]) <= 15
    assert len({picture.size for picture in opened(recorded)}) == 1


def test_the_experiments_that_cells_show_are_recorded(tmp_path, monkeypatch):
    shell = InteractiveShell()
    monkeypatch.setattr("IPython.get_ipython", lambda: shell)
    recording.watch(str(tmp_path))
    shell.user_ns["noise"] = noise
    for cell in ("1 + 1", "noise(grow_by=(0, 2))", "shown = noise(first=(0, 2))"):
        shell.run_cell(cell)
    (kept,) = tmp_path.iterdir()
    recorded = json.loads(kept.read_text("utf-8"))
    assert (recorded["source"], recorded["name"]) == ("noise(grow_by=(0, 2))", "grow by")
    assert recorded["labels"] == ["0", "1", "2"]


def test_a_position_that_cannot_be_drawn_is_said(tmp_path, monkeypatch):
    def draw(first=0):
        return plt.figure(figsize=(1 / (2 - first), 1))

    shell = InteractiveShell()
    monkeypatch.setattr("IPython.get_ipython", lambda: shell)
    recording.watch(str(tmp_path))
    shell.user_ns["shown"] = explore(draw, alt=ALT, first=(0, 2))
    shell.run_cell("shown")
    (kept,) = tmp_path.iterdir()
    assert json.loads(kept.read_text("utf-8"))["error"].startswith("ZeroDivisionError")
