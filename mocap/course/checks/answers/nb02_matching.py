"""Notebook 02: inputs, right answers and mistakes of `best_shift` and `inner_minima`."""

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.course.checks.answers.common import Arguments, clouds, turned
from mocap.matching.minima import local_minima


def inside(grid: Array, minima: Indices) -> set[tuple[int, int]]:
    """Return the entries that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    is_inside = ((minima > 0) & (minima < last)).all(axis=1)
    return {(int(row), int(column)) for row, column in minima[is_inside]}


# ---- best_shift


def draw_best_shift(rng: np.random.Generator) -> Arguments:
    return (*clouds(rng), rng.uniform(-np.pi, np.pi))


def right_best_shift(points: Array, moved: Array, angle: float) -> Array:
    return np.asarray((points.mean(0) - turned(moved, angle).mean(0))[[0, 2]])


def mistake_not_rotated(points: Array, moved: Array, angle: float) -> object:
    return (points.mean(0) - moved.mean(0))[[0, 2]]


def mistake_rotated_backwards(points: Array, moved: Array, angle: float) -> object:
    return (points.mean(0) - turned(moved, -angle).mean(0))[[0, 2]]


def mistake_points_onto_others(points: Array, moved: Array, angle: float) -> object:
    return -right_best_shift(points, moved, angle)


def mistake_sums(points: Array, moved: Array, angle: float) -> object:
    return right_best_shift(points, moved, angle) * len(points)


def mistake_z_first(points: Array, moved: Array, angle: float) -> object:
    return right_best_shift(points, moved, angle)[::-1]


# ---- inner_minima


def draw_inner_minima(rng: np.random.Generator) -> Arguments:
    return rng.uniform(0, 1, rng.integers(7, 12, 2)), float(rng.uniform(0.2, 0.6))


def right_inner_minima(grid: Array, below: float) -> set[tuple[int, int]]:
    return inside(grid, local_minima(grid, below))


def mistake_border_included(grid: Array, below: float) -> object:
    return {tuple(map(int, place)) for place in local_minima(grid, below)}


def mistake_no_threshold(grid: Array, below: float) -> object:
    return inside(grid, local_minima(grid))


def mistake_all_below_threshold(grid: Array, below: float) -> object:
    return inside(grid, np.argwhere(grid < below))


def mistake_threshold_squared(grid: Array, below: float) -> object:
    return inside(grid, local_minima(grid, below**2))


def mistake_column_of_minimum_first(grid: Array, below: float) -> object:
    return {(c, r) for r, c in right_inner_minima(grid, below)}


def mistake_maxima(grid: Array, below: float) -> object:
    return inside(grid, local_minima(-grid))
