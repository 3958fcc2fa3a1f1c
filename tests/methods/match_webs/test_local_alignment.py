from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from mocap.matching import local_minima
from mocap.methods.match_webs import build_web, local_alignment, local_paths, minima_1d, search
from mocap.methods.match_webs.local_alignment import apart, pieces
from tests.oracles import least_sum, longest_run, path_sum


@given(st.integers(0, 10_000), st.integers(1, 3))
def test_the_first_path_has_the_lowest_sum_of_all(seed, slope):
    """As in [KG04, chains and bridges]."""
    costs = np.random.default_rng(seed).normal(0.4, 1, (6, 7))
    cells = list(np.ndindex(costs.shape))
    lowest = min(least_sum(costs, slope, a, b) for a in cells for b in cells if a[0] <= b[0] and a[1] <= b[1])
    paths = list(local_paths(costs, slope=slope, least=0))
    assert path_sum(costs, paths[0]) == pytest.approx(lowest)
    sums = [path_sum(costs, path) for path in paths]
    assert sums == sorted(sums) and sums[-1] < 0
    assert len({tuple(path[0]) for path in paths}) == len(paths)
    for path in paths:
        steps = np.diff(path, axis=0)
        assert np.isin(steps, (0, 1)).all() and steps.any(axis=1).all()
        assert longest_run(path) <= slope


def test_a_path_crosses_a_gap_that_it_has_earned_and_no_longer_one():
    """As in [KG04, chains and bridges]."""
    costs = np.full((30, 30), 1.0)
    valley = np.arange(30)
    costs[valley, valley] = -0.2
    costs[valley[10:13], valley[10:13]] = 0.3  # 3 cells cost what 4.5 of the valley earn
    assert len(next(local_paths(costs))) == 30
    costs[valley[10:13], valley[10:13]] = 2.0  # ... and now 30
    assert [len(path) for path in apart(local_paths(costs), near=1)] == [17, 10]


def test_short_paths_are_left_out():
    costs = np.full((8, 8), 1.0)
    costs[[0, 1, 2], [0, 1, 2]] = -1
    assert [len(path) for path in local_paths(costs, least=2)] == [3]
    assert not list(local_paths(costs, least=3))


def test_an_infinite_cell_is_never_crossed():
    costs = np.full((6, 6), -1.0)
    costs[3] = np.inf
    assert all(len(set(path[:, 0]) & {3}) == 0 for path in local_paths(costs))


@given(
    arrays(
        np.int64, array_shapes(min_dims=2, max_dims=2, max_side=8), elements={"min_value": 0, "max_value": 5}
    )
)
def test_minima_are_no_higher_than_both_neighbours_along_the_row_or_the_column(grid):
    """As in [KG04, minima]."""

    def value(i, j):
        return grid[i, j] if 0 <= i < grid.shape[0] and 0 <= j < grid.shape[1] else np.inf

    marks = minima_1d(grid)
    for (i, j), mark in np.ndenumerate(marks):
        row = value(i, j) <= min(value(i, j - 1), value(i, j + 1))
        column = value(i, j) <= min(value(i - 1, j), value(i + 1, j))
        assert mark == (row or column)


def test_a_valley_has_a_floor_of_minima_in_one_dimension_and_few_in_two():
    rows, columns = np.indices((40, 60))
    grid = (columns - 1.3 * rows) ** 2 + 0.02 * rows
    floor = minima_1d(grid)
    assert all(floor[i].any() for i in range(40))
    assert len(local_minima(grid)) < 15


def test_infinite_cells_are_no_minima():
    assert not minima_1d(np.full((3, 3), np.inf)).any()


@given(st.lists(st.integers(1, 400), min_size=1, max_size=12), st.integers(60, 200), st.integers(0, 50))
def test_pieces_cover_all_windows_and_cut_only_clips_that_are_too_long(lengths, most, overlap):
    starts = np.cumsum([0, *lengths]).tolist()
    cut = pieces(starts, most, overlap)
    assert cut[0].start == 0 and cut[-1].stop == starts[-1]
    assert all(0 < part.stop - part.start <= most for part in cut)
    for first, second in pairwise(cut):
        if second.start in starts and second.start == first.stop:
            continue
        assert first.stop - second.start == overlap  # a part of a long clip, and the next
        assert max(n for n in starts if n <= second.start) <= first.start


def test_a_web_made_of_small_pieces_finds_what_one_piece_finds(bundled, monkeypatch):
    clips = bundled.clips[:2]
    whole = build_web(clips, below=0.05)
    monkeypatch.setattr(local_alignment, "ROWS", 400)
    monkeypatch.setattr(local_alignment, "COLUMNS", 500)
    cut = build_web(clips, below=0.05)
    assert len(whole) != len(cut)  # long paths are cut
    queries = [bundled.truth[3], bundled.truth[-1] if bundled.truth[-1][0] < 2 else bundled.truth[12]]
    seen = set()  # parts of a clip say nothing twice
    for number in np.argsort([-len(cut.path(n)[0]) for n in range(len(cut))], kind="stable"):
        cells = {tuple(cell) for cell in cut.path(int(number))[0].tolist()}
        assert len(cells & seen) <= 0.75 * len(cells)
        seen |= cells
    for number, part in queries:
        one, other = (search(web, number, part) for web in (whole, cut))
        assert len(one) == pytest.approx(len(other), abs=2)
        close = [any(a.clip == b.clip and abs(a.start - b.start) <= 12 for b in other) for a in one]
        assert np.mean(close) >= 0.95
