"""The search against the minima of the whole grid, however it is cut and wherever the work is done."""

from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared import tasks
from mocap.graphs.motion_graph import build
from mocap.matching import distance_grids, minima
from mocap.matching.distance_grids import Cloud, cloud, cloud_distances, distance_grid
from mocap.matching.minima import find_minima, local_minima
from mocap.matching.transitions import find_transitions
from tests.strategies import seeds, wave

CLIPS = [wave(70, name="a"), wave(50, phase=1.0, name="b", seed=1)]


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


@given(
    st.sampled_from([0.3, 1.0, 3.0]),
    seeds,
    st.lists(st.integers(4, 30), min_size=1, max_size=4),
    st.integers(1, 4),
    st.integers(3, 40),
)
def test_blocks_and_tiles_do_not_show(below, seed, lengths, window, block):
    """Minima at every border are found once, whichever way the grid is cut."""
    whole = clouds(lengths, window, seed)
    count = sum(lengths) - window + 1
    grid = cloud_distances(*[whole.part(slice(0, count))] * 2)
    expected = [[i, j] for i, j in local_minima(grid, below**2).tolist() if j - i >= window]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(minima, "BLOCK", block)
        patch.setattr(distance_grids, "TILE", (5, 7))
        found = find_minima(whole, below)
    order = np.lexsort(found[1::-1])
    i, j = found[:2].astype(int)
    assert np.stack([i, j], 1)[order].tolist() == expected
    assert found[2] == pytest.approx(np.sqrt(grid[i, j]), abs=2e-3)
    assert found[2] ** 2 == pytest.approx(grid[i, j], abs=1e-6)


def test_clips_without_a_whole_window_have_no_minima():
    short = clouds([3], 3, 0)
    short.sizes[:] = np.inf
    assert find_minima(short, 1.0).shape == (6, 0)


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


def test_only_a_few_blocks_are_out_at_once_and_they_are_shown(monkeypatch):
    monkeypatch.setattr(minima, "BLOCK", 10)
    monkeypatch.setattr(tasks, "AHEAD", 4)
    whole, executor, seen = clouds([30], 2, 0), Late(), []
    expected = find_minima(whole, 2.0)
    shown = {"progress": lambda pairs: seen.extend(pairs) or pairs}
    found = find_minima(whole, 2.0, executor=executor, **shown)
    assert expected.shape[1] > 3
    assert np.array_equal(found, expected)
    assert (executor.most, executor.done, executor.out) == (4, 6, 0)
    assert seen == [(0, 0), (0, 10), (0, 20), (10, 10), (10, 20), (20, 20)]


def test_weights_of_joints_are_those_of_the_grid():
    weights = {"joint_weights": [1, 0, 5, 2]}
    grid = distance_grid(*CLIPS, window=8, **weights)
    found = find_transitions(CLIPS, window=8, below=0.1, **weights)
    across = found[(found.source == 0) & (found.target == 1)]
    assert np.stack([across.leave, across.enter], 1).tolist() == local_minima(grid, 0.01).tolist()
    assert across.cost == pytest.approx(np.sqrt(grid[across.leave, across.enter]), abs=1e-7)
    assert not np.array_equal(found.leave, find_transitions(CLIPS, window=8, below=0.1).leave)
    graph = build(CLIPS, window=8, threshold=0.1, **weights)  # passes all parameters on
    assert graph.count("transition") == len(found)


@pytest.mark.parametrize(
    ("executor", "workers"),
    [(ThreadPoolExecutor, 3), pytest.param(ProcessPoolExecutor, 2, marks=pytest.mark.sweep)],
)
def test_any_number_of_workers_gives_the_same_bit_for_bit(executor, workers, monkeypatch):
    monkeypatch.setattr(minima, "BLOCK", 40)
    here = find_transitions(CLIPS, window=8, below=0.1)
    with executor(workers) as pool:
        there = find_transitions(CLIPS, window=8, below=0.1, executor=pool)
    assert all(np.array_equal(a, b) for a, b in zip(here.columns, there.columns, strict=True))
