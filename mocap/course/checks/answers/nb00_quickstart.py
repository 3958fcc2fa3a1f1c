"""Notebook 00: inputs, right answers and mistakes of `speed` and `cheapest`."""

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.course.checks.answers.common import Arguments

# ---- speed


def draw_speed(rng: np.random.Generator) -> Arguments:
    """Draw a random walk of 2 to 29 points in space, and frames per second from 24 to 120."""
    return rng.normal(size=(rng.integers(2, 30), 3)).cumsum(axis=0), float(rng.integers(24, 121))


def right_speed(positions: Array, fps: float) -> Array:
    """Return the distances over the ground from frame to frame, times the frames per second."""
    return np.asarray(np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps)


def mistake_height_included(positions: Array, fps: float) -> object:
    """Return the lengths of the steps in space, √(Δx² + Δy² + Δz²), times the frames per second."""
    return np.linalg.norm(np.diff(positions, axis=0), axis=1) * fps


def mistake_per_frame(positions: Array, fps: float) -> object:
    """Return the lengths of the steps over the ground, in metres per frame."""
    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T)


def mistake_divided_by_fps(positions: Array, fps: float) -> object:
    """Return the lengths of the steps over the ground, divided by the frames per second."""
    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) / fps


def mistake_x_and_y(positions: Array, fps: float) -> object:
    """Return the speeds in the vertical plane of x and y, √(Δx² + Δy²) times the frames per second."""
    return np.hypot(*np.diff(positions[:, :2], axis=0).T) * fps


def mistake_one_coordinate(positions: Array, fps: float) -> object:
    """Return the absolute velocities along x, |Δx| times the frames per second."""
    return np.abs(np.diff(positions[:, 0])) * fps


def mistake_steps_with_signs(positions: Array, fps: float) -> object:
    """Return the signed velocities along x, Δx times the frames per second."""
    return np.diff(positions[:, 0]) * fps


def mistake_components(positions: Array, fps: float) -> object:
    """Return the velocity vectors over the ground, (Δx, Δz) times the frames per second."""
    return np.diff(positions[:, [0, 2]], axis=0) * fps


def mistake_squared_steps(positions: Array, fps: float) -> object:
    """Return the squared lengths of the steps, Δx² + Δz², times the frames per second."""
    return (np.diff(positions[:, [0, 2]], axis=0) ** 2).sum(axis=1) * fps


def mistake_squared_speeds(positions: Array, fps: float) -> object:
    """Return the squared speeds over the ground, Δx² + Δz² times the squared frames per second."""
    return right_speed(positions, fps) ** 2


def mistake_sum_of_coordinates(positions: Array, fps: float) -> object:
    """Return the city-block lengths of the steps, |Δx| + |Δz|, times the frames per second."""
    return np.abs(np.diff(positions[:, [0, 2]], axis=0)).sum(axis=1) * fps


def mistake_central_differences(positions: Array, fps: float) -> object:
    """Return a speed for each frame, from central differences, one-sided at the two ends."""
    return np.hypot(*np.gradient(positions[:, [0, 2]], axis=0).T) * fps


def mistake_distance_from_start(positions: Array, fps: float) -> object:
    """Return the distances of the later frames from the first frame, times the frames per second."""
    return np.hypot(*(positions[1:] - positions[0])[:, [0, 2]].T) * fps


# ---- cheapest


def draw_cheapest(rng: np.random.Generator) -> Arguments:
    """Draw a grid of distances, and the rows and columns of some of its entries above 0.3."""
    grid = rng.uniform(size=rng.integers(5, 20, 2))
    return grid, rng.permutation(np.argwhere(grid > 0.3))[: rng.integers(3, 12)]


def right_cheapest(grid: Array, minima: Indices) -> Indices:
    """Return the entry at which the grid is smallest."""
    return np.asarray(minima[np.argmin(grid[tuple(minima.T)])])


def mistake_of_whole_grid(grid: Array, minima: Indices) -> object:
    """Return the entry at which the whole grid is smallest, whether it is a minimum of the list or not."""
    return np.argwhere(grid == grid.min())[0]


def mistake_index_in_list(grid: Array, minima: Indices) -> object:
    """Return the index, in the list of minima, of the one at which the grid is smallest."""
    return np.argmin(grid[tuple(minima.T)])


def mistake_worst_minimum(grid: Array, minima: Indices) -> object:
    """Return the minimum at which the grid is largest."""
    return minima[np.argmax(grid[tuple(minima.T)])]


def mistake_distance_itself(grid: Array, minima: Indices) -> object:
    """Return the smallest value of the grid at the minima, instead of its row and column."""
    return grid[tuple(minima.T)].min()


def mistake_column_first(grid: Array, minima: Indices) -> object:
    """Return the column and the row, in this order, of the minimum at which the grid is smallest."""
    return right_cheapest(grid, minima)[::-1]


def mistake_first_in_list(grid: Array, minima: Indices) -> object:
    """Return the first minimum of the list, whatever the grid is there."""
    return minima[0]


def mistake_last_in_list(grid: Array, minima: Indices) -> object:
    """Return the last minimum of the list, whatever the grid is there."""
    return minima[-1]


def mistake_looked_up_transposed(grid: Array, minima: Indices) -> object:
    """Return the minimum (i, j) at which grid[j, i] is smallest.

    In a grid that is not square, the indices wrap around.
    """
    rows, columns = grid.shape
    return minima[np.argmin(grid[minima[:, 1] % rows, minima[:, 0] % columns])]
