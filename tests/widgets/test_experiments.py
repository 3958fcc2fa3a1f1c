"""Experiments, driven as a reader would drive them, by handles too."""

import base64
import gc
import io
import tracemalloc

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from mocap.body.kinematics import joint_positions
from mocap.plotting.stick_figures import StickFigure, ground_axes
from mocap.widgets import explore, handles
from tests.refusals import refused
from tests.strategies import wave

pytest.importorskip("anywidget")


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def fresh(frame=0, ghost=False):
    """A new figure each time."""
    figure = Figure(figsize=(2, 2))
    figure.add_subplot().plot([0, 1], [0, frame], linestyle=":" if ghost else "-")
    return figure


def test_controls_are_made_as_interact_makes_them_and_change_the_picture():
    experiment = explore(fresh, alt="A line.", frame=(0, 9), ghost=True)
    assert experiment.values() == {"frame": 0, "ghost": True}
    assert [type(control).__name__ for control in experiment.controls.values()] == ["IntSlider", "Checkbox"]
    before = experiment.picture.value
    experiment.controls["frame"].value = 5
    assert experiment.error is None
    assert np.any(pixels(experiment.picture.value) != pixels(before))


def test_a_pose_drawn_over_the_kept_ground_is_the_pose_drawn_whole():
    motion = wave(30)
    points = joint_positions(motion)

    body = StickFigure(motion.skeleton, ground_axes((0, 0.3), 1.0))
    experiment = explore(lambda frame: body.pose(points[frame]), alt="A pose.", frame=(0, 29))
    experiment.set(frame=17)
    ax = ground_axes((0, 0.3), 1.0)
    StickFigure(motion.skeleton, ax).pose(points[17])
    whole = explore(lambda frame: ax.figure, alt="A pose.", frame=(0, 29))
    assert np.abs(pixels(experiment.png) - pixels(whole.png)).mean() < 0.1  # of 255


def test_what_changes_beside_the_moved_artists_is_drawn_too():
    ax = Figure(figsize=(2, 2)).add_subplot()
    (line,) = ax.plot([0, 1], [0, 1])

    def draw(number):
        ax.set_title(f"number {number}")
        return [line]

    experiment = explore(draw, alt="A title.", number=(0, 9))
    before = pixels(experiment.picture.value)
    assert np.any(pixels(experiment.set(number=8).picture.value)[:25] != before[:25])


def test_an_error_takes_the_pictures_place_and_goes_again():
    def draw(frame):
        if frame == 3:
            raise ValueError("three <is> too many")
        return fresh(frame)

    experiment = explore(draw, alt="A line.", frame=(0, 9))
    refused("three", experiment.set, frame=3, kind=ValueError)
    assert isinstance(experiment.error, ValueError)
    assert "ValueError: three &lt;is&gt; too many" in experiment.message.value
    assert "(draw, line" in experiment.message.value
    assert experiment.picture.layout.display == "none"
    experiment.controls["frame"].value = 4
    assert experiment.error is None
    assert experiment.message.layout.display == "none"
    assert experiment.picture.layout.display is None


@pytest.mark.parametrize("nothing", [None, [], [plt.Line2D([0], [0])]])
def test_a_function_that_returns_no_figure_is_refused(nothing):
    refused("must be given as a figure", explore, lambda n=1: nothing, alt="Nothing.", n=(0, 2))


def test_senseless_controls_are_refused():
    refused("takes no 'speed'; it takes: frame, ghost", explore, fresh, alt="A line.", speed=(0, 9))
    refused("is no range", explore, fresh, alt="A line.", frame=(9, 0))
    refused("is no range", explore, fresh, alt="A line.", frame=object())
    with pytest.raises(ZeroDivisionError):
        explore(lambda n: 1 / n, alt="Nothing.", n=(0, 1))


def test_drawings_leave_no_figure_and_no_memory_behind():
    def draw(frame):
        return plt.figure(figsize=(1, 1)) if frame % 2 else Figure(figsize=(1, 1))

    experiment = explore(draw, alt="Nothing.", frame=(0, 9))
    for frame in range(10):
        experiment.set(frame=frame)
    gc.collect()
    tracemalloc.start()
    before, _ = tracemalloc.get_traced_memory()
    for frame in range(60):
        experiment.set(frame=frame % 10)
    gc.collect()
    after, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert plt.get_fignums() == []
    assert after - before < 300_000  # one figure of 100 × 100 pixels takes more than a tenth of this


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

    return explore(bend, alt="A line through three handles.", way=handles(ax, POINTS), **more)


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
    two = {name: handles(ground(), POINTS) for name in "ab"}
    refused("one control of handles", explore, lambda a, b: None, alt="", **two)
