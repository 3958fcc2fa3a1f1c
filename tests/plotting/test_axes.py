"""The ground and the bodies on it: nothing is cut off, nothing is twice."""

import matplotlib

matplotlib.use("agg")

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpl_toolkits.mplot3d import proj3d

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.plotting.axes import to_picture
from mocap.plotting.stick_figures import bones, film_strip, stick_figure
from tests.strategies import random_motion, seeds, wave


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    plt.close("all")


def on_picture(ax, points):
    """Give where points of the world are on the axes, from 0 to 1 each way."""
    ax.figure.draw_without_rendering()
    x, y, _ = proj3d.proj_transform(*to_picture(points).reshape(-1, 3).T, ax.get_proj())
    return ax.transAxes.inverted().transform(ax.transData.transform(np.stack([x, y], -1)))


@given(seeds, st.floats(0.2, 30), st.floats(-1000, 1000))
@settings(max_examples=15)
def test_poses_are_never_cut_off(seed, size, away):
    motion = random_motion(seed)
    motion = replace(motion, root_positions=np.abs(motion.root_positions) * size + [away, 0, -away])
    figures = stick_figure(motion, [0, 2, 4])
    seen = on_picture(figures[0].dot.axes, joint_positions(motion)[[0, 2, 4]])
    plt.close("all")
    assert seen.min() >= 0
    assert seen.max() <= 1


def test_a_strip_shows_first_and_last_pose_and_all_who_play():
    first, second = wave(50, name="a"), wave(20, name="b", phase=2)
    strip = film_strip([first, second], count=4)
    assert len(strip.axes) == 4
    assert [ax.get_title() for ax in strip.axes][::3] == ["0.00 s", "1.63 s"]
    for motion, frame in ((first, 49), (second, 19)):
        seen = on_picture(strip.axes[-1], joint_positions(motion)[frame])
        assert 0 <= seen.min() <= seen.max() <= 1
    assert plt.get_fignums() == []


def test_a_strip_of_one_frame_is_one_picture():
    assert len(film_strip([wave(1)]).axes) == 1


def test_bones_have_a_line_each_and_know_their_side():
    body = Skeleton(["hips", "lleg", "rleg", "lfoot"], [-1, 0, 0, 1], np.arange(12).reshape(4, 3))
    starts, ends, sides = bones(body)
    assert list(zip(starts, ends, sides, strict=True)) == [(0, 1, "middle"), (0, 2, "middle"), (1, 3, "left")]
