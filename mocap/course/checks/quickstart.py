"""Random input and answers, right and wrong, for `00-quickstart.toml`."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array


def draw_cheapest(rng: np.random.Generator) -> tuple[Array, NDArray[np.int64]]:
    grid = rng.uniform(size=(rng.integers(5, 20), rng.integers(5, 20)))
    minima = np.argwhere(grid > 0.3)  # never the smallest of the whole grid
    return grid, rng.permutation(minima)[: rng.integers(3, 12)]


def draw_dead_ends(rng: np.random.Generator) -> tuple[list[tuple[int, int]]]:
    count = int(rng.integers(6, 12))
    ways = [(int(a), int(b)) for a, b in rng.integers(0, count, size=(count, 2))]
    # A node that no edge enters, one that no edge leaves, and one whose only edge leads to that one.
    return ([(count, 0), *ways, (0, count + 2), (count + 2, count + 1)],)


def ends(edges: list[tuple[int, int]]) -> set[int]:
    return {b for _, b in edges} - {a for a, _ in edges}


def stripped(edges: list[tuple[int, int]]) -> set[int]:
    gone: set[int] = set()
    while more := ends([edge for edge in edges if edge[1] not in gone]):
        gone |= more
    return gone
