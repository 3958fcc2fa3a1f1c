"""Random input and answers, right and wrong, for `02b-distance-grids.toml`."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.matching.minima import local_minima


def diagonal_sums(products: Array, window: int) -> Array:
    """Add up products[i + f, j + f] over a window's frames, as far as a window fits."""
    rows, columns = (count - window + 1 for count in products.shape)
    return np.asarray(np.sum([products[f : f + rows, f : f + columns] for f in range(window)], axis=0))


def draw_later_by(rng: np.random.Generator) -> tuple[Array]:
    """Make what a clip against itself looks like: a symmetric grid with zeros on the diagonal."""
    places = rng.normal(size=(int(rng.integers(5, 10)), 3))
    return (((places[:, None] - places) ** 2).sum(-1),)


def along(grid: Array, average: Callable[[Array], Any] = np.mean) -> Array:
    return np.array([average(grid.diagonal(n)) for n in range(len(grid))])


def draw_inner_minima(rng: np.random.Generator) -> tuple[Array, float]:
    """Make a grid with minima inside and on the border, and a threshold that leaves some of them out."""
    grid = rng.uniform(0, 1, rng.integers(7, 12, 2))
    return grid, float(rng.uniform(0.2, 0.6))


def inside(grid: Array, found: NDArray[np.intp]) -> set[tuple[int, int]]:
    """Keep the places that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    return {(int(r), int(c)) for r, c in found[((found > 0) & (found < last)).all(axis=1)]}


def lowest_of_four(grid: Array, below: float) -> set[tuple[int, int]]:
    padded = np.pad(grid, 1, constant_values=np.inf)
    around = padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]
    return inside(grid, np.argwhere((grid < below) & (grid < np.min(around, axis=0))))


def same_places(given: Any, wanted: set[tuple[int, int]]) -> bool:  # noqa: ANN401
    """Compare places, which a student may list in any order and type."""
    found = list(given) if isinstance(given, set | frozenset | zip | map) else given
    return {tuple(map(int, place)) for place in np.reshape(np.asarray(found, float), (-1, 2))} == wanted
