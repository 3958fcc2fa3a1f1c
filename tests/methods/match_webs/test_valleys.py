import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import array_shapes, arrays

from mocap.errors import MocapError
from mocap.matching import local_minima
from mocap.methods.match_webs import minima_1d


@given(
    arrays(
        np.int64, array_shapes(min_dims=2, max_dims=2, max_side=8), elements={"min_value": 0, "max_value": 5}
    )
)
def test_minima_are_no_higher_than_both_neighbours_along_the_row_or_the_column(grid):
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


def test_a_grid_has_two_dimensions():
    with pytest.raises(MocapError, match=r"A grid has two dimensions, got shape \(3,\)\."):
        minima_1d([1, 2, 3])
