"""Both searches against the minima of the whole grid, however it is cut and wherever the work is done."""

from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap import load, resample
from mocap._shared import tasks
from mocap.graphs.motion_graph import build
from mocap.matching import distance_grids, pair_search, principal_directions, transitions
from mocap.matching.distance_grids import Cloud, cloud, cloud_distances, distance_grid
from mocap.matching.lower_bound import MOST, projections, reach, whole_windows, window_numbers
from mocap.matching.minima import local_minima
from mocap.matching.pair_search import find_minima, is_quicker
from mocap.matching.point_clouds import unit_weights
from mocap.matching.transitions import find_transitions
from tests.conftest import SWEEP
from tests.strategies import planar, seeds, wave

CLIPS = [wave(70, name="a"), wave(50, phase=1.0, name="b", seed=1)]
each_way = pytest.mark.parametrize("by_bound", [False, True])


def smooth_points(seed, frames):
    """Points on waves, with many minima in their grid."""
    random = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / random.uniform(2, 6, (1, 4, 3))
    return np.sin(t + random.uniform(0, 6, (4, 3))) + random.normal(size=(frames, 4, 3)) * 0.01


EQUAL = np.full(4, 0.25)


def clouds(lengths, window, seed):
    parts = [
        cloud(smooth_points(seed + n, length), np.zeros(4), EQUAL, window, np.float32)
        for n, length in enumerate(lengths)
    ]
    return Cloud(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


@each_way
@given(
    st.sampled_from([0.3, 1.0, 3.0]),
    seeds,
    st.lists(st.integers(4, 30), min_size=1, max_size=4),
    st.integers(1, 4),
    st.integers(3, 40),
)
def test_blocks_and_tiles_do_not_show(by_bound, below, seed, lengths, window, block):
    """Minima at every border are found once, whichever way the grid is cut."""
    whole = clouds(lengths, window, seed)
    count = sum(lengths) - window + 1
    grid = cloud_distances(*[whole.part(slice(0, count))] * 2)
    expected = [[i, j] for i, j in local_minima(grid, below**2).tolist() if j - i >= window]
    with pytest.MonkeyPatch.context() as patch:
        for name, value in (("BLOCK", block), ("WIDE_BLOCK", block), ("ROWS", 5), ("LOOKED_AT", 20)):
            patch.setattr(pair_search, name, value)
        patch.setattr(distance_grids, "TILE", (5, 7))
        found = find_minima(whole, EQUAL, below, by_bound=by_bound)
    order = np.lexsort(found[1::-1])
    i, j = found[:2].astype(int)
    assert np.stack([i, j], 1)[order].tolist() == expected
    assert found[2] == pytest.approx(np.sqrt(grid[i, j]), abs=2e-3)
    assert found[2] ** 2 == pytest.approx(grid[i, j], abs=1e-6)


@each_way
def test_clips_without_a_whole_window_have_no_minima(by_bound):
    short = clouds([3], 3, 0)
    short.sizes[:] = np.inf
    assert find_minima(short, EQUAL, 1.0, by_bound=by_bound).shape == (6, 0)


class Late:
    """An executor that does nothing before its results are asked for; it counts what is out."""

    def __init__(self):
        self.out = self.most = self.done = 0

    def submit(self, work, *arguments):
        self.out += 1
        self.most = max(self.most, self.out)
        future = Future()

        def result(timeout=None):
            self.out, self.done = self.out - 1, self.done + 1
            return work(*arguments)

        future.result = result
        return future


@each_way
def test_only_a_few_blocks_are_out_at_once_and_they_are_shown(by_bound, monkeypatch):
    monkeypatch.setattr(pair_search, "WIDE_BLOCK" if by_bound else "BLOCK", 10)
    monkeypatch.setattr(tasks, "AHEAD", 4)
    whole, executor, seen = clouds([30], 2, 0), Late(), []
    expected = find_minima(whole, EQUAL, 2.0, by_bound=by_bound)
    found = find_minima(
        whole,
        EQUAL,
        2.0,
        by_bound=by_bound,
        executor=executor,
        progress=lambda pairs: seen.extend(pairs) or pairs,
    )
    assert expected.shape[1] > 3
    assert np.array_equal(found, expected)
    assert (executor.most, executor.done, executor.out) == (4, 6, 0)
    assert seen == [(0, 0), (0, 10), (0, 20), (10, 10), (10, 20), (20, 20)]


def same(found, others, costs=1e-9):
    places = all(np.array_equal(a, b) for a, b in zip(found.columns[:4], others.columns[:4], strict=True))
    return places and np.allclose(found.cost, others.cost, atol=costs, rtol=0)


def both_ways(clips, **search):
    return [find_transitions(clips, method=method, **search) for method in ("products", "bound")]


@pytest.mark.parametrize("window", [1, 2, 8])
@pytest.mark.parametrize("below", [0.1, np.inf])
def test_both_methods_give_the_same_transitions(window, below):
    every, few = both_ways(CLIPS, window=window, below=below)
    assert same(few, every) and len(every) > 0


@pytest.mark.parametrize("window", [1, 2, 8])
def test_in_32_bits_both_methods_differ_in_flat_valleys_only(window):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(transitions, "FEW", 0)
        every, few = both_ways(CLIPS, window=window, below=0.1)
    places, others = (set(zip(*(c.tolist() for c in f.columns[:4]), strict=True)) for f in (every, few))
    assert len(places & others) > 0.95 * max(len(places), len(others))
    assert few.cost.min() == pytest.approx(every.cost.min(), abs=1e-6)


@pytest.mark.parametrize("method", ["products", "bound"])
def test_weights_of_joints_are_those_of_the_grid(method):
    weights = {"joint_weights": [1, 0, 5, 2]}
    grid = distance_grid(*CLIPS, window=8, **weights)
    found = find_transitions(CLIPS, window=8, below=0.1, method=method, **weights)
    across = found[(found.source == 0) & (found.target == 1)]
    assert np.stack([across.leave, across.enter], 1).tolist() == local_minima(grid, 0.01).tolist()
    assert across.cost == pytest.approx(np.sqrt(grid[across.leave, across.enter]), abs=1e-7)
    assert not same(found, find_transitions(CLIPS, window=8, below=0.1, method=method))
    graph = build(CLIPS, window=8, threshold=0.1, method=method, **weights)  # passes all parameters on
    assert graph.count("transition") == len(found)


def test_the_bound_is_taken_for_many_windows_of_which_few_are_near(monkeypatch):
    whole = clouds([200], 2, 0)
    assert not is_quicker(whole, EQUAL, 0.01)
    monkeypatch.setattr(pair_search, "MANY", 100)
    assert not is_quicker(whole, EQUAL, 0.3)  # each window is near itself: 1 pair in 200
    monkeypatch.setattr(pair_search, "LOOSE", 0.02)
    assert is_quicker(whole, EQUAL, 0.01)
    assert not is_quicker(whole, EQUAL, 10.0)
    assert not is_quicker(whole, EQUAL, np.inf)


def test_auto_asks_which_is_quicker(monkeypatch):
    ways = []

    def search(*arguments, by_bound, **settings):
        ways.append(by_bound)
        return find_minima(*arguments, by_bound=by_bound, **settings)

    monkeypatch.setattr(transitions, "find_minima", search)
    for quicker in (True, False):
        monkeypatch.setattr(transitions, "is_quicker", lambda *_, quicker=quicker: quicker)
        find_transitions(CLIPS, window=8, below=0.1)
    assert ways == [True, False]


@pytest.mark.parametrize("method", ["products", "bound"])
@pytest.mark.parametrize(
    ("executor", "workers"),
    [(ThreadPoolExecutor, 3), pytest.param(ProcessPoolExecutor, 2, marks=pytest.mark.sweep)],
)
def test_any_number_of_workers_gives_the_same_bit_for_bit(executor, workers, method, monkeypatch):
    for name in ("BLOCK", "WIDE_BLOCK"):
        monkeypatch.setattr(pair_search, name, 40)
    here = find_transitions(CLIPS, window=8, below=0.1, method=method)
    with executor(workers) as pool:
        there = find_transitions(CLIPS, window=8, below=0.1, method=method, executor=pool)
    assert all(np.array_equal(a, b) for a, b in zip(here.columns, there.columns, strict=True))


def real_clips(real_data, pattern):
    takes = [load(path) for path in sorted((real_data / "cmu").glob(pattern))]
    takes = [replace(take, skeleton=takes[0].skeleton) for take in takes]
    return [resample(take, 30) for take in takes if len(take) > 60]


def assert_all_found(clips):
    for below in (0.02, 0.04, 0.06, 0.1) if SWEEP else (0.04, 0.1):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(transitions, "FEW", np.inf)
            every, few = both_ways(clips, window=10, below=below)
        assert same(few, every), below


def test_every_transition_of_some_real_clips_is_found(real_data):
    assert_all_found(real_clips(real_data, "16/16_[13][5-7].amc"))


@pytest.mark.exhaustive
def test_every_transition_of_all_real_clips_is_found(real_data):
    assert_all_found(real_clips(real_data, "*/*.amc"))


precisions = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def prepared(points, window, dtype, random=None):
    """Prepare points, with equal weights or random ones of which some are 0."""
    count = points.shape[1]
    drawn = None if random is None else random.integers(0, 4, count) + (np.arange(count) == 0)
    weights = unit_weights(drawn, count)
    return cloud(points, points[..., 1].mean(0), weights, window, dtype), weights


def apart(rows):
    return np.linalg.norm(rows[:, None].astype(float) - rows, axis=-1)


def measured(ready):
    count = len(whole_windows(ready))
    return cloud_distances(*[ready.part(slice(0, count))] * 2).astype(float)


@precisions
@given(seeds, st.integers(1, 6), st.integers(1, 5), st.sampled_from([0.01, 1.0, 100.0]), st.booleans())
def test_the_bound_is_below_the_distance_of_random_clouds(dtype, seed, window, points, size, weighted):
    random = np.random.default_rng(seed)
    clip = random.normal(size=(14 + window, points, 3)) * size
    ready, weights = prepared(clip, window, dtype, random if weighted else None)
    starts = whole_windows(ready)
    numbers = window_numbers(ready, starts, weights)
    grid = measured(ready)
    for count in (1, 3, MOST):
        found = projections(ready, starts, weights, principal_directions(numbers, count))
        least = apart(found)
        assert np.all(least <= np.vectorize(lambda cost: reach(ready, cost))(np.sqrt(grid)))
        assert np.all(least <= apart(numbers) + 1e-4 * size)


@given(seeds, planar)
def test_no_planar_transform_changes_the_numbers(seed, transform):
    clip = np.random.default_rng(seed).normal(size=(9, 4, 3))
    ready, weights = prepared(clip, 3, np.float64)
    moved, _ = prepared(transform.apply_points(clip), 3, np.float64)
    starts = whole_windows(ready)
    numbers, others = (window_numbers(each, starts, weights) for each in (ready, moved))
    assert numbers == pytest.approx(others, abs=1e-9)


@precisions
def test_the_margin_is_small_beside_a_threshold_and_grows_with_the_bodies(dtype):
    body = np.random.default_rng(0).normal(size=(40, 31, 3)) * [0.3, 0.5, 0.3]
    ready, _ = prepared(body, 10, dtype)
    large, _ = prepared(10 * body, 10, dtype)
    margins = [reach(each, 0.04) - 0.04 for each in (ready, large)]
    assert 0 < margins[0] < (3e-4 if dtype == np.float32 else 1e-11)
    assert margins[1] > 5 * margins[0]


def test_a_margin_of_nothing_would_lose_pairs_in_32_bits():
    """The measured distance of two windows can be less than the bound: this is what `reach` is for."""
    random = np.random.default_rng(5)
    clip = random.normal(size=(30, 8, 3)) * [0, 1, 0] + [0, 5, 0]  # only heights differ, so bound = distance
    twice = np.concatenate([clip, clip + 1e-3 * random.normal(size=clip.shape)])
    ready, weights = prepared(twice, 1, np.float32)
    starts = whole_windows(ready)
    numbers = window_numbers(ready, starts, weights)
    least = apart(projections(ready, starts, weights, principal_directions(numbers)))
    cost = np.sqrt(measured(ready))
    assert np.any(least > cost)
    assert np.all(least <= np.vectorize(lambda each: reach(ready, each))(cost))
