"""Checks of notebook 16."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Mask
from mocap.course.check import Check, Mistake

Grid = NDArray[np.int64]
Pairs = list[tuple[float, int]]


def _along_rows(grid: Grid, *, strict: bool = False) -> Mask:
    """Mark what is no higher than both neighbours in its row; with `strict`, what is lower."""
    wide = np.pad(grid.astype(float), ((0, 0), (1, 1)), constant_values=np.inf)
    lower = np.less if strict else np.less_equal
    return np.asarray(lower(grid, wide[:, :-2]) & lower(grid, wide[:, 2:]))


def _either(grid: Grid, *, strict: bool = False) -> Mask:
    return np.asarray(_along_rows(grid, strict=strict) | _along_rows(grid.T, strict=strict).T)


def _all_eight(grid: Grid) -> Mask:
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    rows, columns = grid.shape
    around = [wide[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.asarray(grid <= np.min(around, axis=0))


is_minimum = Check(
    name="is_minimum",
    asks="booleans: True where a cell is no higher than both neighbours in its row, or both in its column",
    start="pad the grid with np.inf on all sides, and compare it with its four shifted copies.",
    draw=lambda rng: (rng.integers(0, 6, (7, 9)),),
    truth=_either,
    mistakes=[
        Mistake(
            lambda grid: _along_rows(grid) & _along_rows(grid.T).T,
            "that asks for a minimum along the row *and* along the column; one of them is enough.",
        ),
        Mistake(
            lambda grid: _either(grid, strict=True),
            "on a level floor no cell is lower than its neighbour: 'no higher' is <=, not <.",
        ),
        Mistake(
            _along_rows, "that looks along the rows only; a steep valley has its minima along the columns."
        ),
        Mistake(
            lambda grid: _along_rows(grid.T).T,
            "that looks along the columns only; a flat valley has its minima along the rows.",
        ),
        Mistake(_all_eight, "that compares with all eight neighbours: of a valley it leaves a few points."),
    ],
)

MOST = 400  # calls of `matches_of`, far more than a right answer needs


class _Matches:
    """What is like what: motions in clusters ten frames apart, some linked; found a little off each time."""

    def __init__(self, links: dict[int, list[tuple[float, int, int]]]) -> None:
        self.links, self.calls = links, 0

    def __call__(self, match: int) -> Pairs:
        self.calls += 1
        if self.calls > MOST:
            raise RecursionError(
                f"it has asked {MOST} times and does not end: what is found again, at nearly the same "
                "frames, is not new"
            )
        return [(cost, 10 * other + off) for cost, other, off in self.links[(match + 5) // 10]]


def _same(first: int, second: int) -> bool:
    return abs(first - second) <= 4


def _draw_links(rng: np.random.Generator) -> tuple[int, _Matches, Callable[[int, int], bool]]:
    """Link eight motions in a chain, and some of them across, both ways."""
    links: dict[int, list[tuple[float, int, int]]] = {number: [] for number in range(10)}
    order = rng.permutation(8).tolist()
    chain = list(pairwise(order))
    for one, other in [*chain, *((chain[n][0], chain[n + 2][1]) for n in range(0, 5, 2))]:
        for here, there in ((one, other), (other, one)):
            for _ in range(2):
                cost = round(float(rng.uniform(1, 5)), 3)
                links[here].append((cost, there, int(rng.integers(-2, 3))))
    return 10 * order[0], _Matches(links), _same


def _spread(  # noqa: PLR0913 (each mistake changes one of them)
    query: int,
    matches_of: Callable[[int], Pairs],
    same: Callable[[int, int], bool],
    *,
    steps: int = 99,
    order: int = 1,
    query_is_found: bool = True,
) -> list[int]:
    found, asking = [query], [query]
    for _ in range(steps):
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda p: order * p[0])
        asking = []
        for _cost, match in new:
            known = found if query_is_found else found[1:]
            if not any(same(match, other) for other in known):
                found.append(match)
                asking.append(match)
    return found


spread = Check(
    name="spread",
    asks="a list: the query, then step by step what is new, in each step the nearest first",
    start="keep two lists: all that was found, and what was new in the last step. What is like those?",
    draw=_draw_links,
    truth=_spread,
    same=lambda given, wanted: list(given) == list(wanted),
    mistakes=[
        Mistake(
            lambda query, matches_of, same: _spread(query, matches_of, same, steps=1),
            "that is one step: what was found is a query, too.",
        ),
        Mistake(
            lambda query, matches_of, same: _spread(query, matches_of, same)[1:],
            "the query itself belongs to the list, as its first item.",
        ),
        Mistake(
            lambda query, matches_of, same: _spread(query, matches_of, same, query_is_found=False),
            "the query is in the list twice: what is found from its matches may be the query again.",
        ),
        Mistake(
            lambda query, matches_of, same: _spread(query, matches_of, same, order=-1),
            "of two that are the same, the farther one was kept: go through each step from the nearest on.",
        ),
    ],
)


def _shares(distances: Array, raw: Callable[[Array], Array], *, hit: bool = True) -> Array:
    """Divide raw weights by their sum; with `hit`, a sample that is hit gets all."""
    if hit and distances[0] == 0:
        return np.asarray(np.eye(len(distances))[0])
    with np.errstate(all="ignore"):
        weights = raw(distances)
        return np.asarray(weights / weights.sum())


def _draw_distances(rng: np.random.Generator) -> tuple[Array]:
    distances = np.sort(rng.uniform(0.1, 5, rng.integers(3, 7)))
    if rng.random() < 0.3:
        distances[0] = 0
    return (distances,)


def _undivided(distances: Array, *, hit: bool) -> Array:
    if hit and distances[0] == 0:
        return np.asarray(np.eye(len(distances))[0])
    with np.errstate(all="ignore"):
        return np.asarray(1 / distances - 1 / distances[-1])


neighbour_weights = Check(
    name="neighbour_weights",
    asks="weights that grow like 1 / d, are 0 for the last sample, and add up to one; a hit (d = 0) gets all",
    start="subtract from 1 / distances what makes the last one 0. And what if distances[0] is 0?",
    draw=_draw_distances,
    truth=lambda distances: _shares(distances, lambda d: 1 / d - 1 / d[-1]),
    same=lambda given, wanted: (
        np.shape(given) == np.shape(wanted) and np.allclose(given, wanted, equal_nan=True)
    ),
    mistakes=[
        Mistake(
            lambda distances: _shares(distances, lambda d: 1 / d - 1 / d[-1], hit=False),
            "right, but for a sample that is hit: 1 / 0 is infinite, and the weights are NaN. Give it all.",
        ),
        *(
            Mistake(
                lambda distances, hit=hit: _shares(distances, lambda d: 1 / d, hit=hit),
                "that is 1 / d: the last sample still counts, so the weights jump when it changes. "
                "Subtract 1 / d_k.",
            )
            for hit in (True, False)
        ),
        *(
            Mistake(
                lambda distances, hit=hit: _shares(distances, lambda d: 1 / d**2, hit=hit),
                "that is 1 / d²: the last sample still counts, and near a sample the blend hardly moves.",
            )
            for hit in (True, False)
        ),
        *(
            Mistake(
                lambda distances, hit=hit: _undivided(distances, hit=hit),
                "the weights do not add up to one: divide them by their sum.",
            )
            for hit in (True, False)
        ),
        *(
            Mistake(
                lambda distances, hit=hit: _shares(distances, lambda d: d[-1] - d, hit=hit),
                "that is d_k - d: near a sample it must count more and more, as 1 / d does.",
            )
            for hit in (True, False)
        ),
    ],
)
