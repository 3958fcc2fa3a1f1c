"""Handles on a picture, driven from Python."""

import base64
import io

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

from mocap.errors import MocapError
from mocap.widgets import experiments, recording
from mocap.widgets.pointing import handles
from tests.course import driving
from tests.refusals import refused

pytest.importorskip("anywidget")


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


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
