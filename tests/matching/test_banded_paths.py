"""Time paths in a band are those of the whole grid, wherever the band is wide enough."""

from functools import cache
from itertools import combinations

import numpy as np
import pytest

from mocap.blending.tuned import TUNED
from mocap.body import resample
from mocap.datasets import SAMPLES, sample
from mocap.matching import distance_grid, path_mean, point_cloud, time_path
from mocap.matching.banded_paths import banded_path
from mocap.matching.time_bands import band_between, diagonal_band, whole_band, widened
from mocap.matching.time_paths import least_mean_path
from tests.blending.registered import captured

RATE = 30
SLACK = 36  # frames
TRIALS = [("02_05", "02_07"), ("02_05", "02_10"), ("16_15", "16_21")]


@cache
def points_of(name):
    return point_cloud(resample(sample(name), RATE))


def in_band(a, b, seconds, margin=TUNED.band_margin):
    half_width, margin = round(seconds * RATE), round(margin * RATE)
    return banded_path(a, b, window=5, slope=2, slack=SLACK, half_width=half_width, margin=margin)


def assert_as_in_the_whole_grid(a, b):
    found = in_band(a, b, TUNED.band)
    grid = np.sqrt(distance_grid(a, b, window=5))
    rows, columns = np.indices(grid.shape)
    inside = found.band.includes(rows, columns)
    assert np.array_equal(found.distances, grid[inside])
    path = time_path(grid, slack=SLACK)
    assert np.array_equal(found.path, path)
    assert found.mean == path_mean(grid, path)


@pytest.mark.parametrize(("first", "second"), [*combinations(SAMPLES, 2)])
def test_two_bundled_clips_have_the_path_of_the_whole_grid(first, second):
    a, b = points_of(first), points_of(second)
    if max(len(a), len(b)) < 3 * min(len(a), len(b)):  # what the slope allows
        assert_as_in_the_whole_grid(a, b)


@pytest.mark.parametrize(("first", "second"), TRIALS)
def test_two_captured_clips_have_the_path_of_the_whole_grid(real_data, first, second):
    assert_as_in_the_whole_grid(*(point_cloud(captured(real_data, name)[::4]) for name in (first, second)))


def test_a_band_widens_until_it_holds_the_path():
    # The second clip is 8 s behind the first from its middle on: a pause, then the rest three times as fast.
    wave = np.cumsum(np.random.default_rng(3).normal(size=(900, 4)), axis=0)
    late = wave[np.concatenate([np.arange(300), np.repeat(np.arange(300, 420), 3), np.arange(420, 900, 2)])]
    a, b = (np.stack([0 * points, points, 0 * points], axis=-1) for points in (wave, late))
    narrow = in_band(a, b, seconds=1.5, margin=0.5)
    assert not narrow.band.is_whole
    assert len(narrow.distances) < 0.8 * 896 * len(b)
    assert np.array_equal(narrow.path, in_band(a, b, seconds=60).path)


def test_the_limits_of_a_band_never_fall():
    half_widths = np.array([2, 2, 9, 2, 2, 2, 2, 1, 1, 1])
    band = diagonal_band(half_widths, 20)
    assert (np.diff(band.first) >= 0).all()
    assert (np.diff(band.stop) >= 0).all()
    rows = np.arange(10)
    assert band.includes(rows, np.linspace(0, 19, 10).astype(int)).all()


def test_a_path_that_stays_inside_widens_nothing():
    half_widths = np.full(50, 10)
    diagonal = np.stack([np.arange(50)] * 2, axis=1)
    assert widened(half_widths, diagonal_band(half_widths, 50), diagonal, margin=3) is None


def test_cells_of_a_band_have_their_places():
    band = band_between(np.array([0, 1, 1]), np.array([2, 4, 5]), 5)
    places = [band.place(cell) for cell in range(band.offsets[-1])]
    assert places == [(0, 0), (0, 1), (1, 1), (1, 2), (1, 3), (2, 1), (2, 2), (2, 3), (2, 4)]
    assert band.cells(*np.array(places).T).tolist() == list(range(9))


def test_a_path_in_a_whole_band_is_that_of_the_grid():
    grid = np.random.default_rng(0).random((30, 40))
    band = whole_band(*grid.shape)
    assert np.array_equal(least_mean_path(grid.ravel(), band, 2, 5), time_path(grid, slack=5))


def test_distances_between_cells_are_interpolated_and_outside_the_band_they_are_huge():
    a = points_of("walk_circle")
    found = in_band(a, points_of("sneak"), TUNED.band)
    grid = np.sqrt(distance_grid(a, points_of("sneak"), window=5))
    assert found.interpolated(200.5, 100.25) == pytest.approx(
        grid[200:202, 100] @ [0.375, 0.375] + grid[200:202, 101] @ [0.125, 0.125]
    )
    assert found.interpolated(-3, -3) == grid[0, 0]
    assert found.interpolated(1300, 5) > 1e9
