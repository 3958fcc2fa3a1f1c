"""Grids show the numbers that they are given, in seconds, with what is marked in the middles of its cells."""

import numpy as np
import pytest

from mocap.blending import Curve
from mocap.matching import distance_grid
from mocap.methods.match_webs import minima_1d
from mocap.plotting import distance_image, walk_rows, warp_image, web_image
from tests.strategies import wave


def test_the_distance_image_shows_centimetres_in_seconds():
    grid = distance_grid(wave(40), wave(60, phase=1.0), window=10)
    image = distance_image(grid, fps=30, minima=[[3, 5]], names=("a", "b"))
    assert np.asarray(image.get_array()) == pytest.approx(100 * np.sqrt(grid))
    assert image.get_extent() == pytest.approx([0, 51 / 30, 31 / 30, 0])
    (dots,) = image.axes.lines
    assert np.ravel(dots.get_data()) == pytest.approx([5.5 / 30, 3.5 / 30])
    assert image.axes.get_ylabel() == "a (s)"


def test_paths_and_minima_lie_on_the_middles_of_their_cells():
    grid = np.abs(np.subtract.outer(np.arange(6.0), np.arange(8.0))) / 100
    path = np.stack([np.arange(6), np.arange(6)], axis=1)
    ax = web_image(grid, marks=minima_1d(grid), paths=[path])
    assert ax.collections[0].get_segments()[0] == pytest.approx((path + 0.5) / 30)
    marked = np.round(ax.lines[0].get_xydata() * 30 - 0.5).astype(int).tolist()
    assert all([n, n] in marked for n in range(6))
    assert ax.images[0].get_array().max() == pytest.approx(7)
    assert not len(web_image(grid).lines[0].get_xydata())


def test_the_curve_lies_on_the_cells_of_the_path():
    grid, path = np.random.default_rng(0).random((40, 50)), np.repeat(np.arange(40)[:, None], 2, axis=1)
    ax = warp_image(grid, path, curve=Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5])))  # S(u) = u
    own, u = ax.lines[0].get_data()
    assert (own[0], u[0]) == pytest.approx((path[0, ::-1] + 2) / 30)
    x, y = ax.lines[1].get_data()
    assert np.abs(np.interp(u, y, x) - own).max() < 0.02
    left, right, bottom, top = ax.images[0].get_extent()
    assert (left, top) == pytest.approx((1.5 / 30, 1.5 / 30))
    assert (right, bottom) == pytest.approx(((grid.shape[1] + 1.5) / 30, (grid.shape[0] + 1.5) / 30))
    assert ax.images[0].get_array().max() == pytest.approx(100 * grid.max())


def test_rows_show_transitions_by_cost_and_nothing_after_the_end():
    costs = np.array([[0.0, 150.0, np.nan], [300.0, 0.0, 0.0]])
    image = walk_rows(costs, highest=400.0)
    steps, transitions = image.axes.images
    assert steps.get_array().mask.tolist() == np.isnan(costs).tolist()
    assert transitions is image
    assert image.get_array().compressed().tolist() == [150.0, 300.0]
    assert image.get_clim() == (0, 400.0)
    assert image.axes.get_xlabel() == "step of the walk"
