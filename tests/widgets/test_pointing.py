"""Images to click on and handles on a picture, driven from Python."""

import base64
import io

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

from mocap.blending import joining
from mocap.errors import MocapError
from mocap.matching import distance_grids
from mocap.plotting import grids, stick_figures
from mocap.widgets import experiments, recording
from mocap.widgets.pointing import handles, pointer
from tests.course import driving
from tests.refusals import refused
from tests.strategies import wave

pytest.importorskip("anywidget")

CLIPS = wave(40, name="a"), wave(50, phase=1, name="b")
GRID = distance_grids.distance_grid(*CLIPS, window=10)  # shape (31, 41)


def lay(at=(3, 20)):
    """Lay the windows over each other, as a notebook does."""
    (a, b), (i, j) = CLIPS, at
    return stick_figures.film_strip([a[i : i + 10], joining.lay_window_on(a, i, b, j, 10)[j : j + 10]])


def experiment():
    return experiments.explore(lay, alt="Two windows.", at=grids.distance_image(GRID, fps=30))


@pytest.fixture(scope="module")
def shown():
    return experiment()


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def test_a_click_lays_the_two_windows_over_each_other():
    grid = experiment()
    before = pixels(grid.picture.value)
    assert plt.get_fignums() == []
    grid.controls["at"].value = [30, 40]  # as the browser sends it
    assert grid.values() == {"at": (30, 40)}
    assert np.any(pixels(grid.picture.value) != before)
    assert repr(grid) == "Experiment(lay, at=(30, 40))"
    cost = f"{100 * np.sqrt(GRID[30, 40]):.3g}"
    assert grid.controls["at"].status == f"row 30, column 40: RMS distance (cm) {cost}"


@pytest.mark.parametrize("at", [(31, 0), (0, -1), (1, 2, 3), (1.5, 2)])
def test_a_place_outside_the_image_is_refused(at, shown):
    before = shown.values()
    refused("Rows go from 0 to 30, columns to 40", shown.set, at=at)
    assert shown.values() == before


def test_what_stays_is_both_pictures_in_one(shown):
    data, metadata = shown.still()
    assert set(data) == {"image/png", "text/html", "text/plain"}
    assert data["text/plain"] == metadata["image/png"]["alt"] == "Two windows."
    both, alone = pixels(base64.b64decode(data["image/png"])), pixels(shown.picture.value)
    assert both.shape[1] > alone.shape[1] + 400
    assert np.abs(both[: len(alone), -alone.shape[1] :] - alone).max() < 16  # in few colours
    assert len(data["image/png"]) < 90_000


@pytest.mark.parametrize(("origin", "value"), [("upper", (0, 0)), ("lower", (2, 4))])
def test_the_ring_is_round_the_number_meant(origin, value):
    numbers = np.zeros((3, 5))
    numbers[value] = 1
    ax = plt.figure(figsize=(5, 4), layout="constrained").add_subplot()
    at = pointer(ax.imshow(numbers, cmap="gray", origin=origin), np.array(value))
    (left, top, wide, high), (rows, columns) = at.box, at.shape
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(at.picture.split(",")[1]))).convert("L"))
    x = int((left + wide * (value[1] + 0.5) / columns) * picture.shape[1])
    y = int((top + high * (value[0] + 0.5) / rows) * picture.shape[0])
    assert picture[y, x] == 255
    grown = high / rows * picture.shape[0]
    beside = int(y - grown) if value[0] == 2 else int(y + grown)
    assert picture[beside, x] == 0
    ringed = np.asarray(at.with_ring().convert("L")).astype(int)
    ys, xs = np.nonzero(ringed != picture)
    assert (ys.mean(), xs.mean()) == pytest.approx((y, x), abs=1.5)


def test_an_image_of_colours_is_refused():
    refused("rows and columns of numbers", pointer, plt.figure().add_subplot().imshow(np.zeros((4, 4, 3))))


POINTS = [[0, 1], [0, 3], [0, 5]]


def ground():
    figure = plt.figure(figsize=(4, 4), layout="constrained")
    return figure.add_subplot(xlim=(3, -3), ylim=(0, 6), xlabel="x (m)", ylabel="z (m)")


