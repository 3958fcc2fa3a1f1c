"""Images to click on, driven from Python."""

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
from mocap.widgets import experiments
from mocap.widgets.pointing import pointer
from tests.strategies import wave

pytest.importorskip("anywidget")

CLIPS = wave(40, name="a"), wave(50, phase=1, name="b")
GRID = distance_grids.distance_grid(*CLIPS, window=10)  # shape (31, 41)


def lay(at=(3, 20)):
    """Lay the windows over each other, as a notebook does."""
    (a, b), (i, j) = CLIPS, at
    return stick_figures.laid_over(a[i : i + 10], joining.lay_window_on(a, i, b, j, 10)[j : j + 10])


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


def test_it_says_the_cost(shown):
    at = shown.set(at=(12, 7)).controls["at"]
    assert at.status == f"row 12, column 7: RMS distance (cm) {100 * np.sqrt(GRID[12, 7]):.3g}"


@pytest.mark.parametrize("at", [(31, 0), (0, 41), (-1, 0), (1, 2, 3), (1.5, 2)])
def test_a_place_outside_the_image_is_refused(at, shown):
    before = shown.values()
    with pytest.raises(MocapError, match="Rows go from 0 to 30, columns to 40"):
        shown.set(at=at)
    assert shown.values() == before


def test_what_stays_is_both_pictures_in_one(shown):
    data, metadata = shown.still()
    assert set(data) == {"image/png", "text/html", "text/plain"}
    assert data["text/plain"] == metadata["image/png"]["alt"] == "Two windows."
    both, alone = pixels(base64.b64decode(data["image/png"])), pixels(shown.picture.value)
    assert both.shape[1] > alone.shape[1] + 400
    assert np.abs(both[: len(alone), -alone.shape[1] :] - alone).max() < 16  # in few colours
    assert len(data["image/png"]) < 90_000


@pytest.mark.parametrize("origin", ["upper", "lower"])
@pytest.mark.parametrize("value", [(0, 0), (2, 4)])
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
    with pytest.raises(MocapError, match="rows and columns of numbers"):
        pointer(plt.figure().add_subplot().imshow(np.zeros((4, 4, 3))))
