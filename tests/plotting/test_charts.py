"""What the pictures show, read back from their artists."""

import matplotlib

matplotlib.use("agg")

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.feet.footprints import find_footprints
from mocap.matching.distance_grids import distance_grid
from mocap.plotting import axes, charts, stick_figures
from mocap.plotting.axes import to_picture
from tests.strategies import wave


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    plt.close("all")


def test_world_axes_are_not_mirrored():
    x, y, z = to_picture(np.eye(3))
    assert np.cross(x, y) == pytest.approx(z)
    assert y.tolist() == [0, 0, 1]  # up is up


def test_a_stick_figure_has_every_bone_where_the_joints_are():
    motion = wave(30)
    (figure,) = stick_figures.stick_figure(motion, 12)
    (root, elbow, hand, side) = to_picture(joint_positions(motion)[12])
    drawn = np.concatenate([part._segments3d for part in figure.bones.values()])
    expected = {tuple(np.round([*a, *b], 9)) for a, b in ((root, elbow), (elbow, hand), (root, side))}
    assert {tuple(np.round(segment.ravel(), 9)) for segment in np.asarray(drawn)} == expected


def test_left_and_right_have_their_own_colours():
    names = ["hips", "lleg", "rleg", "lfoot", "rfoot", "head"]
    body = Skeleton(names, [-1, 0, 0, 1, 2, 0], [[0, 0, 0]] + [[x, -0.4, 0] for x in (0.1, -0.1, 0, 0.01, 0)])
    motion = replace(wave(5), skeleton=body, rotations=np.tile([1.0, 0, 0, 0], (5, 6, 1)), contacts={})
    (figure,) = stick_figures.stick_figure(motion, 2)
    assert {side: len(part._segments3d) for side, part in figure.bones.items()} == {
        "left": 1,
        "right": 1,
        "middle": 3,
    }
    assert figure.dot.get_data_3d()[2] == pytest.approx(joint_positions(motion)[2, 5, 1])


def test_earlier_poses_are_ghosts():
    figures = stick_figures.stick_figure(wave(30), [0, 10, 20])
    alphas = [figure.bones["middle"].get_alpha() for figure in figures]
    assert alphas == sorted(alphas)
    assert alphas[-1] == 1


def test_the_ground_stays_where_it_is_in_the_world():
    ax = axes.ground_axes((0.3, 7.1), 1.0)
    lines = np.asarray(ax.collections[0]._segments3d)
    assert np.all(lines[..., 2] == 0)
    constant = np.where(np.ptp(lines[..., 0], axis=1) == 0, lines[:, 0, 0], lines[:, 0, 1])
    assert constant * 2 == pytest.approx(np.round(constant * 2))


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


def test_two_motions_laid_over_each_other_have_a_colour_each():
    first, second = wave(20, name="a"), wave(20, phase=1, name="b")
    figures = stick_figures.laid_over(first, second, every=5)
    for motion, drawn in zip((first, second), figures, strict=True):
        tips = [figure.bones["middle"]._segments3d[-1][-1] for figure in drawn]
        assert np.asarray(tips) == pytest.approx(to_picture(joint_positions(motion)[::5, 3]))
    colours = {tuple(figure.bones["middle"].get_color()[0]) for drawn in figures for figure in drawn}
    assert len(colours) == 2
    legend = figures[0][0].dot.axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["a", "b"]


def test_high_poses_are_seen_whole():
    tall = replace(wave(3), root_positions=wave(3).root_positions * 3)
    (figure,) = stick_figures.stick_figure(tall)
    assert figure.dot.axes.get_zlim()[1] >= joint_positions(tall)[0, :, 1].max()


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
