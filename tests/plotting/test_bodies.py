"""Bodies as lines on flat axes: every bone is drawn, where the joints are."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.plotting import bones, flat_bodies, target_poses
from mocap.plotting.bodies import ASLANT, film_strip
from mocap.plotting.style import COLOURS
from tests.strategies import wave


def test_bones_have_a_line_each_and_know_their_side():
    body = Skeleton(["hips", "lleg", "rleg", "lfoot"], [-1, 0, 0, 1], np.arange(12).reshape(4, 3))
    starts, ends, sides = bones(body)
    assert list(zip(starts, ends, sides, strict=True)) == [(0, 1, "middle"), (0, 2, "middle"), (1, 3, "left")]


def sides(walk):
    """Give where the left and the right hip of frame 90 are, seen along z."""
    points = joint_positions(walk)[90]
    return [points[walk.skeleton.index(name), :2] for name in ("lfemur", "rfemur")]


def test_bodies_are_drawn_flat_where_they_are_from_the_side_and_from_the_front():
    walk = sample("walk_straight")
    side, front = (flat_bodies(walk, [0, 90], view=v, ax=Figure().add_subplot()) for v in ("side", "front"))
    for ax, across in ((side, 2), (front, 0)):
        points = joint_positions(walk)[90][:, [across, 1]]
        drawn = np.concatenate(ax.collections[1].get_segments())
        np.testing.assert_allclose(drawn.max(axis=0), points.max(axis=0), atol=1e-12)
        assert {tuple(colour) for colour in ax.collections[0].get_colors()} == {
            to_rgba(colour) for colour in COLOURS.values()
        }
    assert side.get_xlabel() == "z (m)" and not side.xaxis_inverted()
    assert front.get_xlabel() == "x (m)" and not front.xaxis_inverted()
    left, right = (front.transData.transform(at)[0] for at in sides(walk))
    assert left > right  # of one who comes to the reader
    plt.close(flat_bodies(walk, [0]).figure)


def test_poses_stand_in_rows_with_their_targets_seen_from_behind():
    walk = sample("walk_straight")
    axes = target_poses([walk] * 3, [0, 60, 120], targets=[[0, 1], [0.1, 1], [0.2, 1]], columns=2)
    assert [ax.get_lines()[0].get_xydata()[0].tolist() for ax in axes[:3]] == [[0, 1], [0.1, 1], [0.2, 1]]
    assert all(len(ax.collections) == 1 for ax in axes[:3])
    assert axes[0].xaxis_inverted()  # so its left is at the left
    lines = axes[0].collections[0]
    left = np.array([tuple(colour) == to_rgba(COLOURS["left"]) for colour in lines.get_colors()])
    assert np.concatenate(np.array(lines.get_segments())[left])[:, 0].mean() > 0


def test_a_strip_shows_first_and_last_pose_and_all_who_play():
    first, second = wave(50, name="a"), wave(20, name="b", phase=2)
    strip = film_strip([first, second], count=4)
    assert [ax.get_title() for ax in strip.axes][::3] == ["0.00 s", "1.63 s"] and len(strip.axes) == 4
    strip.draw_without_rendering()
    for body, motion, frame in zip(strip.axes[-1].collections, (first, second), (49, 19), strict=True):
        drawn = np.concatenate(body.get_segments())
        assert len(drawn) == 2 * len(bones(motion.skeleton)[0])
        assert np.ptp(drawn[:, 1]) == pytest.approx(np.ptp((joint_positions(motion)[frame] @ ASLANT.T)[:, 1]))
        seen = strip.axes[-1].transAxes.inverted().transform(body.axes.transData.transform(drawn))
        assert 0 <= seen.min() <= seen.max() <= 1
    assert plt.get_fignums() == []
    assert len(film_strip([wave(1)]).axes) == 1
