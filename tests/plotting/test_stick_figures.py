"""Bodies on 3D axes: every bone where the joints are; the ground keeps to the world, nothing is cut off."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_rgba
from mpl_toolkits.mplot3d import proj3d

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.plotting import stick_figures
from mocap.plotting.stick_figures import to_picture
from mocap.plotting.style import COLOURS
from tests.strategies import random_motion, seeds, wave


def on_picture(ax, points):
    """Give where points of the world are on the axes, from 0 to 1 each way."""
    ax.figure.draw_without_rendering()
    x, y, _ = proj3d.proj_transform(*to_picture(points).reshape(-1, 3).T, ax.get_proj())
    return ax.transAxes.inverted().transform(ax.transData.transform(np.stack([x, y], -1)))


def test_world_axes_are_not_mirrored():
    x, y, z = to_picture(np.eye(3))
    assert np.cross(x, y) == pytest.approx(z)
    assert y.tolist() == [0, 0, 1]  # up is up


def test_the_ground_stays_where_it_is_in_the_world():
    ax = stick_figures.ground_axes((0.3, 7.1), 1.0)
    lines = np.asarray(ax.collections[0]._segments3d)
    assert np.all(lines[..., 2] == 0)
    constant = np.where(np.ptp(lines[..., 0], axis=1) == 0, lines[:, 0, 0], lines[:, 0, 1])
    assert constant.tolist() == [-0.5, 0.0, 0.5, 1.0, 6.5, 7.0, 7.5, 8.0]


@given(seeds, st.floats(0.2, 30), st.floats(-1000, 1000))
@settings(max_examples=15)
def test_poses_are_never_cut_off(seed, size, away):
    motion = random_motion(seed)
    motion = replace(motion, root_positions=np.abs(motion.root_positions) * size + [away, 0, -away])
    points = joint_positions(motion)[[0, 2, 4]]
    ax = stick_figures.ground_axes(points.mean(axis=(0, 1))[[0, 2]], size)
    stick_figures.keep_inside(ax, points)
    seen = on_picture(ax, points)
    assert 0 <= seen.min() <= seen.max() <= 1


def test_nothing_zooms_in_on_points_that_are_inside_already():
    ax = stick_figures.ground_axes()
    before = on_picture(ax, np.eye(3))
    stick_figures.keep_inside(ax, np.array([[0.0, 0.9, 0.0]]))
    assert on_picture(ax, np.eye(3)) == pytest.approx(before)


def test_a_stick_figure_has_every_bone_where_the_joints_are_in_the_colour_of_its_side():
    names = ["hips", "lleg", "rleg", "lfoot", "rfoot", "head"]
    body = Skeleton(names, [-1, 0, 0, 1, 2, 0], [[0, 0, 0]] + [[x, -0.4, 0] for x in (0.1, -0.1, 0, 0.01, 0)])
    motion = replace(wave(5), skeleton=body, rotations=np.tile([1.0, 0, 0, 0], (5, 6, 1)), contacts={})
    figure = stick_figures.StickFigure(body, stick_figures.ground_axes())
    figure.pose(joint_positions(motion)[2])
    at = to_picture(joint_positions(motion)[2])
    expected = {(*at[a], *at[b], s) for a, b, s in ((0, 1, "middle"), (0, 2, "middle"), (0, 5, "middle"))}
    expected |= {(*at[1], *at[3], "left"), (*at[2], *at[4], "right")}
    named = {to_rgba(colour): side for side, colour in COLOURS.items()}
    colours = map(tuple, figure.bones.get_color())
    drawn = zip(figure.bones._segments3d, colours, strict=True)
    assert {(*np.ravel(bone), named[colour]) for bone, colour in drawn} == expected
    assert figure.dot.get_data_3d()[2] == pytest.approx(joint_positions(motion)[2, 5, 1])
