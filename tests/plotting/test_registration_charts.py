"""Pictures of registered clips show the numbers that they are given."""

import numpy as np
import pytest

from mocap.blending import Curve, Warp, mix, plants_on_clock, register
from mocap.matching import distance_grid, point_cloud, time_path
from mocap.plotting.registration_charts import ground_tracks, plant_bars, warp_image
from mocap.plotting.style import COLOURS, SOURCES
from tests.blending.registered import HALF, walks


@pytest.fixture(scope="module")
def pair():
    return register([walks()[0.8, 0], walks()[1.4, 0]])


def test_the_curve_lies_on_the_cells_of_the_path(pair):
    points = [point_cloud(clip[::4]) for clip in pair.clips]
    grid = np.sqrt(distance_grid(*points, window=5))
    path = time_path(grid, slack=36)
    drawn = warp_image(grid, path, curve=pair.times[1])
    own, u = drawn.cells.get_data()
    assert (own[0], u[0]) == pytest.approx((path[0, ::-1] + 2) / 30)
    x, y = drawn.curve.get_data()
    assert np.abs(np.interp(u, y, x) - own).max() < 0.2
    left, right, bottom, top = drawn.grid.get_extent()
    assert (left, top) == pytest.approx((1.5 / 30, 1.5 / 30))
    assert (right, bottom) == pytest.approx(((grid.shape[1] + 1.5) / 30, (grid.shape[0] + 1.5) / 30))
    assert drawn.grid.get_array().max() == pytest.approx(100 * grid.max())


def test_a_grid_may_stand_without_path_or_curve():
    drawn = warp_image(np.ones((3, 4)), [], warp=Warp(rate=10.0, window=1))
    assert not len(drawn.cells.get_xdata()) and not len(drawn.curve.get_xdata())
    line = Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
    assert not len(warp_image(np.ones((3, 4)), [], curve=line).curve.get_xdata())


def test_bars_start_and_stop_with_the_plants(pair):
    rows = {}
    for name, clip, curve in zip(("slow", "brisk"), pair.clips, pair.times, strict=True):
        plants = plants_on_clock(clip, curve)
        rows[name] = {"left": plants["lfoot"], "right": plants["rfoot"]}
    bars = plant_bars(rows)
    for row, (name, sides) in enumerate(rows.items()):
        corners = np.array([path.vertices[:4] for path in bars[name].get_paths()])
        count = len(sides["left"])
        assert corners[:count, 0, 0] == pytest.approx(sides["left"][:, 0])
        assert corners[count:, 1, 0] == pytest.approx(sides["right"][:, 1])
        assert corners[:count, :, 1].max() == pytest.approx(row) == corners[count:, :, 1].min()
    axes = bars["slow"].axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["slow", "brisk"]
    assert axes.yaxis_inverted()
    assert len({tuple(colour) for colour in bars["slow"].get_facecolors()}) == 2 <= len(COLOURS)


def test_tracks_have_the_ways_and_the_facings(pair):
    blend = mix(pair, HALF)
    lines = ground_tracks([*pair.parts, blend])
    assert [line.get_color() for line in lines] == list(SOURCES[:3])
    assert lines[2].get_xdata() == pytest.approx(blend.root_positions[:, 0])
    ahead = np.diff(lines[2].axes.collections[-1].get_segments(), axis=1)[:, 0]
    assert np.hypot(*ahead.T) == pytest.approx(0.25)
    assert np.abs(np.degrees(np.arctan2(*ahead.T))).max() < 30
