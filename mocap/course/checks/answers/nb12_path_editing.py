"""Notebook 12: inputs, right answers and mistakes of `arc_length`, `carry` and `plant_place`."""

import numpy as np

from mocap._shared.arrays import Array, Mask, Points
from mocap.course.checks.answers.common import Arguments

# ---- arc_length


def draw_arc_length(rng: np.random.Generator) -> Arguments:
    """Draw a line of 4 to 11 points on the ground."""
    return (rng.normal(size=(rng.integers(4, 12), 2)).cumsum(axis=0),)


def right_arc_length(points: Array) -> Array:
    """Return the length of the line up to each of its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def mistake_start_missing(points: Array) -> object:
    """Return the arc lengths of all points except the first, shape (N - 1,)."""
    return right_arc_length(points)[1:]


def mistake_squared_steps(points: Array) -> object:
    """Return the cumulative sums of the squared steps."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T) ** 2)])


def mistake_city_block(points: Array) -> object:
    """Return the cumulative sums of |Δx| + |Δz|."""
    return np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points, axis=0)).sum(axis=1))])


def mistake_straight_from_start(points: Array) -> object:
    """Return the straight-line distance of each point from the first."""
    return np.linalg.norm(points - points[0], axis=1)


def mistake_single_steps(points: Array) -> object:
    """Return 0 and the length of each step, without adding them up."""
    return np.concatenate([[0.0], np.asarray(np.hypot(*np.diff(points, axis=0).T))])


def mistake_fractions(points: Array) -> object:
    """Return the arc lengths divided by the length of the whole line."""
    correct = right_arc_length(points)
    return correct / correct[-1]


# ---- carry


def draw_carry(rng: np.random.Generator) -> Arguments:
    """Draw points on the ground, and for each a cart (angle, x, z) on the old and on the new path."""
    count = int(rng.integers(3, 9))
    return rng.normal(size=(count, 2)), *rng.normal(size=(2, count, 3)) * [1.0, 2.0, 2.0]


def on_old_carts(points: Array, old: Array) -> Points:
    """Transform points into the coordinates of their carts on the old path, as complex numbers z + ix."""
    from_carts = points @ [1j, 1] - old @ [0, 1j, 1]
    return np.asarray(np.exp(-1j * old[:, 0]) * from_carts)


def right_carry(points: Array, old: Array, new: Array) -> Array:
    """Carry points from cart to cart, as complex numbers z + ix."""
    on_cart = on_old_carts(points, old)
    ground = np.exp(1j * new[:, 0]) * on_cart + new @ [0, 1j, 1]
    return np.stack([ground.imag, ground.real], axis=1)


def mistake_opposite_turns(points: Array, old: Array, new: Array) -> object:
    """Carry the points with the headings of both carts negated."""
    return right_carry(points, old * [-1, 1, 1], new * [-1, 1, 1])


def mistake_new_cart_first(points: Array, old: Array, new: Array) -> object:
    """Apply the new cart's transform first, then the inverse of the old cart's."""
    ground = np.exp(1j * new[:, 0]) * (points @ [1j, 1]) + new @ [0, 1j, 1]
    on_cart = np.exp(-1j * old[:, 0]) * (ground - old @ [0, 1j, 1])
    return np.stack([on_cart.imag, on_cart.real], axis=1)


def mistake_carts_not_turned(points: Array, old: Array, new: Array) -> object:
    """Translate each point by the new cart's position minus the old one's, without rotation."""
    return points + new[:, 1:] - old[:, 1:]


def mistake_about_the_origin(points: Array, old: Array, new: Array) -> object:
    """Rotate the points about the origin, then translate by the difference of the carts' positions."""
    on_cart = np.exp(-1j * old[:, 0]) * (points @ [1j, 1])
    ground = np.exp(1j * new[:, 0]) * on_cart + (new - old) @ [0, 1j, 1]
    return np.stack([ground.imag, ground.real], axis=1)


def mistake_new_to_old(points: Array, old: Array, new: Array) -> object:
    """Carry the points from the new carts to the old ones."""
    return right_carry(points, new, old)


def mistake_first_old_cart(points: Array, old: Array, new: Array) -> object:
    """Carry all points from the old cart of the first frame."""
    return right_carry(points, old[:1].repeat(len(old), 0), new)


def mistake_on_the_cart(points: Array, old: Array, new: Array) -> object:
    """Return the points in the coordinates of the old cart."""
    ground = on_old_carts(points, old)
    return np.stack([ground.imag, ground.real], axis=1)


def mistake_z_first(points: Array, old: Array, new: Array) -> object:
    """Return the right points as (z, x)."""
    return right_carry(points, old, new)[:, ::-1]


# ---- plant_place


def draw_plant_place(rng: np.random.Generator) -> Arguments:
    """Draw places of a joint that rises and falls by 10 cm, and the frames in which it stands."""
    count = int(rng.integers(12, 24))
    start = int(rng.integers(2, 5))
    frames = np.arange(count)
    planted = (frames >= start) & (frames < start + rng.integers(4, 7))
    positions = rng.normal(size=(count, 3)).cumsum(axis=0) * 0.02
    positions[:, 1] += np.where(planted, 0.0, 0.1)
    return positions, planted


def right_plant_place(positions: Array, planted: Mask) -> Array:
    """Return the mean position of the planted frames."""
    return np.asarray(positions[planted].mean(axis=0))


def mistake_all_frames(positions: Array, planted: Mask) -> object:
    """Return the mean position over all frames."""
    return positions.mean(axis=0)


def mistake_first_frame(positions: Array, planted: Mask) -> object:
    """Return the position in the first planted frame."""
    return positions[planted][0]


def mistake_last_frame(positions: Array, planted: Mask) -> object:
    """Return the position in the last planted frame."""
    return positions[planted][-1]


def mistake_middle_frame(positions: Array, planted: Mask) -> object:
    """Return the position in the middle one of the planted frames."""
    return positions[planted][planted.sum() // 2]


def mistake_median(positions: Array, planted: Mask) -> object:
    """Return the median of the planted positions, axis by axis."""
    return np.median(positions[planted], axis=0)


def mistake_height_dropped(positions: Array, planted: Mask) -> object:
    """Return the mean position of the planted frames with height 0."""
    return np.array([1.0, 0.0, 1.0]) * right_plant_place(positions, planted)


def mistake_height_of_all_frames(positions: Array, planted: Mask) -> object:
    """Return x and z of the planted frames' mean with the mean height of all frames."""
    return right_plant_place(positions, planted) * [1, 0, 1] + positions.mean(axis=0) * [0, 1, 0]
