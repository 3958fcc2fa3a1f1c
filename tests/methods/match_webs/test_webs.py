"""A web holds sound paths, whatever its clips are."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from mocap import datasets, resample
from mocap.body import Motion, PlanarTransform, Skeleton
from mocap.errors import SkeletonMismatch
from mocap.matching import distance_grid, local_minima
from mocap.methods.match_webs import build_web, local_alignment, local_paths, minima_1d, search
from mocap.methods.match_webs.local_alignment import apart, pieces
from mocap.methods.match_webs.webs import WINDOW
from tests.oracles import least_sum, longest_run, path_sum
from tests.refusals import refusals, told
from tests.tuning import tune

SLOPE, NEAR = 2, 3


def cells_of_grid(web):
    """Count the pairs of windows that a web compares: those above the diagonal of all against all."""
    windows = (np.diff(web.starts) - WINDOW + 1).sum()
    return windows * (windows - 1) / 2


def check_paths(web):
    """Hold what each path of a web must be."""
    seen = set()
    for number in range(len(web)):  # of two clips, the best path comes first
        cells, costs = web.path(number)
        steps = np.diff(cells, axis=0)
        assert costs.mean() < web.below
        assert np.isin(steps, (0, 1)).all() and steps.any(axis=1).all()
        assert longest_run(cells) <= SLOPE
        clips = {tuple(web.clip_at(frame) for frame in cell) for cell in cells[[0, -1]]}
        assert len(clips) == 1 and next(iter(clips)) == tuple(sorted(next(iter(clips))))
        assert (cells[-1] - cells[0]).min() >= 9
        assert (cells[:, 0] < cells[:, 1]).all()
        assert sum(tuple(cell) in seen for cell in cells.tolist()) <= 0.5 * len(cells)
        seen.update((i, j + away) for i, j in cells.tolist() for away in range(-NEAR, NEAR + 1))


def test_the_web_of_the_bundled_clips_is_small_and_its_paths_are_sound(bundled):
    """As in [KG04, match web]."""
    web = bundled.web
    assert web.starts[-1] == 4684
    assert len(web.cells) <= 0.02 * cells_of_grid(web)
    assert web.cells.nbytes + web.costs.nbytes <= 0.05 * 4 * 2 * cells_of_grid(web)
    check_paths(web)


def test_the_costs_are_those_of_the_distance_grid(bundled, low):
    web = bundled.web
    number = next(n for n in range(len(web)) if web.clip_at(web.path(n)[0][0, 1]) == 2)
    cells, costs = web.path(number)
    first, second = (web.clip_at(frame) for frame in cells[0])
    grid = np.sqrt(distance_grid(low[first], low[second], window=5))
    rows, columns = (cells - web.starts[[first, second]] - 2).T  # a cell is the middle of two windows of 5
    assert np.allclose(grid[rows, columns], costs, atol=1e-4)


def test_a_moved_and_turned_clip_makes_the_same_web(bundled):
    walk = bundled.clips[0]
    far = PlanarTransform(2.5, 112.0, -40.0).apply_motion(walk)
    one, other = build_web([walk], below=0.05), build_web([far], below=0.05)
    assert len(one) == len(other)
    assert np.abs(one.costs.sum() - other.costs.sum()) < 1e-2


def test_a_bar_sees_all_pairs_and_changes_nothing(bundled):
    clips, seen = bundled.clips[:3], []

    def bar(pairs):
        seen.extend(pairs)
        return iter(pairs)

    theirs, ours = build_web(clips, below=0.06, progress=bar), build_web(clips, below=0.06)
    assert np.array_equal(ours.cells, theirs.cells) and len(seen) > 1


def test_a_planted_copy_is_found_at_its_own_pace():
    """A second of sneaking is played 1.25 times as fast inside a walk."""
    sneak, walk = datasets.sample("sneak"), datasets.sample("walk_straight")
    plant = resample(replace(sneak[1000:1240], fps=120 * 1.25), 120)
    roots = np.concatenate([walk.root_positions[:300], plant.root_positions, walk.root_positions[300:600]])
    turns = np.concatenate([walk.rotations[:300], plant.rotations, walk.rotations[300:600]])
    host = Motion(walk.skeleton, roots, turns, 120.0, "host")
    web = build_web([sneak[900:1400], host], below=0.03)
    found = search(web, 0, slice(100, 340), lengths=(0.5, 2))
    [match] = [match for match in found if match.clip == 1]
    assert abs(match.start - 300) <= 8 and abs(match.stop - (300 + len(plant))) <= 8
    assert np.polyfit(match.rows, match.frames, 1)[0] == pytest.approx(1 / 1.25, abs=0.05)


def test_no_path_runs_from_one_clip_into_the_next(bundled):
    parts = [bundled.clips[0][a : a + 120] for a in range(0, 600, 120)]
    web = build_web(parts, below=0.1)
    assert len(web) > 5
    for number in range(len(web)):
        cells, _ = web.path(number)
        assert all(len({web.clip_at(frame) for frame in side}) == 1 for side in cells.T)
        assert cells.max() < web.starts[-1]


def test_clips_too_short_for_a_path_are_left_out_with_a_warning(bundled):
    walk = bundled.clips[0]
    short = replace(walk[:40], name="blink")
    left_out = (
        r"^Too short to hold a path of 0.47 s, and left out: 'blink', 'blink', 'blink', 'blink' and 1 more\.$"
    )
    web = told(left_out, build_web, [short, walk, *[short] * 4], below=0.05)
    alone = build_web([walk], below=0.05)
    assert np.array_equal(web.cells, alone.cells)
    assert {web.clip_at(frame) for frame in web.cells.ravel()} == {1}


def still(joints=1, frames=100, fps=30.0):
    names = [f"j{n}" for n in range(joints)]
    skeleton = Skeleton(names, [-1, *range(joints - 1)], np.tile([0, 0.1, 0], (joints, 1)))
    return Motion(skeleton, np.zeros((frames, 3)), np.tile([1.0, 0, 0, 0], (frames, joints, 1)), fps, "still")


test_hostile_input_is_one_sentence = refusals(
    ("one clip or more, got none", build_web, []),
    (SkeletonMismatch, "joints", build_web, [still(), still(2)]),
    ("resample one first", build_web, [still(), still(fps=60.0)]),
    ("No clip is long enough for a path: that takes 0.47 s", build_web, [still(frames=13)]),
)


def test_a_web_says_what_it_holds_and_is_not_to_be_changed(bundled):
    assert repr(bundled.web) == f"MatchWeb(5 clips, {len(bundled.web)} paths, below 8 cm)"
    with pytest.raises(ValueError, match="read-only"):
        bundled.web.cells[0] = 0


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
    """Frames of both clips count [KG04, chains and bridges]."""
    costs = np.full((8, 8), 1.0)
    costs[[0, 1, 1, 2], [0, 1, 2, 3]] = -1
    assert [len(path) for path in local_paths(costs, least=2)] == [4]
    assert not list(local_paths(costs, least=3))


def test_more_steps_to_the_right_in_a_row_take_a_larger_slope():
    costs = np.ones((4, 7))
    costs[[0, 1, 2], [1, 2, 6]] = -3
    assert next(local_paths(costs)).tolist() == [[0, 1], [1, 2]]
    steep = next(local_paths(costs, slope=3)).tolist()
    assert steep == [[0, 1], [1, 2], [1, 3], [1, 4], [1, 5], [2, 6]]


def test_a_path_of_which_half_is_near_another_one_is_kept():
    down = np.stack([np.arange(4), np.arange(4)], axis=1)
    half = np.array([[0, 0], [1, 1], [2, 7], [3, 8]])
    assert len(apart([down, half], near=1)) == 2
    assert len(apart([down, half[:3]], near=1)) == 1


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
    tune(monkeypatch, local_alignment, part_rows=400)
    tune(monkeypatch, local_alignment, part_columns=500)
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