def bent(**more):
    """Make an experiment whose line goes through the handles."""
    ax = ground()
    (line,) = ax.plot([], [], linewidth=4)

    def bend(way, scale=1.0):
        line.set_data(scale * np.array(way).T)
        return [line]

    return experiments.explore(bend, alt="A line through three handles.", way=handles(ax, POINTS), **more)


def test_the_picture_follows_a_dragged_handle():
    experiment = bent()
    before = pixels(experiment.png)
    experiment.controls["way"].value = [[0, 1], [2, 3], [0, 5]]  # as the browser sends it
    assert experiment.values()["way"] == ((0, 1), (2, 3), (0, 5))
    assert np.any(pixels(experiment.png) != before)
    assert experiment.picture.picture == experiment.png
    assert experiment.picture is experiment.controls["way"]
    assert plt.get_fignums() == []


def test_handles_are_drawn_where_the_axes_have_their_points():
    """A line through the handles lies in the middle of each."""
    experiment = bent().set(way=((1, 1), (-2, 3), (2.5, 5.5)))
    handled = experiment.controls["way"]
    ringed, drawn = np.asarray(handled.with_handles()).astype(int), pixels(experiment.png)
    left, top, right, bottom = handled.box
    assert 0 < left < right < 1
    assert 0 < top < bottom < 1
    still = pixels(base64.b64decode(experiment.still()[0]["image/png"]))
    assert np.abs(still - ringed).max() < 32  # what stays has the handles in it, in few colours
    high, wide = drawn.shape[:2]
    for x, z in handled.value:
        column = wide * (left + (right - left) * (3 - x) / 6)
        row = high * (bottom + (top - bottom) * z / 6)
        around = np.s_[int(row) - 3 : int(row) + 4, int(column) - 3 : int(column) + 4]
        assert np.any(drawn[around] != 255)  # the line
        beside = np.s_[int(row) - 11 : int(row) + 12, int(column) - 11 : int(column) + 12]
        ys, xs = np.nonzero((ringed[beside] != drawn[beside]).any(axis=-1))
        assert (ys.mean(), xs.mean()) == pytest.approx((11, 11), abs=1.5)


def test_other_controls_stand_beside_the_handles():
    experiment = bent(scale=(0.5, 1.5))
    before = pixels(experiment.png)
    assert np.any(pixels(experiment.set(scale=0.5).png) != before)
    assert experiment.controls["scale"] in experiment.box.children
    assert recording.record(experiment)["name"] == "scale"
    assert recording.record(bent()) is None


def test_a_test_drives_the_handles_to_places_that_a_reader_may_reach(monkeypatch):
    monkeypatch.setenv("MOCAP_SWEEP", "1")
    experiment = bent()
    ways = [values["way"] for values in driving.settings(experiment)]
    assert ((0.0, 3.0), (0.0, 3.0), (0.0, 5.0)) in ways
    assert ((0.0, 1.0), (0.0, 3.0), (-3.0, 6.0)) in ways
    for way in ways:
        experiment.set(way=way)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ([[0, 1], [0, 3]], r"There are 3 handles, got an array of shape \(2, 2\)"),
        ([[0, 1], [3.5, 3], [0, 5]], r"Handle 2 would leave the axes: \[3.5, 3.0\]"),
        ([[0, 1], [0, 3], [0, np.nan]], "Handle 3 would leave the axes"),
    ],
)
def test_places_outside_the_axes_are_refused(value, said):
    experiment = bent()
    refused(said, experiment.set, way=value)
    assert experiment.values()["way"] == ((0, 1), (0, 3), (0, 5))


def test_other_nonsense_is_refused():
    refused("rows of two numbers", handles, ground(), [1, 2, 3])
    refused("linear axes, not linear and log", handles, plt.figure().add_subplot(yscale="log"), POINTS)
    with pytest.raises(MocapError, match="one control of handles"):
        experiments.explore(
            lambda a, b: None, alt="", a=handles(ground(), POINTS), b=handles(ground(), POINTS)
        )
