"""Bodies as lines: every bone is drawn, where the joints are."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.plotting import stick_figures
from mocap.plotting.axes import to_picture
from mocap.plotting.stick_figures import film_strip
from tests.plotting.test_axes import on_picture
from tests.strategies import wave


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
    seen = on_picture(figure.dot.axes, joint_positions(tall)[0])
    assert 0 <= seen.min() <= seen.max() <= 1


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
