"""Random input and answers, right and wrong, for `07-walks-and-search.toml`."""

from itertools import pairwise
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import close, close_angles


def running_shares(costs: Array) -> Array:
    return np.asarray(np.cumsum(1 / (costs + 1e-3)) / np.sum(1 / (costs + 1e-3)))


def chosen(shares: Array, chance: float) -> int:
    """Find the first item whose running share exceeds the chance."""
    return min(int(np.searchsorted(shares, chance, side="right")), len(shares) - 1)


def product(transforms: Array) -> tuple[float, float, float]:
    """Multiply rows (angle, x, z): each step is turned by the angles before it."""
    angle, at = 0.0, 0j
    for turn, x, z in transforms:
        at += (z + 1j * x) * np.exp(1j * angle)
        angle += turn
    return angle, at.imag, at.real


def same_place(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    return close_angles(given[0], wanted[0]) and close(given[1:], wanted[1:])


def draw_product_of(rng: np.random.Generator) -> tuple[Array]:
    """Draw transforms; some turn by nothing, by nearly nothing, by half a turn, or do nothing at all."""
    rows = rng.normal(size=(rng.integers(2, 8), 3)) * [1.0, 2.0, 2.0]
    rows[rng.integers(len(rows)), 0] = rng.choice([0.0, 1e-12, np.pi, -np.pi, 3.0])
    if rng.uniform() < 0.3:
        rows[rng.integers(len(rows))] = 0.0
    return (rows,)


Lengths = dict[int, dict[int, float]]


def draw_shortest_walk(rng: np.random.Generator) -> tuple[Lengths, int, int, int]:
    """Draw eight nodes with three edges each, some of them loops, a start, a goal, and a limit of edges."""
    lengths = {
        node: {int(after): float(rng.uniform(0.1, 2)) for after in rng.choice(8, size=3, replace=False) + 1}
        for node in range(1, 9)
    }
    start, goal = rng.choice(8, size=2, replace=False) + 1
    return lengths, int(start), int(goal), int(rng.integers(3, 7))


def shortest(lengths: Lengths, start: int, goal: int, longest: int) -> tuple[float, list[int]]:
    """Search as the notebook does: the cost of the shortest walk of at most so many edges, and its nodes."""
    best: tuple[float, list[int]] = (np.inf, [])
    waiting = [(0.0, [start])]
    while waiting:
        cost, walk = waiting.pop()
        if cost >= best[0]:
            continue
        if walk[-1] == goal:
            best = cost, walk
        elif len(walk) <= longest:
            ways = sorted(lengths[walk[-1]].items(), key=lambda way: -way[1])
            waiting += [(cost + more, [*walk, node]) for node, more in ways]
    return best


def fewest(lengths: Lengths, start: int, goal: int, longest: int) -> tuple[float, list[int]]:
    each = {node: {after: more + 100 for after, more in row.items()} for node, row in lengths.items()}
    _, walk = shortest(each, start, goal, longest)
    return sum(lengths[a][b] for a, b in pairwise(walk)) if walk else np.inf, walk
