"""Minima against a loop over neighbours."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocap.matching.minima import local_minima
from tests.refusals import refused
from tests.strategies import seeds


def minima_by_loops(grid, below):
    rows, columns = grid.shape
    found = []
    for i, j in np.ndindex(rows, columns):
        around = [(i + r, j + c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)]
        inside = [(r, c) for r, c in around if 0 <= r < rows and 0 <= c < columns]
        lower = all((grid[n], n) > (grid[i, j], (i, j)) for n in inside)
        if lower and grid[i, j] < below:
            found.append([i, j])
    return found


@given(seeds, st.integers(1, 7), st.integers(1, 7), st.sampled_from([1, 2, 2.5, np.inf]))
def test_minima_are_lower_than_all_neighbours_and_ties_go_to_the_first(seed, rows, columns, below):
    """As in [KGP02, 3.2]."""
    grid = np.random.default_rng(seed).integers(0, 5, (rows, columns))
    assert local_minima(grid, below).tolist() == minima_by_loops(grid, below)


def test_grids_without_minima():
    assert local_minima(np.full((3, 3), np.inf)).shape == (0, 2)
    for shape in ((0, 3), (3, 0), (0, 0)):
        assert local_minima(np.empty(shape)).shape == (0, 2)
    assert local_minima(np.ones((2, 2)), below=1).shape == (0, 2)


def test_what_is_no_grid_is_refused():
    refused(r"two dimensions, got shape \(3,\)", local_minima, np.ones(3))
    refused(r"NaN at \[2, 1\]", local_minima, np.array([[1.0, 2.0], [3.0, 4.0], [5.0, np.nan]]))
