"""Notebook 19: inputs, right answers and mistakes of `assign`, `lay_group` and `slots`."""

from functools import reduce

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Indices, Points
from mocap.course.checks.answers.common import Arguments


def greedy(a: Points, b: Points) -> Indices:
    """Assign the nearest pair first, then the nearest of the remaining members."""
    squares = abs(a[:, None] - b) ** 2
    order = np.zeros(len(a), int)
    for _ in a:
        i, j = divmod(int(squares.argmin()), len(b))
        order[i] = j
        squares[i] = np.inf
        squares[:, j] = np.inf
    return order


# ---- assign


def draw_assign(rng: np.random.Generator) -> Arguments:
    """Draw two groups of 8 to 12 people on the ground, as complex numbers."""
    return tuple(rng.normal(0, 1.5, (2, int(rng.integers(8, 13)), 2)) @ [1, 1j])


def right_assign(a: Points, b: Points) -> Indices:
    """Return the assignment with the least sum of squared distances."""
    return np.asarray(linear_sum_assignment(abs(a[:, None] - b) ** 2)[1])


def mistake_nearest_of_each(a: Points, b: Points) -> object:
    """Return the nearest member of b for each member of a; several may get the same one."""
    return np.argmin(abs(a[:, None] - b), axis=1)


def mistake_numbers_kept(a: Points, b: Points) -> object:
    """Return the identity: member n of a is member n of b."""
    return np.arange(len(a))


def mistake_from_b_to_a(a: Points, b: Points) -> object:
    """Return the inverse of the right assignment, from b to a."""
    return np.argsort(right_assign(a, b))


def mistake_greedy_pairs(a: Points, b: Points) -> object:
    """Return the greedy assignment: the nearest pair first, then the nearest of the others."""
    return greedy(a, b)


def mistake_sum_of_distances(a: Points, b: Points) -> object:
    """Return the assignment with the least sum of distances."""
    return linear_sum_assignment(abs(a[:, None] - b))[1]


def mistake_greatest_sum(a: Points, b: Points) -> object:
    """Return the assignment with the greatest sum of squared distances."""
    return linear_sum_assignment(abs(a[:, None] - b) ** 2, maximize=True)[1]


# ---- lay_group


def draw_lay_group(rng: np.random.Generator) -> Arguments:
    """Draw a group, and the same one rotated, translated and disturbed."""
    count = int(rng.integers(5, 10))
    turn = np.exp(1j * rng.uniform(-3, 3))
    about_origin = rng.normal(0, 1.5, (count, 2)) @ [1, 1j]
    pa = np.asarray(about_origin + complex(*rng.normal(0, 5, 2)), complex)
    va = np.asarray(1.1 + rng.normal(0, 0.3, (count, 2)) @ [1, 1j], complex)
    shaken = rng.normal(0, 0.5, (2, count, 2)) @ [1, 1j]
    move = complex(*rng.normal(0, 6, 2))
    return pa, va, (pa + shaken[0]) * turn + move, (va + shaken[1]) * turn


def right_lay_group(pa: Points, va: Points, pb: Points, vb: Points) -> tuple[complex, complex]:
    """Align one group with another, by positions and velocities."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_not_centred(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Find the rotation from the positions without subtracting the groups' means."""
    positions = (pa * pb.conj()).sum()
    cross = positions + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_rotated_backwards(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Return the inverse (conjugate) rotation, and the translation that belongs to it."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross)).conjugate()
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_no_velocities(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Find the rotation from the positions alone."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    turn = complex(positions / abs(positions))
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_weight_tau(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Find the rotation with velocities weighted by τ = 0.7 instead of τ² = 0.49."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + 0.7 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_weight_one(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Find the rotation with velocities weighted by 1."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - turn * pb.mean())


def mistake_mean_not_rotated(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Return the difference of the mean positions as the translation, without the rotation."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - pb.mean())


def mistake_velocities_centred(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Find the rotation with the mean velocity of each group subtracted."""
    return right_lay_group(pa, va - va.mean(), pb, vb - vb.mean())


def mistake_not_unit_length(pa: Points, va: Points, pb: Points, vb: Points) -> object:
    """Return the complex sum without dividing it by its length, and the translation that belongs to it."""
    positions = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum()
    cross = positions + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross)
    return turn, complex(pa.mean() - turn * pb.mean())


# ---- slots


def draw_slots(rng: np.random.Generator) -> Arguments:
    """Draw the order of the members at the end of each of 2 to 4 clips."""
    members = np.arange(int(rng.integers(5, 9)))
    orders = np.tile(members, (int(rng.integers(2, 5)), 1))
    return (rng.permuted(orders, axis=1),)


def right_slots(orders: Indices) -> Indices:
    """Return the orders applied one after the other."""
    return reduce(lambda slots, order: order[slots], orders)


def mistake_members_in_slots(orders: Indices) -> object:
    """Return the inverse permutation: the member in each slot after all clips."""
    return np.argsort(right_slots(orders))


def mistake_last_clip_first(orders: Indices) -> object:
    """Apply the orders from the last clip to the first."""
    return reduce(lambda slots, order: slots[order], orders)


def mistake_clips_backwards(orders: Indices) -> object:
    """Apply the inverse of each order, from the first clip to the last."""
    return reduce(lambda slots, order: order[slots], np.argsort(orders, axis=1))


def mistake_last_clip_alone(orders: Indices) -> object:
    """Return the order of the last clip."""
    return orders[-1]


def mistake_first_clip_alone(orders: Indices) -> object:
    """Return the order of the first clip."""
    return orders[0]


def mistake_not_moved(orders: Indices) -> object:
    """Return the identity: each member in its slot before the first clip."""
    return np.arange(orders.shape[1])
