"""Notebook 02c: answers and mistakes of `turn_free`, `worth_a_look` and `bounds_by_direction`."""

import numpy as np
from scipy.spatial.distance import pdist, squareform

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.checks.answers.common import Arguments

# ---- turn_free


def draw_turn_free(rng: np.random.Generator) -> Arguments:
    """Draw frames of points at a random place on the ground, facing in a random direction."""
    transform = PlanarTransform(*rng.uniform(-3, 3, 3))
    points = rng.normal(size=(*rng.integers(3, 7, 2), 3)) * [0.5, 0.5, 1.0] + [0, 1.5, 0]
    return (transform.apply_points(points),)


def right_turn_free(points: Array) -> Array:
    """Join heights and distances from the window's middle, over the root of the number of points."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.asarray(np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size))


def mistake_from_origin(points: Array) -> object:
    """Join heights and horizontal distances from the origin, not from the window's middle."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground, axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size)


def mistake_middle_of_each_frame(points: Array) -> object:
    """Join heights and distances, in each frame, from the middle of this frame."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=1, keepdims=True), axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size)


def mistake_no_weight(points: Array) -> object:
    """Join heights and distances from the window's middle, without a weight."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel()])


def mistake_weight_of_squares(points: Array) -> object:
    """Join heights and distances from the window's middle, over the number of points, not its root."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel()]) / heights.size


def mistake_squared_radii(points: Array) -> object:
    """Join heights and squared distances from the window's middle."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel() ** 2]) / np.sqrt(heights.size)


def mistake_coordinates_for_radii(points: Array) -> object:
    """Join heights and the coordinates x and z relative to the window's middle."""
    heights = points[..., 1]
    ground = points[..., [0, 2]]
    radii = ground - ground.mean(axis=(0, 1))
    return np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size)


def mistake_radii_with_height(points: Array) -> object:
    """Join heights and distances in space from the centroid of the window, height included."""
    heights = points[..., 1]
    ground = points
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size)


# ---- worth_a_look


def draw_worth_a_look(rng: np.random.Generator) -> Arguments:
    """Draw rows of numbers, and a distance within which about half of their pairs lie."""
    rows = rng.normal(size=(int(rng.integers(7, 12)), 4))
    return rows, float(np.quantile(pdist(rows), rng.uniform(0.3, 0.6)))


def right_worth_a_look(rows: Array, reach: float) -> set[tuple[int, ...]]:
    """Return the pairs of rows that are within the distance of each other."""
    is_near = squareform(pdist(rows)) <= reach
    return {*map(tuple, np.argwhere(np.triu(is_near, 1)))}


def mistake_pairs_twice(rows: Array, reach: float) -> object:
    """Return the pairs of different rows within the distance, in both orders."""
    is_near = squareform(pdist(rows)) <= reach
    return {*map(tuple, np.argwhere(is_near & ~np.eye(len(rows), dtype=bool)))}


def mistake_pairs_with_itself(rows: Array, reach: float) -> object:
    """Return the pairs within the distance, and each row paired with itself."""
    is_near = squareform(pdist(rows)) <= reach
    return {*map(tuple, np.argwhere(np.triu(is_near)))}


def mistake_too_far(rows: Array, reach: float) -> object:
    """Return the pairs of rows beyond the distance."""
    is_near = squareform(pdist(rows)) > reach
    return {*map(tuple, np.argwhere(np.triu(is_near, 1)))}


def mistake_root_of_reach(rows: Array, reach: float) -> object:
    """Return the pairs whose squared distance is at most `reach`."""
    is_near = squareform(pdist(rows)) <= np.sqrt(reach)
    return {*map(tuple, np.argwhere(np.triu(is_near, 1)))}


def mistake_city_block(rows: Array, reach: float) -> object:
    """Return the pairs whose city-block distance, Σ |x_i - y_i|, is at most `reach`."""
    is_near = squareform(pdist(rows, "cityblock")) <= reach
    return {*map(tuple, np.argwhere(np.triu(is_near, 1)))}


# ---- bounds_by_direction


def draw_bounds_by_direction(rng: np.random.Generator) -> Arguments:
    """Draw a vector, and one orthonormal direction fewer than it has components."""
    size = int(rng.integers(5, 9))
    difference = rng.normal(size=size)
    axes, _ = np.linalg.qr(rng.normal(size=(size, size)))
    return difference, axes[:, : size - 1]


def right_bounds_by_direction(difference: Array, axes: Array) -> Array:
    """Return the lengths of the projections on more and more of the directions."""
    return np.sqrt(np.cumsum((difference @ axes) ** 2))


def mistake_sums_of_lengths(difference: Array, axes: Array) -> object:
    """Return the cumulative sums of the absolute components, Σ |c_i|."""
    return np.cumsum(np.abs(difference @ axes))


def mistake_squares_of_lengths(difference: Array, axes: Array) -> object:
    """Return the squared lengths of the projections, Σ c_i² over more and more directions."""
    return np.cumsum((difference @ axes) ** 2)


def mistake_single_components(difference: Array, axes: Array) -> object:
    """Return the absolute component |c_i| along each direction."""
    return np.abs(difference @ axes)


def mistake_last_direction_first(difference: Array, axes: Array) -> object:
    """Return the lengths of the projections on the last direction, on the last two, and so on."""
    return np.sqrt(np.cumsum((difference @ axes[:, ::-1]) ** 2))


def mistake_not_projected(difference: Array, axes: Array) -> object:
    """Return the lengths of the vector cut to its first coordinate, to its first two, and so on."""
    return np.sqrt(np.cumsum(difference[: axes.shape[1]] ** 2))


def mistake_all_directions(difference: Array, axes: Array) -> object:
    """Return one number, the length of the projection on all directions."""
    return np.linalg.norm(difference @ axes)
