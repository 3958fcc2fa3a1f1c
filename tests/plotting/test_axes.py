"""3D axes: the ground keeps to the world, nothing is mirrored or cut off."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpl_toolkits.mplot3d import proj3d

from mocap.body.kinematics import joint_positions
from mocap.plotting import axes
from mocap.plotting.axes import to_picture
from tests.strategies import random_motion, seeds


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
    ax = axes.ground_axes((0.3, 7.1), 1.0)
    axes.look_at(ax, np.array([0.4, 6.8]), 1.0)
    lines = np.asarray(ax.collections[0]._segments3d)
    assert np.all(lines[..., 2] == 0)
    constant = np.where(np.ptp(lines[..., 0], axis=1) == 0, lines[:, 0, 0], lines[:, 0, 1])
    assert constant * 2 == pytest.approx(np.round(constant * 2))
    assert constant.tolist() == [-0.5, 0.0, 0.5, 1.0, 6.0, 6.5, 7.0, 7.5]


@given(seeds, st.floats(0.2, 30), st.floats(-1000, 1000))
@settings(max_examples=15)
def test_poses_are_never_cut_off(seed, size, away):
    motion = random_motion(seed)
    motion = replace(motion, root_positions=np.abs(motion.root_positions) * size + [away, 0, -away])
    points = joint_positions(motion)[[0, 2, 4]]
    seen = on_picture(axes.ground_around(points), points)
    assert seen.min() >= 0
    assert seen.max() <= 1


def test_nothing_zooms_in_on_points_that_are_inside_already():
    ax = axes.ground_axes()
    before = on_picture(ax, np.eye(3))
    axes.keep_inside(ax, np.array([[0.0, 0.9, 0.0]]))
    assert on_picture(ax, np.eye(3)) == pytest.approx(before)
