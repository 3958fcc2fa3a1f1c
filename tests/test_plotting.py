"""What the pictures show, read back from their artists."""

import matplotlib

matplotlib.use("agg")

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from PIL import Image

from mocap import plotting
from mocap.errors import MocapError
from mocap.kinematics import joint_positions
from mocap.matching import distance_grid
from mocap.motion_graph import build
from mocap.skeleton import Skeleton
from tests.strategies import wave


@pytest.fixture(autouse=True)
def no_figure_stays_open():
    yield
    plt.close("all")


def test_world_axes_are_not_mirrored():
    x, y, z = plotting._picture(np.eye(3))
    assert np.cross(x, y) == pytest.approx(z)
    assert y.tolist() == [0, 0, 1]  # up is up


def test_a_stick_figure_has_every_bone_where_the_joints_are():
    motion = wave(30)
    (figure,) = plotting.stick_figure(motion, 12)
    (root, elbow, hand, side) = plotting._picture(joint_positions(motion)[12])
    drawn = np.concatenate([part._segments3d for part in figure.bones.values()])
    expected = {tuple(np.round([*a, *b], 9)) for a, b in ((root, elbow), (elbow, hand), (root, side))}
    assert {tuple(np.round(segment.ravel(), 9)) for segment in np.asarray(drawn)} == expected


def test_left_and_right_have_their_own_colours():
    names = ["hips", "lleg", "rleg", "lfoot", "rfoot", "head"]
    body = Skeleton(names, [-1, 0, 0, 1, 2, 0], [[0, 0, 0]] + [[x, -0.4, 0] for x in (0.1, -0.1, 0, 0.01, 0)])
    motion = replace(wave(5), skeleton=body, rotations=np.tile([1.0, 0, 0, 0], (5, 6, 1)), contacts={})
    (figure,) = plotting.stick_figure(motion, 2)
    assert {side: len(part._segments3d) for side, part in figure.bones.items()} == {
        "left": 1,
        "right": 1,
        "middle": 3,
    }
    assert figure.dot.get_data_3d()[2] == pytest.approx(joint_positions(motion)[2, 5, 1])


def test_earlier_poses_are_ghosts():
    figures = plotting.stick_figure(wave(30), [0, 10, 20])
    alphas = [figure.bones["middle"].get_alpha() for figure in figures]
    assert alphas == sorted(alphas)
    assert alphas[-1] == 1


def test_the_ground_stays_where_it_is_in_the_world():
    ax = plotting.stage((0.3, 7.1), 1.0)
    lines = np.asarray(ax.collections[0]._segments3d)
    assert np.all(lines[..., 2] == 0)
    constant = np.where(np.ptp(lines[..., 0], axis=1) == 0, lines[:, 0, 0], lines[:, 0, 1])
    assert constant * 2 == pytest.approx(np.round(constant * 2))


def test_the_distance_image_shows_centimetres_in_seconds():
    grid = distance_grid(wave(40), wave(60, phase=1.0), window=10)
    image = plotting.distance_image(grid, fps=30, minima=[[3, 5]], names=("a", "b"))
    assert np.asarray(image.get_array()) == pytest.approx(100 * np.sqrt(grid))
    assert image.get_extent() == pytest.approx([0, 51 / 30, 31 / 30, 0])
    (dots,) = image.axes.lines
    assert np.ravel(dots.get_data()) == pytest.approx([5.5 / 30, 3.5 / 30])
    assert image.axes.get_ylabel() == "a (s)"


def test_a_path_from_above_is_not_mirrored():
    motion = wave(30)
    path, start, seams = plotting.path_from_above(motion, seams=[4, 9])
    assert np.transpose(path.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert np.transpose(seams.get_data()) == pytest.approx(motion.root_positions[[4, 9]][:, [0, 2]])
    assert path.axes.xaxis_inverted()
    plotting.path_from_above(motion, ax=path.axes)
    assert path.axes.xaxis_inverted()
    assert start.get_xdata() == pytest.approx(motion.root_positions[0, 0])


def test_the_timeline_has_an_arc_a_transition():
    graph = build([wave(90, name="a"), wave(70, phase=1, name="b", seed=1)], window=8, threshold=0.05)
    arcs = plotting.timeline(graph)
    assert len(arcs.get_segments()) == graph.count("transition") > 0
    start, end, _ = next(edge for edge in graph.graph.edges(data="kind") if edge[2] == "transition")
    arc = arcs.get_segments()[0]
    assert arc[0] == pytest.approx([start[1] / 30, -start[0]])
    assert arc[-1] == pytest.approx([end[1] / 30, -end[0]])
    assert [label.get_text() for label in arcs.axes.get_yticklabels()] == ["a", "b"]


def test_an_animation_has_a_picture_every_time_step(tmp_path):
    motion = wave(31)  # one second
    path = plotting.save_animation(motion, tmp_path / "wave.gif", fps=20)
    with Image.open(path) as gif:
        assert gif.n_frames == 21
        assert gif.info["duration"] == 50
        first = np.asarray(gif.convert("RGB"))
        gif.seek(10)
        assert np.any(np.asarray(gif.convert("RGB")) != first)
    assert list(tmp_path.iterdir()) == [path]


def test_nothing_is_written_and_no_figure_left_when_drawing_is_interrupted(tmp_path):
    def interrupted(items):
        yield items[0]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plotting.save_animation(wave(30), tmp_path / "wave.gif", progress=interrupted)
    assert list(tmp_path.iterdir()) == []
    assert plt.get_fignums() == []


def test_only_gifs_are_written(tmp_path):
    with pytest.raises(MocapError, match=r"written as \.gif, got"):
        plotting.save_animation(wave(9), tmp_path / "wave.mov")
