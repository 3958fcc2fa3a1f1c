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


STRAIGHT = ((-1, 0), (1, 0), (0, -1), (0, 1))  # above, below, left, right
DIAGONAL = ((-1, -1), (-1, 1), (1, -1), (1, 1))
ALL = (*STRAIGHT, *DIAGONAL)


def lower_than(grid: Array, below: float, neighbours: tuple[tuple[int, int], ...]) -> set[tuple[int, int]]:
    """Return the inner entries under a threshold that are lower than each of these neighbours."""
    is_low = grid < below
    for rows, columns in neighbours:
        is_low &= grid < np.roll(grid, (-rows, -columns), axis=(0, 1))
    return inside(grid, np.argwhere(is_low))


def equal_or_lower(grid: Array, below: float) -> Indices:
    """List the entries under a threshold that are not higher than any neighbour."""
    is_low = grid < below
    for rows, columns in ALL:
        is_low &= grid <= np.roll(grid, (-rows, -columns), axis=(0, 1))
    return np.argwhere(is_low)


# ---- best_shift


def draw_best_shift(rng: np.random.Generator) -> Arguments:
    """Draw two clouds of points and an angle."""
    return (*clouds(rng), rng.uniform(-np.pi, np.pi))


def right_best_shift(points: Array, moved: Array, angle: float) -> Array:
    """Return the difference of the centroids on the ground, after the second cloud is rotated."""
    return np.asarray((points.mean(0) - turned(moved, angle).mean(0))[[0, 2]])


def mistake_not_rotated(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids while the second cloud is not rotated."""
    return (points.mean(0) - moved.mean(0))[[0, 2]]


def mistake_rotated_backwards(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids after the second cloud is rotated by -angle."""
    return (points.mean(0) - turned(moved, -angle).mean(0))[[0, 2]]


def mistake_points_onto_others(points: Array, moved: Array, angle: float) -> object:
    """Return the negative difference, which translates the first cloud onto the second."""
    return -right_best_shift(points, moved, angle)


def mistake_sums(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the sums of x and of z, instead of that of the means."""
    return right_best_shift(points, moved, angle) * len(points)


def mistake_z_first(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids in the order (z0, x0)."""
    return right_best_shift(points, moved, angle)[::-1]


def mistake_angle_converted(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids after a rotation by angle · π/180."""
    return right_best_shift(points, moved, float(np.radians(angle)))


def mistake_angle_in_degrees(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids after a rotation by angle · 180/π."""
    return right_best_shift(points, moved, float(np.degrees(angle)))


def mistake_height_included(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids in space, (x0, y0, z0), after the rotation."""
    return points.mean(0) - turned(moved, angle).mean(0)


def mistake_x_and_y(points: Array, moved: Array, angle: float) -> object:
    """Return the coordinates x and y of the difference of the centroids, after the rotation."""
    return (points.mean(0) - turned(moved, angle).mean(0))[:2]


def mistake_points_rotated(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the centroids after the first cloud is rotated instead of the second."""
    return (turned(points, angle).mean(0) - moved.mean(0))[[0, 2]]


def mistake_first_points_alone(points: Array, moved: Array, angle: float) -> object:
    """Return the difference of the first points of the two clouds, after the second is rotated."""
    return (points[0] - turned(moved, angle)[0])[[0, 2]]


# ---- inner_minima


def draw_inner_minima(rng: np.random.Generator) -> Arguments:
    """Draw a grid and a threshold; in one grid of two, some entries are equal, and some at the threshold."""
    grid = rng.uniform(0, 1, rng.integers(7, 12, 2))
    below = float(rng.uniform(0.2, 0.6))
    if rng.uniform() < 0.5:
        return np.round(16 * grid) / 16, round(16 * below) / 16
    return grid, below


def right_inner_minima(grid: Array, below: float) -> set[tuple[int, int]]:
    """Return the minima; `local_minima` counts the first of equal neighbours, which is not lower."""
    return inside(grid, local_minima(grid, below)) & lower_than(grid, below, ALL)


def mistake_border_included(grid: Array, below: float) -> object:
    """Return the minima under the threshold, also those on the border, with the neighbours they have."""
    framed = np.pad(grid, 1, constant_values=np.inf)
    return {(row - 1, column - 1) for row, column in lower_than(framed, below, ALL)}


def mistake_no_threshold(grid: Array, below: float) -> object:
    """Return the inner minima, whatever their value."""
    return lower_than(grid, np.inf, ALL)


def mistake_all_below_threshold(grid: Array, below: float) -> object:
    """Return the inner entries under the threshold, minima or not."""
    return inside(grid, np.argwhere(grid < below))


def mistake_threshold_squared(grid: Array, below: float) -> object:
    """Return the inner minima under the square of the threshold."""
    return lower_than(grid, below**2, ALL)


def mistake_column_of_minimum_first(grid: Array, below: float) -> object:
    """Return the inner minima under the threshold as (column, row)."""
    return {(c, r) for r, c in right_inner_minima(grid, below)}


def mistake_maxima(grid: Array, below: float) -> object:
    """Return the inner entries that are higher than their eight neighbours, whatever their value."""
    return lower_than(-grid, np.inf, ALL)


def mistake_equal_neighbours_allowed(grid: Array, below: float) -> object:
    """Return the inner entries under the threshold that are not higher than any neighbour."""
    return inside(grid, equal_or_lower(grid, below))


def mistake_at_threshold(grid: Array, below: float) -> object:
    """Return the inner minima that are under the threshold or equal to it."""
    return right_inner_minima(grid, np.nextafter(below, np.inf))


def mistake_four_neighbours(grid: Array, below: float) -> object:
    """Return the entries lower than those above, below, left and right."""
    return lower_than(grid, below, STRAIGHT)


def mistake_diagonals_alone(grid: Array, below: float) -> object:
    """Return the entries lower than their four diagonal neighbours."""
    return lower_than(grid, below, DIAGONAL)


def mistake_same_column(grid: Array, below: float) -> object:
    """Return the entries lower than those above and below."""
    return lower_than(grid, below, STRAIGHT[:2])


def mistake_same_row(grid: Array, below: float) -> object:
    """Return the entries lower than those to the left and right."""
    return lower_than(grid, below, STRAIGHT[2:])


def mistake_none_found(grid: Array, below: float) -> object:
    """Return an empty list, as a comparison of each entry with itself does."""
    return []


def mistake_flat_indices(grid: Array, below: float) -> object:
    """Return the inner minima as indices into the flattened grid, row · columns + column."""
    return [row * grid.shape[1] + column for row, column in right_inner_minima(grid, below)]


def mistake_plain_minima(grid: Array, below: float) -> object:
    """Return the minima of `local_minima`: also those on the border, and the first of equal neighbours."""
    return {tuple(map(int, place)) for place in local_minima(grid, below)}


def mistake_plain_minima_inside(grid: Array, below: float) -> object:
    """Return the inner ones of `local_minima`, among them the first of equal neighbours."""
    return inside(grid, local_minima(grid, below))
