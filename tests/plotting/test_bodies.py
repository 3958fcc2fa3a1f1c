"""Bodies are inside their pictures, however large these are; test_drawn.py holds what is drawn."""

from dataclasses import replace

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpl_toolkits.mplot3d import proj3d

from mocap.body.kinematics import joint_positions
from mocap.plotting import node_link, stick_figures
from mocap.plotting.bodies_on_path import HIGH, LOW, WIDTH, bodies_along
from mocap.plotting.stick_figures import to_picture
from tests.refusals import refusals
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


def test_a_ground_may_be_too_small_for_its_lines():
    assert not len(stick_figures.ground_axes((0.2, 0.2), 0.1).collections[0]._segments3d)


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


@pytest.mark.parametrize("frames", [1, 2, 60, 3000])
def test_the_picture_fits_what_it_shows(frames):
    figure = bodies_along(wave(frames))
    wide, high = figure.get_size_inches()
    assert wide == WIDTH
    assert LOW <= high <= HIGH
    figure.canvas.draw()
    inside = figure.axes[0].get_window_extent().bounds
    assert inside[3] > 0.6 * high * figure.dpi or inside[2] > 0.9 * wide * figure.dpi


test_large_graphs_are_drawn_elsewhere = refusals(
    *(
        (
            r"1 to 100 nodes, this one has \d+: `plotting.timeline`",
            node_link,
            nx.empty_graph(nodes, nx.DiGraph),
        )
        for nodes in (0, 101)
    )
)
