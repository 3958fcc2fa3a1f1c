"""Bodies, flat, on 3D axes and along a path: every bone where the joints are, nothing cut off."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_hex, to_rgba
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import proj3d

from mocap.body.kinematics import joint_positions
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.plotting import bones, flat_bodies, stick_figures
from mocap.plotting.bodies import ASLANT, film_strip
from mocap.plotting.bodies_on_path import APART, HIGH, LOW, MOST, WIDTH, bodies_along
from mocap.plotting.stick_figures import to_picture
from mocap.plotting.style import ASKED, COLOURS, MARK, PATH, SOURCES
from tests.strategies import random_motion, seeds, wave


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
    plt.close(ax.figure)
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


def bodies(figure):
    """Return the colours of each body; the first collection is the ground."""
    _, *found = [part for part in figure.axes[0].collections if isinstance(part, LineCollection)]
    return [{to_hex(colour).upper() for colour in part.get_colors()} for part in found]


def lines(figure):
    return {line.get_label(): line for line in figure.axes[0].get_lines() if line.get_label()[0] != "_"}


def test_bodies_are_spread_over_the_ground_in_the_colours_of_their_sides():
    figure = bodies_along(wave(100))  # 2 cm per frame: 1.98 m
    assert len(bodies(figure)) == 1 + int(1.98 / APART)
    assert set().union(*bodies(figure)) <= set(COLOURS.values())
    assert to_hex(lines(figure)["walked path"].get_color()).upper() == PATH


def test_a_long_walk_has_a_bounded_number_of_bodies():
    assert APART * MOST < 0.02 * 2000
    assert MOST / 2 < len(bodies(bodies_along(wave(2000)))) <= MOST


def test_a_frame_beyond_the_horizon_gets_a_coarser_floor():
    """One frame out of range, as a lost marker gives it: squares of 1 m would take minutes and gigabytes."""
    walk = wave(50)
    roots = walk.root_positions.copy()
    roots[20] = [0, 1, 1e7]
    floor = bodies_along(replace(walk, root_positions=roots)).axes[0].collections[0]
    assert len(floor.get_segments()) < 2000


def test_clips_have_their_colours_and_seams_are_marked_where_they_are():
    motion = wave(200)
    figure = bodies_along(motion, sources=[(0, "a"), (100, "b"), (150, "a")], seams=[95, 145])
    drawn = lines(figure)
    assert list(drawn) == ["a", "b", "seam"]
    assert [to_hex(drawn[name].get_color()).upper() for name in ("a", "b", "seam")] == [*SOURCES[:2], MARK]
    assert [next(iter(body)) for body in bodies(figure)] == [*[SOURCES[0]] * 3, *[SOURCES[1]] * 2, SOURCES[0]]
    metres = np.diff(drawn["seam"].get_xdata())  # the walk is straight, so it runs across the picture
    assert metres == pytest.approx(0.02 * 50, abs=0.02)


def test_several_characters_have_a_colour_each_and_the_asked_path_is_black():
    figure = bodies_along(wave(100, name="a"), wave(100, phase=1, name="b"), path=[(0, 0), (1, 2)])
    assert list(lines(figure)) == ["asked path", "a", "b"]
    assert to_hex(lines(figure)["asked path"].get_color()) == ASKED
    assert set().union(*bodies(figure)) == set(SOURCES[:2])


def test_many_characters_are_seen_as_a_group_at_the_same_three_moments():
    figure = bodies_along(*(wave(400, phase=phase, name="walk") for phase in range(6)))
    assert len(bodies(figure)) == 6 * 3
    assert figure.legends == []  # one name for six colours would mislead


@pytest.mark.parametrize("frames", [1, 2, 60, 3000])
def test_the_picture_fits_what_it_shows(frames):
    figure = bodies_along(wave(frames))
    wide, high = figure.get_size_inches()
    assert wide == WIDTH
    assert LOW <= high <= HIGH
    figure.canvas.draw()
    inside = figure.axes[0].get_window_extent().bounds
    assert inside[3] > 0.6 * high * figure.dpi or inside[2] > 0.9 * wide * figure.dpi


def test_obstacles_lie_on_the_ground():
    (outline,) = [
        part.get_paths()
        for part in bodies_along(wave(30), discs=[[0, 1, 0.5]]).axes[0].collections
        if isinstance(part, PolyCollection)
    ]
    assert len(outline) == 1 and np.ptp(outline[0].vertices, axis=0).max() == pytest.approx(1.0, abs=0.01)
