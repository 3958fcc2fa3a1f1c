"""Experiments, driven as a reader would drive them."""

import gc
import io
import sys
import tracemalloc

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from mocap.body.kinematics import joint_positions
from mocap.plotting.stick_figures import StickFigure, ground_axes
from mocap.widgets import experiments
from mocap.widgets.experiments import explore
from tests.refusals import refused
from tests.strategies import wave

pytest.importorskip("ipywidgets")


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
    whole = experiments.BlittedFigure().png(ax.figure)
    assert np.abs(pixels(experiment.picture.value) - pixels(whole)).mean() < 0.1  # of 255


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


def test_without_ipywidgets_one_sentence_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    refused(r"pip install '\.\[notebooks\]'", explore, fresh, alt="A line.", frame=(0, 9))


def test_without_anywidget_an_experiment_has_no_names_but_works(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "mocap.widgets.shared_traits")
    experiment = explore(fresh, alt="A line.", frame=(0, 9))
    assert len(experiment.box.children) == 3
    assert experiment.set(frame=3).error is None


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
