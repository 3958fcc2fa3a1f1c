"""Paths through grids against a slow recursion, another implementation, and a way that looks right."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.matching.time_paths import origins, path_mean, path_sums, time_path, trace
from tests.oracles import least_sum, longest_run, path_sum
from tests.refusals import refusals, refused
from tests.strategies import seeds

slopes = st.integers(1, 3)
sides = st.integers(2, 11)


def random_grid(seed, rows, columns):
    return np.random.default_rng(seed).random((rows, columns))


@given(seeds, sides, sides, slopes)
def test_no_path_has_a_lower_sum(seed, rows, columns, slope):
    """As in [KG03, time path]."""
    grid = random_grid(seed, rows, columns)
    best = least_sum(grid, slope)
    if not np.isfinite(best):
        refused(f"at most {slope + 1} to 1", time_path, grid, slope=slope)
        return
    path = time_path(grid, slope=slope)
    assert path_sum(grid, path) == pytest.approx(best, abs=1e-14)
    assert path[0].tolist() == [0, 0] and path[-1].tolist() == [rows - 1, columns - 1]
    assert set(map(tuple, np.diff(path, axis=0).tolist())) <= {(1, 1), (1, 0), (0, 1)}
    assert longest_run(path) <= slope


@given(seeds, st.integers(4, 8), st.integers(4, 8), slopes)
def test_free_ends_give_the_least_mean_of_all_ends(seed, rows, columns, slope):
    """As in [KG03, time path]."""
    grid, slack = random_grid(seed, rows, columns), 2
    begins = [(i, 0) for i in range(slack + 1)] + [(0, j) for j in range(1, slack + 1)]
    means = []
    for begin in begins:
        for end in [(rows - 1 - i, columns - 1 - j) for i, j in begins]:
            frames = end[0] - begin[0] + end[1] - begin[1] + 2
            means.append(least_sum(grid, slope, begin, end) / frames)
    if not np.isfinite(min(means)):
        return
    path = time_path(grid, slope=slope, slack=slack)
    assert path_mean(grid, path) == pytest.approx(min(means), abs=1e-12)
    assert longest_run(path) <= slope


@given(seeds, st.integers(2, 7), st.integers(2, 7), slopes)
def test_begun_anywhere_the_sums_are_those_of_a_local_alignment(seed, rows, columns, slope):
    costs = random_grid(seed, rows, columns) - 0.5
    sums = path_sums(costs, np.ones(costs.shape, bool), slope=slope)
    begins = origins(sums)
    for end in np.ndindex(rows, columns):
        best = min(least_sum(costs, slope, begin, end) for begin in np.ndindex(end[0] + 1, end[1] + 1))
        path = trace(sums, end)
        assert path_sum(costs, path) == pytest.approx(sums.totals[end], abs=1e-12)
        assert sums.totals[end] == pytest.approx(best, abs=1e-12)
        assert divmod(begins[end], columns) == tuple(path[0])
        assert longest_run(path) <= slope


def test_slope_1_lays_eight_frames_on_four():
    assert len(time_path(np.ones((8, 4)), slope=1)) == 8


test_what_has_no_path_is_refused = refusals(
    (r"of two dimensions, got \(0, 4\)", time_path, np.ones((0, 4))),
    ("a grid of finite numbers", time_path, [[1.0, np.nan], [1.0, 1.0]]),
    ("9 frames cannot be laid on 4 with .* 1: at most 2 to 1", lambda: time_path(np.ones((9, 4)), slope=1)),
    ("from 1 to 63 and slack .* got 0 and 0", lambda: time_path(np.ones((4, 4)), slope=0)),
    ("less than the 4 frames of a clip, got 2 and -1", lambda: time_path(np.ones((4, 4)), slack=-1)),
    ("less than the 4 frames of a clip, got 2 and 4", lambda: time_path(np.ones((9, 4)), slack=4)),
)
