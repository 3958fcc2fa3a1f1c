"""Random input and answers, right and wrong, for `02c-most-pairs.toml`."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform


def draw_turn_free(rng: np.random.Generator) -> tuple[Array]:
    """Make a window of random points, turned and moved at random."""
    points = rng.normal(size=(*rng.integers(3, 7, 2), 3)) * [0.5, 0.5, 1.0] + [0, 1.5, 0]
    return (PlanarTransform(*rng.uniform(-3, 3, 3)).apply_points(points),)


def joined_numbers(points: Array) -> Array:
    """Join heights and distances from the window's middle, over the root of the number of points."""
    heights, ground = points[..., 1], points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.asarray(np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size))


def draw_worth_a_look(rng: np.random.Generator) -> tuple[Array, float]:
    """Make rows of numbers and a reach that leaves some pairs."""
    rows = rng.normal(size=(int(rng.integers(7, 12)), 4))
    apart = np.linalg.norm(rows[:, None] - rows, axis=-1)
    return rows, float(np.quantile(apart[np.triu_indices(len(rows), 1)], rng.uniform(0.3, 0.6)))


def pairs(near: NDArray[np.bool_]) -> set[tuple[int, int]]:
    return {(int(i), int(j)) for i, j in np.argwhere(near)}


def within_reach(rows: Array, reach: float) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(rows[:, None] - rows, axis=-1) <= reach)


def same_pairs(given: Any, wanted: set[tuple[int, int]]) -> bool:  # noqa: ANN401
    found = np.reshape(np.asarray([tuple(pair) for pair in given], float), (-1, 2))
    return {(int(i), int(j)) for i, j in found} == wanted


def draw_bounds_by_direction(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a difference of two rows and some orthonormal directions."""
    size = int(rng.integers(5, 9))
    axes, _ = np.linalg.qr(rng.normal(size=(size, size)))
    return rng.normal(size=size), axes[:, : size - 1]
