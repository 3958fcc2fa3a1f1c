"""Random input and answers, right and wrong, for `12-path-editing.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Mask


def steps(points: Array) -> Array:
    return np.asarray(np.linalg.norm(np.diff(points, axis=0), axis=1))


def as_complex(rows: Array) -> Array:
    return np.asarray(rows[:, -1] + 1j * rows[:, -2])


def pairs(ground: Array) -> Array:
    return np.stack([ground.imag, ground.real], axis=1)


def carry(points: Array, old: Array, new: Array) -> Array:
    """Carry points from cart to cart."""
    on_cart = np.exp(-1j * old[:, 0]) * (as_complex(points) - as_complex(old))
    return pairs(np.exp(1j * new[:, 0]) * on_cart + as_complex(new))


def draw_carry(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    count = int(rng.integers(3, 9))
    carts = [rng.normal(size=(count, 3)) * [1.0, 2.0, 2.0] for _ in range(2)]
    return rng.normal(size=(count, 2)), carts[0], carts[1]


def draw_plant_place(rng: np.random.Generator) -> tuple[Array, Mask]:
    count, start = int(rng.integers(12, 24)), int(rng.integers(2, 5))
    planted = (np.arange(count) >= start) & (np.arange(count) < start + rng.integers(4, 7))
    positions = rng.normal(size=(count, 3)).cumsum(axis=0) * 0.02
    return positions + [0.0, 0.1, 0.0] * ~planted[:, None], planted
