"""Experiments, recorded for pages without Python."""

import base64
import io
import json

import matplotlib.pyplot as plt
import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from PIL import Image

from mocap.course import recording
from mocap.widgets import explore, handles

pytest.importorskip("anywidget")

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


def test_the_pictures_fit_the_room():
    recorded = recording.record(noise(first=(0, 20)), room=20_000)
    assert sum(len(base64.b64decode(png)) for png in recorded["pictures"]) <= 20_000
    assert 5 <= len(recorded["pictures"]) <= 15
    assert len({picture.size for picture in opened(recorded)}) == 1


def kept_of(folder, names, *cells):
    """Run cells that show experiments, and give what is kept of the one that is recorded."""
    shell = InteractiveShell()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("IPython.get_ipython", lambda: shell)
        recording.watch(str(folder))
    shell.user_ns.update(names)
    for cell in cells:
        shell.run_cell(cell)
    (kept,) = folder.iterdir()
    return json.loads(kept.read_text("utf-8"))


def test_the_experiments_that_cells_show_are_recorded(tmp_path):
    cells = ("1 + 1", "noise(grow_by=(0, 2))", "shown = noise(first=(0, 2))")
    recorded = kept_of(tmp_path, {"noise": noise}, *cells)
    assert (recorded["source"], recorded["name"]) == ("noise(grow_by=(0, 2))", "grow by")
    assert recorded["labels"] == ["0", "1", "2"]


def test_a_position_that_cannot_be_drawn_is_said(tmp_path):
    shown = explore(lambda first=0: plt.figure(figsize=(1 / (2 - first), 1)), alt=ALT, first=(0, 2))
    assert kept_of(tmp_path, {"shown": shown}, "shown")["error"].startswith("ZeroDivisionError")


def test_handles_are_left_where_they_are_and_alone_are_not_recorded():
    ax = plt.figure().add_subplot(xlim=(0, 1), ylim=(0, 1))

    def draw(way, scale=1.0):
        return ax.plot(way)

    way = handles(ax, [[0, 1], [1, 0]])
    assert recording.record(explore(draw, alt=ALT, way=way, scale=(0.5, 1.5)))["name"] == "scale"
    assert recording.record(explore(draw, alt=ALT, way=way)) is None


def test_a_thing_has_one_colour_in_all_pictures():
    def draw(dots=1):
        figure = plt.figure(figsize=(3, 2))
        axes = figure.add_subplot()
        axes.imshow(np.linspace(0, 1, 100 * dots).reshape(10, -1), cmap="jet", aspect="auto")
        axes.scatter(range(dots), [5] * dots, s=400, color=(137 / 255, 172 / 255, 142 / 255))
        return figure

    recorded = recording.record(explore(draw, alt=ALT, dots=(1, 4)), room=10**7)
    colours = [np.array(picture.convert("RGB")) for picture in opened(recorded)]
    discs = []
    for picture in colours:
        near = np.abs(picture.astype(int) - (137, 172, 142)).max(axis=-1) < 30
        discs.append({tuple(colour) for colour in picture[near]})
    assert all(discs)
    assert len(set.union(*discs)) == max(map(len, discs))
