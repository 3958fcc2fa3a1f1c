"""What charts and grids show, and what lies on the ground, read back from their artists."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle

from mocap.blending import Curve
from mocap.datasets import sample
from mocap.matching import distance_grid
from mocap.methods.match_webs.match_search import Match
from mocap.plotting import (
    distance_image,
    draw_group_plan,
    ground_tracks,
    joint_curve,
    match_tree,
    path_from_above,
    quartile_band,
    seen_beside_measured,
    walk_rows,
    warp_image,
)
from mocap.plotting.style import ASTRAY, SOURCES
from tests.strategies import wave

AT = np.arange(3.0)
FOUND = [
    Match(0, 0, 9, 0.0, -1, 0, AT, AT),
    Match(1, 0, 9, 0.01, 0, 1, AT, AT),
    Match(1, 20, 29, 0.02, 0, 1, AT, AT),
    Match(2, 0, 9, 0.01, 2, 2, AT, AT),
    Match(2, 30, 39, 0.01, 1, 2, AT, AT),
]


def colours_of(dots):
    return [tuple(colour) for colour in dots.get_facecolors()]


def test_a_joints_curve_is_in_seconds():
    values = np.arange(20.0).reshape(10, 2)
    curves = joint_curve(values, fps=10, labels=["x (m)", "y (m)"])
    assert [curve.get_ydata().tolist() for curve in curves] == values.T.tolist()
    assert curves[0].get_xdata() == pytest.approx(np.arange(10) / 10)
    (single,) = joint_curve(values[:, 0], fps=10, labels=["height (m)"])
    assert single.axes.get_ylabel() == "height (m)"


def test_a_band_reaches_from_quartile_to_quartile_about_the_median():
    samples = np.random.default_rng(0).gamma(2.0, size=(5, 41))
    median = quartile_band(range(5), samples, label="slide", colour="#112233")
    assert median.get_ydata() == pytest.approx(np.median(samples, axis=1))
    assert (median.get_label(), median.get_color()) == ("slide", "#112233")
    corners = median.axes.collections[0].get_paths()[0].vertices
    for x, row in enumerate(samples):
        heights = corners[corners[:, 0] == x, 1]
        assert (heights.min(), heights.max()) == pytest.approx(tuple(np.percentile(row, [25, 75])))
    assert quartile_band([0, 1], np.ones((2, 3)), ax=median.axes).axes is median.axes


def test_what_is_seen_stands_above_what_is_measured():
    points = [[10, 0.9, 0.0, 1.9], [20, -0.2, -1.1, 0.8], [30, 2.8, 1.4, np.inf]]
    upper, lower = seen_beside_measured(points, [10, 20], [[3, 4], [1, 2]], ("window (frames)", "jolt (m/s)"))
    guessing, curve = upper.lines
    assert not np.any(guessing.get_ydata())
    assert curve.get_ydata().tolist() == [0.9, -0.2, 2.8]
    ends = [segment[:, 1].tolist() for segment in upper.collections[0].get_segments()]
    assert ends == [[0.0, 1.9], [-1.1, 0.8], [1.4, 9.0]]  # without an upper limit the line leaves the picture
    assert upper.get_ylim()[1] < 9
    assert (lower.get_xlabel(), lower.get_ylabel()) == ("window (frames)", "measured: jolt (m/s)")
    assert lower.lines[0].get_ydata().tolist() == [3.5, 1.5]


def test_each_match_stands_at_its_step_linked_with_what_found_it():
    ax = match_tree(
        FOUND, ["walk", "walk", "run", "run", "walk"], wrong=[False] * 3 + [True, False], order=[]
    )
    links, matches, wrong = ax.collections
    places = np.asarray(matches.get_offsets())
    assert places[:, 0].tolist() == [0, 1, 1, 2, 2]
    assert places[3, 1] > places[4, 1]  # no two links cross
    assert len({tuple(place) for place in places.tolist()}) == len(FOUND)
    assert links.get_segments()[2].tolist() == places[[2, 3]].tolist()
    assert np.asarray(wrong.get_offsets()).tolist() == [places[3].tolist()]
    assert tuple(wrong.get_edgecolor()[0]) == to_rgba(ASTRAY)
    assert [colours_of(matches)[n] for n in (0, 2)] == [to_rgba(c) for c in SOURCES[:2]]


def test_a_kind_keeps_its_colour_and_a_query_alone_is_a_tree():
    few = match_tree(FOUND[:2], ["run", "run"], wrong=[False] * 2, order=["walk", "run"]).collections[1]
    assert colours_of(few)[0] == to_rgba(SOURCES[1])
    alone = match_tree(FOUND[:1], ["walk"], wrong=[False], order=[])
    assert len(alone.collections[0].get_segments()) == 0


def test_the_distance_image_shows_centimetres_in_seconds():
    grid = distance_grid(wave(40), wave(60, phase=1.0), window=10)
    image = distance_image(grid, fps=30, minima=[[3, 5]], names=("a", "b"))
    assert np.asarray(image.get_array()) == pytest.approx(100 * np.sqrt(grid))
    assert image.get_extent() == pytest.approx([0, 51 / 30, 31 / 30, 0])
    (dots,) = image.axes.lines
    assert np.ravel(dots.get_data()) == pytest.approx([5.5 / 30, 3.5 / 30])
    assert image.axes.get_ylabel() == "a (s)"


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


def test_a_path_from_above_is_not_mirrored():
    motion = wave(30)
    path, start = path_from_above(motion)
    assert np.transpose(path.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert path.axes.xaxis_inverted()
    path_from_above(motion, ax=path.axes)
    assert path.axes.xaxis_inverted()
    assert start.get_xdata() == pytest.approx(motion.root_positions[0, 0])


def test_tracks_have_the_ways_and_the_facings():
    lines = ground_tracks([wave(90), walk := sample("walk_straight")[:240]])
    assert [line.get_color() for line in lines] == list(SOURCES[:2])
    assert lines[1].get_xdata() == pytest.approx(walk.root_positions[:, 0])
    ahead = np.diff(lines[1].axes.collections[-1].get_segments(), axis=1)[:, 0]
    assert np.hypot(*ahead.T) == pytest.approx(0.25)
    assert np.abs(np.degrees(np.arctan2(*ahead.T))).max() < 30


def test_a_plan_shows_every_member_every_point_and_every_obstacle():
    places = np.linspace(0, 6, 50)[:, None] + np.array([0j, 1.5j, -1.5j])
    figure = draw_group_plan(places, [6 + 0j, 9 + 1j], [(3 + 4j, 0.5)], near=0.8)
    (ax,) = figure.axes
    for line, way in zip(ax.lines, places.T, strict=True):
        np.testing.assert_allclose(line.get_xydata(), np.stack([way.imag, way.real], axis=1))
    assert sorted(p.radius for p in ax.patches if isinstance(p, Circle)) == [0.5, 0.8, 0.8]
    assert [text.get_text() for text in ax.texts] == ["1", "2"] and ax.xaxis_inverted()
    assert draw_group_plan(np.ones((5, 1), complex), ax=ax) is figure
    assert len(ax.lines) == 4 and ax.xaxis_inverted()
