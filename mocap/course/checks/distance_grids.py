"""Checks of notebook 02b."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake
from mocap.matching.minima import local_minima


def _sums(products: Array, window: int, *, step: int = 1) -> Array:
    """Add up products[i + f, j + step f] over a window's frames, as far as a window fits."""
    rows, columns = (count - window + 1 for count in products.shape)
    first = 0 if step >= 0 else window - 1
    each = [products[f : f + rows, first + step * f : first + step * f + columns] for f in range(window)]
    return np.asarray(np.sum(each, axis=0))


window_sums = Check(
    name="window_sums",
    asks="the sums of products[i + f, j + f] over the frames f of a window",
    start="shift the whole array by f rows and f columns, and add up. How many windows fit?",
    draw=lambda rng: (rng.normal(size=rng.integers(7, 12, 2)), int(rng.integers(2, 5))),
    truth=_sums,
    mistakes=[
        Mistake(
            lambda products, window: _sums(products, window - 1),
            "off by one: a window has the frames f = 0 to window - 1, and fits F - window + 1 times.",
        ),
        Mistake(
            lambda products, window: _sums(products, window + 1),
            "your windows are one frame too long: f runs from 0 to window - 1.",
        ),
        Mistake(
            lambda products, window: _sums(products, window)[:-1, :-1],
            "the last window is missing: F frames have F - window + 1 windows.",
        ),
        Mistake(
            lambda products, window: _sums(products, window, step=0),
            "that goes down the columns; both frames advance together, along the diagonal.",
        ),
        Mistake(
            lambda products, window: _sums(products, window, step=-1),
            "that is the other diagonal: one clip would run backwards.",
        ),
        Mistake(
            lambda products, window: _sums(products, window) / window, "that is the mean; a sum is asked for."
        ),
    ],
)


def _symmetric(rng: np.random.Generator) -> tuple[Array]:
    """Make what a clip against itself looks like: a symmetric grid with zeros on the diagonal."""
    places = rng.normal(size=(int(rng.integers(5, 10)), 3))
    return (((places[:, None] - places) ** 2).sum(-1),)


def _along(grid: Array, average: Callable[[Array], Any] = np.mean) -> Array:
    return np.array([average(grid.diagonal(n)) for n in range(len(grid))])


later_by = Check(
    name="later_by",
    asks="the mean of each diagonal: entry n averages grid[i, i + n] over all i",
    start="which entries of the grid have a column that is n more than their row? See `np.diagonal`.",
    draw=_symmetric,
    truth=_along,
    mistakes=[
        Mistake(lambda grid: _along(grid, np.sum), "these are sums; divide by the length of each diagonal."),
        Mistake(
            lambda grid: _along(grid, np.sum) / len(grid),
            "the diagonals become shorter: divide by the length of each, len(grid) - n.",
        ),
        Mistake(
            lambda grid: _along(grid, lambda part: np.sqrt(part).mean()),
            "average the costs themselves; the root is taken later.",
        ),
        Mistake(
            lambda grid: np.array([np.diagonal(np.roll(grid, -n, axis=1)).mean() for n in range(len(grid))]),
            "your diagonals run off the grid and come in again on the other side: stop at the border.",
        ),
        Mistake(
            lambda grid: grid.mean(axis=0),
            "that averages columns; all pairs that are n frames apart lie on a diagonal.",
        ),
        Mistake(lambda grid: grid[0], "that is the first window only; average over all windows."),
        Mistake(lambda grid: _along(grid)[1:], "begin with n = 0, each window with itself."),
    ],
)


def _grid(rng: np.random.Generator) -> tuple[Array, float]:
    """Make a grid with minima inside and on the border, and a threshold that leaves some of them out."""
    grid = rng.uniform(0, 1, rng.integers(7, 12, 2))
    return grid, float(rng.uniform(0.2, 0.6))


def _inside(grid: Array, found: NDArray[np.intp]) -> set[tuple[int, int]]:
    """Keep the places that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    return {(int(r), int(c)) for r, c in found[((found > 0) & (found < last)).all(axis=1)]}


def _lowest_of_four(grid: Array, below: float) -> set[tuple[int, int]]:
    padded = np.pad(grid, 1, constant_values=np.inf)
    around = padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]
    return _inside(grid, np.argwhere((grid < below) & (grid < np.min(around, axis=0))))


def _places(found: object) -> set[tuple[int, ...]]:
    """Take what a student lists, in any order and type, as a set of places."""
    return {tuple(map(int, place)) for place in np.reshape(np.asarray(found, float), (-1, 2))}


def _same_places(given: object, wanted: object) -> bool:
    found = list(given) if isinstance(given, (set, frozenset, zip, map)) else given
    return _places(found) == wanted


inner_minima = Check(
    name="inner_minima",
    asks="the (row, column) of each entry under the threshold that is lower than its eight neighbours",
    start="leave out the first and the last row and column; compare with the 3 × 3 entries around.",
    draw=_grid,
    truth=lambda grid, below: _inside(grid, local_minima(grid, below)),
    mistakes=[
        Mistake(
            lambda grid, below: {tuple(map(int, place)) for place in local_minima(grid, below)},
            "minima on the border do not count here: some of their neighbours are missing.",
        ),
        Mistake(
            _lowest_of_four,
            "you looked at four neighbours; the four across a corner count as well.",
        ),
        Mistake(
            lambda grid, below: _inside(grid, local_minima(grid)),
            "all of them are minima, but some are above the threshold.",
        ),
        Mistake(
            lambda grid, below: _inside(grid, np.argwhere(grid < below)),
            "these are all entries under the threshold; which of them are lower than their neighbours?",
        ),
        Mistake(
            lambda grid, below: _inside(grid, local_minima(grid, below**2)),
            "do not square the threshold: it is in the grid's own unit.",
        ),
        Mistake(
            lambda grid, below: {(c, r) for r, c in _inside(grid, local_minima(grid, below))},
            "the order is wrong: the row first, then the column.",
        ),
        Mistake(
            lambda grid, below: _inside(grid, local_minima(-grid)),
            "these are maxima: entries that are higher than their neighbours.",
        ),
    ],
    same=_same_places,
)
