"""Random input and answers, right and wrong, for `09-discussion.toml`."""

import numpy as np

from mocap._shared.arrays import Array


def draw_alive(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of a small graph in which some nodes have no successor."""
    size = int(rng.integers(4, 9))
    odds = rng.uniform(size=(size, size)) * (rng.uniform(size=(size, size)) < 0.5)
    odds[rng.integers(size)] = 0
    sums = odds.sum(axis=1, keepdims=True)
    return np.divide(odds, sums, out=np.zeros_like(odds), where=sums > 0), int(rng.integers(2, 12))


def draw_paired_gain(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw two measurements on the same paths, which differ less than the paths do."""
    before = rng.gamma(3.0, 2.0, int(rng.integers(5, 20)))
    return before, before * rng.uniform(0.7, 1.1) + rng.normal(0, 0.3, len(before))
