"""Random input and answers, right and wrong, for `14-levels.toml`."""

import numpy as np

from mocap._shared.arrays import Array


def draw_clip_gap(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw places (N, 3), and boxes of every kind around, above and below them: held, free, half open."""
    places = rng.normal(size=(8, 3))
    low = places + rng.choice([-1.0, 1.0], (8, 3)) * rng.uniform(0.1, 1, (8, 3))
    high = low + rng.choice([0.0, 0.05], (8, 3))
    kind = rng.integers(0, 4, (8, 3))
    kind[0] = [1, 2, 3]  # each kind at least once
    low = np.where((kind == 1) | (kind == 3), -np.inf, low)
    high = np.where((kind == 2) | (kind == 3), np.inf, high)
    return places, low, high


def to_the_middle(p: Array, low: Array, high: Array) -> Array:
    both = np.isfinite(low) & np.isfinite(high)
    return np.where(both, (np.where(both, low, 0) + np.where(both, high, 0)) / 2 - p, 0.0)


def draw_position_slope(rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """Draw a joint, an end below it, an axis in the joint's own frame, and how the joint is turned."""
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    axis = rng.normal(size=3)
    return rng.normal(size=3), rng.normal(size=3), axis / np.linalg.norm(axis), turn * np.linalg.det(turn)


def draw_local_fit(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the weights of N data on K splines, some of which no datum is near, and the data."""
    weights = np.zeros((6, 9))
    for row, first in enumerate(rng.integers(0, 4, 6)):
        weights[row, first : first + 4] = rng.dirichlet(np.ones(4))
    return weights, rng.normal(size=6)


def fit(weights: Array, data: Array) -> Array:
    """Fit control points: what each datum alone asks for, in the mean by the squares of the weights."""
    squares = (weights**2).sum(axis=1, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above, below = (weights**2 * alone).sum(axis=0), (weights**2).sum(axis=0)
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def same(given: Array, wanted: Array) -> bool:
    """Check whether control points are the same; numbers that are none are the same only as themselves."""
    given, wanted = np.asarray(given, float), np.asarray(wanted, float)
    return given.shape == wanted.shape and np.allclose(given, wanted, rtol=1e-8, atol=1e-9, equal_nan=True)
