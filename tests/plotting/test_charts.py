"""What the charts show, read back from their artists."""

import numpy as np
import pytest

from mocap.feet.footprints import find_footprints
from mocap.matching.distance_grids import distance_grid
from mocap.plotting import charts
from tests.strategies import wave


def test_the_distance_image_shows_centimetres_in_seconds():
    grid = distance_grid(wave(40), wave(60, phase=1.0), window=10)
    image = charts.distance_image(grid, fps=30, minima=[[3, 5]], names=("a", "b"))
    assert np.asarray(image.get_array()) == pytest.approx(100 * np.sqrt(grid))
    assert image.get_extent() == pytest.approx([0, 51 / 30, 31 / 30, 0])
    (dots,) = image.axes.lines
    assert np.ravel(dots.get_data()) == pytest.approx([5.5 / 30, 3.5 / 30])
    assert image.axes.get_ylabel() == "a (s)"


def test_a_path_from_above_is_not_mirrored():
    motion = wave(30)
    path, start, seams = charts.path_from_above(motion, seams=[4, 9])
    assert np.transpose(path.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert np.transpose(seams.get_data()) == pytest.approx(motion.root_positions[[4, 9]][:, [0, 2]])
    assert path.axes.xaxis_inverted()
    charts.path_from_above(motion, ax=path.axes)
    assert path.axes.xaxis_inverted()
    assert start.get_xdata() == pytest.approx(motion.root_positions[0, 0])


def test_footprints_stand_where_feet_did():
    motion = wave(80)
    prints = find_footprints(motion)
    drawn = charts.footprints(prints)
    assert drawn.get_offsets().tolist() == [[step.x, step.z] for step in prints]
    assert drawn.axes.xaxis_inverted()


def test_the_path_asked_for_lies_under_the_path_walked():
    motion = wave(30)
    asked, walked, start = charts.asked_and_walked([[0, 0], [0, 1], [1, 1]], motion)
    assert np.transpose(asked.get_data()).tolist() == [[0, 0], [0, 1], [1, 1]]
    assert np.transpose(walked.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert asked.get_zorder() <= walked.get_zorder()
    assert (asked.get_color(), walked.get_color()) == ("#000000", "#E69F00")
    assert start.get_ydata() == pytest.approx(motion.root_positions[0, 2])


def test_a_joints_curve_is_in_seconds_with_its_seams_shaded():
    values = np.arange(20.0).reshape(10, 2)
    curves = charts.joint_curve(values, fps=10, seams=[[2, 5], [7, 9]], labels=["x (m)", "y (m)"])
    assert [curve.get_ydata().tolist() for curve in curves] == values.T.tolist()
    assert curves[0].get_xdata() == pytest.approx(np.arange(10) / 10)
    spans = [
        patch.get_extents().transformed(patch.axes.transData.inverted()) for patch in curves[0].axes.patches
    ]
    assert np.ravel([span.intervalx for span in spans]) == pytest.approx([0.2, 0.5, 0.7, 0.9])
    (single,) = charts.joint_curve(values[:, 0], fps=10, labels=["height (m)"])
    assert single.axes.get_ylabel() == "height (m)"
