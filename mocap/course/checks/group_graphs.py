"""Random input and answers, right and wrong, for `19-group-graphs.toml`."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Points


def squared_distances(a: Points, b: Points) -> Array:
    return np.abs(a[:, None] - b) ** 2


def assign(a: Points, b: Points) -> Indices:
    return np.asarray(linear_sum_assignment(squared_distances(a, b))[1])


def greedy(a: Points, b: Points) -> Indices:
    squares, order = squared_distances(a, b), np.zeros(len(a), int)
    for _ in a:
        i, j = divmod(int(squares.argmin()), len(b))
        order[i] = j
        squares[i], squares[:, j] = np.inf, np.inf
    return order


def in_turn(a: Points, b: Points) -> Indices:
    squares, order = squared_distances(a, b), np.zeros(len(a), int)
    for i in range(len(a)):
        order[i] = squares[i].argmin()
        squares[:, order[i]] = np.inf
    return order


def draw_assign(rng: np.random.Generator) -> tuple[Points, Points]:
    """Draw two groups that overlap, so that who is nearest to whom is often disputed."""
    a, b = rng.normal(0, 1.5, (2, int(rng.integers(8, 13)), 2)) @ [1, 1j]
    return a, b


def laid(pa: Points, va: Points, pb: Points, vb: Points) -> tuple[complex, complex]:
    cross = ((pa - pa.mean()) * (pb - pb.mean()).conj()).sum() + 0.49 * (va * vb.conj()).sum()
    turn = complex(cross / abs(cross))
    return turn, complex(pa.mean() - turn * pb.mean())


def draw_lay_group(rng: np.random.Generator) -> tuple[Points, Points, Points, Points]:
    """Draw a group, and the same one turned, moved and shaken."""
    count, turn = int(rng.integers(5, 10)), np.exp(1j * rng.uniform(-3, 3))
    pa = np.asarray(rng.normal(0, 1.5, (count, 2)) @ [1, 1j] + complex(*rng.normal(0, 5, 2)), complex)
    va = np.asarray(1.1 + rng.normal(0, 0.3, (count, 2)) @ [1, 1j], complex)
    shaken = rng.normal(0, 0.5, (2, count, 2)) @ [1, 1j]
    move = complex(*rng.normal(0, 6, 2))
    return pa, va, (pa + shaken[0]) * turn + move, (va + shaken[1]) * turn


def slots_after(orders: Indices) -> Indices:
    slots = np.arange(orders.shape[1])
    for order in orders:
        slots = order[slots]
    return slots


def draw_slots(rng: np.random.Generator) -> tuple[Indices]:
    members, clips = int(rng.integers(5, 9)), int(rng.integers(2, 5))
    return (np.array([rng.permutation(members) for _ in range(clips)]),)
