"""Random input and answers, right and wrong, for `05-motion-graph.toml`."""

import numpy as np

from mocap._shared.arrays import Array


def matches(rng: np.random.Generator) -> tuple[Array, float]:
    """Draw the distances of some matches, and the probability that the successor leaves them."""
    return rng.uniform(100, 400, rng.integers(1, 9)), float(rng.choice([0.5, 1.0]))


def draw_expected_seam(rng: np.random.Generator) -> tuple[Array, Array]:
    costs, left = matches(rng)
    odds = rng.uniform(0.1, 1, len(costs))
    return costs, left * odds / odds.sum()


def draw_chance_to_last(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of going from segment to segment, some without successor, and a length."""
    count = int(rng.integers(3, 9))
    odds = rng.random((count, count)) * (rng.random((count, count)) < 0.5)
    odds[rng.integers(count)] = 0
    return odds / np.maximum(odds.sum(axis=1, keepdims=True), 1e-9), int(rng.integers(2, 9))


def alive(probabilities: Array, steps: int) -> Array:
    """Give, for each start, the probability that this many steps can be taken."""
    return np.asarray(np.linalg.matrix_power(probabilities, steps).sum(axis=1))
