"""Random input and answers, right and wrong, for `16-match-webs.toml`."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Mask

Grid = NDArray[np.int64]
Pairs = list[tuple[float, int]]


def along_rows(grid: Grid, *, strict: bool = False) -> Mask:
    """Mark what is no higher than both neighbours in its row; with `strict`, what is lower."""
    wide = np.pad(grid.astype(float), ((0, 0), (1, 1)), constant_values=np.inf)
    lower = np.less if strict else np.less_equal
    return np.asarray(lower(grid, wide[:, :-2]) & lower(grid, wide[:, 2:]))


def either(grid: Grid, *, strict: bool = False) -> Mask:
    return np.asarray(along_rows(grid, strict=strict) | along_rows(grid.T, strict=strict).T)


def all_eight(grid: Grid) -> Mask:
    wide = np.pad(grid.astype(float), 1, constant_values=np.inf)
    rows, columns = grid.shape
    around = [wide[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.asarray(grid <= np.min(around, axis=0))


MOST = 400  # calls of `matches_of`, far more than a right answer needs


class Matches:
    """What is like what: motions in clusters ten frames apart, some linked; found a little off each time."""

    def __init__(self, links: dict[int, list[tuple[float, int, int]]]) -> None:
        self.links, self.calls = links, 0

    def __call__(self, match: int) -> Pairs:
        """Give what is like a match, as pairs (cost, match)."""
        self.calls += 1
        if self.calls > MOST:
            raise RecursionError(
                f"it has asked {MOST} times and does not end: what is found again, at nearly the same "
                "frames, is not new"
            )
        return [(cost, 10 * other + off) for cost, other, off in self.links[(match + 5) // 10]]


def same_frame(first: int, second: int) -> bool:
    return abs(first - second) <= 4


def draw_spread(rng: np.random.Generator) -> tuple[int, Matches, Callable[[int, int], bool]]:
    """Link eight motions in a chain, and some of them across, both ways."""
    links: dict[int, list[tuple[float, int, int]]] = {number: [] for number in range(10)}
    order = rng.permutation(8).tolist()
    chain = list(pairwise(order))
    for one, other in [*chain, *((chain[n][0], chain[n + 2][1]) for n in range(0, 5, 2))]:
        for here, there in ((one, other), (other, one)):
            for _ in range(2):
                cost = round(float(rng.uniform(1, 5)), 3)
                links[here].append((cost, there, int(rng.integers(-2, 3))))
    return 10 * order[0], Matches(links), same_frame


def spread(query: int, matches_of: Callable[[int], Pairs], same: Callable[[int, int], bool]) -> list[int]:
    found, asking = [query], [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _cost, match in new:
            if not any(same(match, other) for other in found):
                found.append(match)
                asking.append(match)
    return found


def shares(distances: Array) -> Array:
    """Weigh samples by 1 / d - 1 / d_k; one that is hit gets all."""
    if distances[0] == 0:
        return np.asarray(np.eye(len(distances))[0])
    with np.errstate(all="ignore"):
        weights = 1 / distances - 1 / distances[-1]
        return np.asarray(weights / weights.sum())


def draw_neighbour_weights(rng: np.random.Generator) -> tuple[Array]:
    distances = np.sort(rng.uniform(0.1, 5, rng.integers(3, 7)))
    if rng.random() < 0.3:
        distances[0] = 0
    return (distances,)
