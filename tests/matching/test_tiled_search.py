"""The search in blocks against the minima of the whole grid."""

from concurrent.futures import Future

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap._shared import tasks
from mocap.matching import distance_grids, tiled_search
from mocap.matching.distance_grids import Cloud, cloud, cloud_distances
from mocap.matching.lower_bound import Weights
from mocap.matching.minima import local_minima
from mocap.matching.tiled_search import find_minima
from tests.strategies import seeds


def smooth_points(seed, frames):
    """Points on waves, with many minima in their grid."""
    random = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / random.uniform(2, 6, (1, 4, 3))
    return np.sin(t + random.uniform(0, 6, (4, 3))) + random.normal(size=(frames, 4, 3)) * 0.01


def equal(window):
    return Weights(np.full(4, 0.25), np.full(window, 1 / window))


def clouds(lengths, window, seed):
    parts = [
        cloud(smooth_points(seed + n, length), np.zeros(4), *equal(window), np.float32)
        for n, length in enumerate(lengths)
    ]
    return Cloud(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


@settings(max_examples=20)
@given(seeds, st.lists(st.integers(4, 30), min_size=1, max_size=4), st.integers(1, 4), st.integers(3, 20))
@pytest.mark.parametrize("below", [1.0, 3.0])
def test_blocks_and_tiles_do_not_show(below, seed, lengths, window, block):
    """Minima at every border are found once, whichever way the grid is cut."""
    whole = clouds(lengths, window, seed)
    count = sum(lengths) - window + 1
    grid = cloud_distances(*[whole.part(slice(0, count))] * 2, np.full(window, 1 / window))
    expected = [[i, j] for i, j in local_minima(grid, below**2).tolist() if j - i >= window]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tiled_search, "BLOCK", block)
        patch.setattr(distance_grids, "TILE", (5, 7))
        found = find_minima(whole, equal(window), below)
    order = np.lexsort(found[1::-1])
    i, j = found[:2].astype(int)
    assert np.stack([i, j], 1)[order].tolist() == expected
    assert found[2] == pytest.approx(np.sqrt(grid[i, j]), abs=2e-3)
    assert found[2] ** 2 == pytest.approx(grid[i, j], abs=1e-6)


def test_no_more_is_measured_than_tiles_and_their_neighbours(monkeypatch):
    shapes = []

    def recorded(a, b, taper):
        grid = cloud_distances(a, b, taper)
        shapes.append(grid.shape)
        return grid

    monkeypatch.setattr(tiled_search, "cloud_distances", recorded)
    monkeypatch.setattr(tiled_search, "BLOCK", 10)
    monkeypatch.setattr(distance_grids, "TILE", (3, 4))
    find_minima(clouds([30], 2, 0), equal(2), 0.8)
    assert (max(rows for rows, _ in shapes), max(columns for _, columns in shapes)) == (5, 6)
    assert len(shapes) == 3 * 12 + 7 + 7 + 6  # of the blocks on the diagonal, only the tiles above it


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


def test_only_a_few_blocks_are_out_at_once(monkeypatch):
    monkeypatch.setattr(tiled_search, "BLOCK", 4)
    monkeypatch.setattr(tasks, "AHEAD", 5)
    whole, executor = clouds([30], 2, 0), Late()
    expected = find_minima(whole, equal(2), 2.0)
    assert expected.shape[1] > 3
    assert np.array_equal(find_minima(whole, equal(2), 2.0, executor=executor), expected)
    assert (executor.most, executor.done, executor.out) == (5, 36, 0)


def test_after_an_error_nothing_is_left_waiting(monkeypatch):
    monkeypatch.setattr(tiled_search, "BLOCK", 4)
    futures = []

    class Failing:
        def submit(self, work, *arguments):
            futures.append(Future())
            if len(futures) == 1:
                futures[0].set_exception(KeyboardInterrupt())
            return futures[-1]

    with pytest.raises(KeyboardInterrupt):
        find_minima(clouds([30], 2, 0), equal(2), 0.8, executor=Failing())
    assert len(futures) == 36
    assert all(future.cancelled() for future in futures[1:])
