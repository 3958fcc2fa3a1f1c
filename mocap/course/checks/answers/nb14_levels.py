"""Notebook 14: inputs, right answers and mistakes of `clip_gap`, `position_slope` and `local_fit`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments

# ---- clip_gap


def draw_clip_gap(rng: np.random.Generator) -> Arguments:
    """Draw places (N, 3), and boxes: of no width, narrow and wide, some open on a side or on both."""
    positions = rng.normal(size=(8, 3))
    low = rng.normal(size=(8, 3))
    is_open_below, is_open_above = rng.random((2, 8, 3)) < 0.3
    high = low + rng.choice([0.0, 0.05, 1.0], (8, 3))
    return positions, np.where(is_open_below, -np.inf, low), np.where(is_open_above, np.inf, high)


def right_clip_gap(p: Array, low: Array, high: Array) -> Array:
    """Return the shortest vector from a point into the box."""
    return np.clip(p, low, high) - p


def mistake_opposite_gap(p: Array, low: Array, high: Array) -> object:
    """Return the vector from the nearest point of the box to p."""
    return p - np.clip(p, low, high)


def mistake_nearest_point(p: Array, low: Array, high: Array) -> object:
    """Return the nearest point of the box itself."""
    return np.clip(p, low, high)


def mistake_middle_of_box(p: Array, low: Array, high: Array) -> object:
    """Return the vector to the middle of the box on axes with two finite ends, and 0 on the others."""
    is_bounded = np.isfinite(high - low)
    middle = np.nan_to_num(low) / 2 + np.nan_to_num(high) / 2
    return np.where(is_bounded, middle - p, 0.0)


def mistake_floor_alone(p: Array, low: Array, high: Array) -> object:
    """Return the vector up to the lower ends, max(low - p, 0), as if no upper end existed."""
    return np.maximum(low - p, 0.0)


def mistake_ceiling_alone(p: Array, low: Array, high: Array) -> object:
    """Return the vector down to the upper ends, min(high - p, 0), as if no lower end existed."""
    return np.minimum(high - p, 0.0)


def mistake_held_axis_free(p: Array, low: Array, high: Array) -> object:
    """Return 0 on axes whose lower and upper ends are equal, and the right gap on the others."""
    return np.where(low == high, 0.0, right_clip_gap(p, low, high))


def mistake_size_alone(p: Array, low: Array, high: Array) -> object:
    """Return the absolute value of the right gap on each axis."""
    return np.abs(right_clip_gap(p, low, high))


def mistake_nearer_end(p: Array, low: Array, high: Array) -> object:
    """Return the vector to the nearer end of the box on each axis, also from inside."""
    is_low_nearer = np.abs(low - p) < np.abs(high - p)
    return np.where(is_low_nearer, low - p, high - p)


# ---- position_slope


def draw_position_slope(rng: np.random.Generator) -> Arguments:
    """Draw F places of a joint and of an end below it, an axis in its own frame, and how it is turned."""
    turn, _ = np.linalg.qr(rng.normal(size=(5, 3, 3)))
    axis = rng.normal(size=3)
    turn *= np.linalg.det(turn)[:, None, None]
    return *rng.normal(size=(2, 5, 3)), axis / np.linalg.norm(axis), turn


def right_position_slope(joint: Array, end: Array, axis: Array, turn: Array) -> Array:
    """Return the derivative of the end's position by the angle: axis × arm."""
    return np.cross(turn @ axis, end - joint)


def mistake_opposite_slope(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Return minus the derivative, arm × axis."""
    return -right_position_slope(joint, end, axis, turn)


def mistake_axis_not_turned(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Return axis × arm with the axis in the joint's frame and the arm in the world's."""
    return np.cross(axis, end - joint)


def mistake_axis_turned_backwards(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Return axis × arm with the axis rotated by the inverse (transposed) rotation."""
    return np.cross(turn.swapaxes(1, 2) @ axis, end - joint)


def mistake_from_origin(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Return axis × end, with the arm measured from the origin."""
    return np.cross(turn @ axis, end)


def mistake_product_turned(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Rotate the product of the axis in the joint's frame and the arm in the world's frame."""
    return (turn @ np.cross(axis, end - joint)[..., None])[..., 0]


def mistake_direction_alone(joint: Array, end: Array, axis: Array, turn: Array) -> object:
    """Return the derivative divided by its length."""
    correct = right_position_slope(joint, end, axis, turn)
    return correct / np.linalg.norm(correct, axis=1, keepdims=True)


# ---- local_fit


def draw_local_fit(rng: np.random.Generator) -> Arguments:
    """Draw the weights of N data on K splines, some of which no datum is near, and the data."""
    weights = np.zeros((6, 9))
    for row, first in enumerate(rng.integers(0, 4, 6)):
        weights[row, first : first + 4] = rng.dirichlet(np.ones(4))
    return weights, rng.normal(size=6)


def right_local_fit(weights: Array, data: Array) -> Array:
    """Fit control points: what each datum alone asks for, in the mean by the squares of the weights."""
    squares = (weights**2).sum(axis=1, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above = (weights**2 * alone).sum(axis=0)
    below = (weights**2).sum(axis=0)
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def mistake_weighted_by_w(weights: Array, data: Array) -> object:
    """Return Σ w β / Σ w, the mean of the single data's heights β weighted by w."""
    squares = (weights**2).sum(axis=1, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above = (weights * alone).sum(axis=0)
    below = weights.sum(axis=0)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def mistake_sum_over_data(weights: Array, data: Array) -> object:
    """Return Σ w² β / Σ w², with β = w d / Σ w² where this sum runs over the data, not the splines."""
    squares = (weights**2).sum(axis=0, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above = (weights**2 * alone).sum(axis=0)
    below = (weights**2).sum(axis=0)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def mistake_nan_without_data(weights: Array, data: Array) -> object:
    """Return NaN in place of 0 where no datum is near a control point."""
    return np.where(weights.any(axis=0), right_local_fit(weights, data), np.nan)


def mistake_mean_of_data(weights: Array, data: Array) -> object:
    """Return Σ w d / Σ w, the weighted mean of the data near each control point."""
    above = (weights * data[:, None]).sum(axis=0)
    below = weights.sum(axis=0)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def mistake_least_squares(weights: Array, data: Array) -> object:
    """Return the control points that fit all data at once by least squares, of minimum norm."""
    return np.linalg.lstsq(weights, data, rcond=None)[0]


def mistake_plain_mean(weights: Array, data: Array) -> object:
    """Return the mean of β = w d / Σ w² over all N data, those of weight 0 included."""
    return (weights * data[:, None] / (weights**2).sum(axis=1, keepdims=True)).mean(axis=0)
