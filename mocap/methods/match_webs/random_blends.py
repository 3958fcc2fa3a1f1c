"""Weights of random blends, even over what the examples allow, and no farther outside than asked."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.distance import cdist

from mocap._shared.arrays import Array
from mocap.errors import MocapError


def random_weights(
    values: ArrayLike, count: int, *, spread: float = 0.1, near: int | None = None, seed: int = 0
) -> Array:
    """Draw the weights of random blends of d + 1 examples each, for a measure of d numbers.

    In the paper: [KG04, accessible region].

    One example is drawn at random, and d of those nearest to it. Their weights are even on the simplex, which
    is then stretched about its middle: w = (1 + (d + 1) δ) Dirichlet(1, …, 1) - δ. So they add up to one, and
    none is below -δ; a draw with one above 1 + δ is drawn again [KG04 samples so too, as far as recalled; the
    stretch is ours]. Even numbers divided by their sum would crowd in the middle, and weights cut off at
    -δ … 1 + δ would not add up to one.

    Parameters
    ----------
    values : shape (C, d), the measure of each example.
    count : of blends.
    spread : δ, not negative.
    near : from how many of the nearest examples the others are drawn, d or more; from all by default.
    seed : another one gives other blends.

    Returns
    -------
    Shape (count, C), rows that add up to one, each weight in [-δ, 1 + δ].

    Raises
    ------
    MocapError : for fewer than d + 1 examples, values that are not finite, and a spread below 0.

    Examples
    --------
    >>> weights = random_weights([[0.8], [1.1], [1.4]], 100, spread=0.1)
    >>> weights.shape, bool(np.allclose(weights.sum(axis=1), 1)), int((weights != 0).sum(axis=1).max())
    ((100, 3), True, 2)

    Notebook: 16-match-webs
    """
    measured = np.asarray(values, float)
    if measured.ndim != 2 or not np.isfinite(measured).all():
        raise MocapError(f"Examples need finite values of shape (C, d), got shape {measured.shape}.")
    examples, numbers = measured.shape
    if examples < numbers + 1:
        raise MocapError(f"A measure of {numbers} numbers needs {numbers + 1} examples, got {examples}.")
    if not 0 <= spread < np.inf:
        raise MocapError(f"Weights spread by 0 or more beyond 0 and 1, got {spread}.")
    rng = np.random.default_rng(seed)
    width = measured.std(axis=0)
    scaled = measured / np.where(width > 0, width, 1)
    ranked = cdist(scaled, scaled).argsort(axis=1, kind="stable")
    weights = np.zeros((count, examples))
    for row in weights:
        first = rng.integers(examples)
        others = ranked[first][ranked[first] != first][:near]
        chosen = np.append(first, rng.choice(others, numbers, replace=False))
        while row.max() > 1 + spread or not row.any():
            row[chosen] = (1 + len(chosen) * spread) * rng.dirichlet(np.ones(len(chosen))) - spread
    return weights
