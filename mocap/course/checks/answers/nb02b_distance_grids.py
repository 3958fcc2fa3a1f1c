"""Notebook 02b: inputs, right answers and mistakes of `window_sums` and `later_by`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments

# ---- window_sums


def draw_window_sums(rng: np.random.Generator) -> Arguments:
    """Draw a matrix of products, and a window of 2 to 4 frames."""
    return rng.normal(size=rng.integers(7, 12, 2)), int(rng.integers(2, 5))


def right_window_sums(products: Array, window: int) -> Array:
    """Add up products[i + f, j + f] over a window's frames, as far as a window fits."""
    rows, columns = (count - window + 1 for count in products.shape)
    blocks = [products[f : f + rows, f : f + columns] for f in range(window)]
    return np.asarray(np.sum(blocks, axis=0))


def mistake_window_too_short(products: Array, window: int) -> object:
    """Return the sums over window - 1 frames, with one row and one column more."""
    return right_window_sums(products, window - 1)


def mistake_window_too_long(products: Array, window: int) -> object:
    """Return the sums over window + 1 frames, with one row and one column fewer."""
    return right_window_sums(products, window + 1)


def mistake_last_window_missing(products: Array, window: int) -> object:
    """Return the sums without the last window of each clip."""
    return right_window_sums(products, window)[:-1, :-1]


def mistake_down_the_columns(products: Array, window: int) -> object:
    """Return Σ_f products[i + f, j]: the frame of the second clip stays."""
    rows, columns = (count - window + 1 for count in products.shape)
    blocks = [products[f : f + rows, 0:columns] for f in range(window)]
    return np.sum(blocks, axis=0)


def mistake_other_diagonal(products: Array, window: int) -> object:
    """Return Σ_f products[i + f, j + k - 1 - f], with k = window: the second clip runs backwards."""
    return right_window_sums(products[:, ::-1], window)[:, ::-1]


def mistake_mean_of_window(products: Array, window: int) -> object:
    """Return the means of products[i + f, j + f] over the frames of a window."""
    return right_window_sums(products, window) / window


# ---- later_by


def draw_later_by(rng: np.random.Generator) -> Arguments:
    """Draw a few points, and return the grid of their squared distances."""
    places = rng.normal(size=(int(rng.integers(5, 10)), 3))
    return (((places[:, None] - places) ** 2).sum(-1),)


def right_later_by(grid: Array) -> Array:
    """Return the means of the main diagonal and of those above it."""
    return np.array([grid.diagonal(n).mean() for n in range(len(grid))])


def mistake_sums_of_diagonals(grid: Array) -> object:
    """Return the sums of the main diagonal and of those above it."""
    return np.array([grid.diagonal(n).sum() for n in range(len(grid))])


def mistake_divided_by_size(grid: Array) -> object:
    """Return the sums of the diagonals, each divided by the size of the grid."""
    return np.array([grid.diagonal(n).sum() / len(grid) for n in range(len(grid))])


def mistake_mean_of_roots(grid: Array) -> object:
    """Return the means of the square roots on the main diagonal and on those above it."""
    return np.array([np.sqrt(grid.diagonal(n)).mean() for n in range(len(grid))])


def mistake_diagonals_wrap_around(grid: Array) -> object:
    """Return the means of grid[i, (i + n) mod N] over all rows i of a grid of size N."""
    return np.array([np.roll(grid, -n, axis=1).diagonal().mean() for n in range(len(grid))])


def mistake_mean_of_columns(grid: Array) -> object:
    """Return the mean of each column."""
    return grid.mean(axis=0)


def mistake_first_row(grid: Array) -> object:
    """Return the first row, the distances of the first window from each window."""
    return grid[0]


def mistake_without_zero(grid: Array) -> object:
    """Return the means of the diagonals above the main one."""
    return right_later_by(grid)[1:]
