"""Checks of notebook 00."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake

speed = Check(
    name="speed",
    asks="the speed over the ground between each frame and the next, in metres per second",
    start="np.diff gives the steps from frame to frame; a step lasts 1 / fps seconds.",
    draw=lambda rng: (rng.normal(size=(rng.integers(2, 30), 3)).cumsum(axis=0), float(rng.integers(24, 121))),
    truth=lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps,
    mistakes=[
        Mistake(
            lambda positions, fps: np.linalg.norm(np.diff(positions, axis=0), axis=1) * fps,
            "your speed includes the movement up and down; use only x and z.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T),
            "that is in metres per frame; a second has `fps` frames.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) / fps,
            "divide by the time of a frame, which is 1 / fps: so multiply by fps.",
        ),
        Mistake(
            lambda positions, fps: np.hypot(*np.diff(positions[:, :2], axis=0).T) * fps,
            "columns 0 and 1 are x and y, and y is up; the ground is x and z.",
        ),
    ],
)


def _some_minima(rng: np.random.Generator) -> tuple[Array, NDArray[np.int64]]:
    grid = rng.uniform(size=(rng.integers(5, 20), rng.integers(5, 20)))
    minima = np.argwhere(grid > 0.3)  # never the smallest of the whole grid
    return grid, rng.permutation(minima)[: rng.integers(3, 12)]


def _best(grid: Array, minima: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(minima[np.argmin(grid[tuple(minima.T)])])


cheapest = Check(
    name="cheapest",
    asks="the row and column of the minimum with the smallest distance",
    start="grid[minima[:, 0], minima[:, 1]] are the distances at the minima; np.argmin finds the smallest.",
    draw=_some_minima,
    truth=_best,
    mistakes=[
        Mistake(
            lambda grid, minima: np.argwhere(grid == grid.min())[0],
            "that is the smallest of the whole grid; a transition is allowed only at the minima.",
        ),
        Mistake(
            lambda grid, minima: np.argmin(grid[tuple(minima.T)]),
            "that is the index in the list of minima; return the row and column at that index.",
        ),
        Mistake(
            lambda grid, minima: minima[np.argmax(grid[tuple(minima.T)])],
            "that is the worst of the minima; a small distance is a good match.",
        ),
        Mistake(
            lambda grid, minima: grid[tuple(minima.T)].min(),
            "that is the distance itself; return its row and column.",
        ),
        Mistake(
            lambda grid, minima: _best(grid, minima)[::-1],
            "that is (j, i): the row i comes first.",
        ),
    ],
)


def _some_edges(rng: np.random.Generator) -> tuple[list[tuple[int, int]]]:
    count = int(rng.integers(6, 12))
    ways = [(int(a), int(b)) for a, b in rng.integers(0, count, size=(count, 2))]
    # A node that no edge enters, one that no edge leaves, and one whose only edge leads to that one.
    return ([(count, 0), *ways, (0, count + 2), (count + 2, count + 1)],)


def _ends(edges: list[tuple[int, int]]) -> set[int]:
    return {b for _, b in edges} - {a for a, _ in edges}


def _stripped(edges: list[tuple[int, int]]) -> set[int]:
    gone: set[int] = set()
    while more := _ends([edge for edge in edges if edge[1] not in gone]):
        gone |= more
    return gone


dead_ends = Check(
    name="dead_ends",
    asks="the set of nodes that no edge leaves",
    start="make a set of the nodes at which edges start, and a set of those at which edges end; which nodes "
    "are in the second set but not in the first?",
    draw=_some_edges,
    truth=_ends,
    mistakes=[
        Mistake(
            lambda edges: {a for a, _ in edges} - {b for _, b in edges},
            "those are the nodes that no edge enters; a dead end is a node that no edge leaves.",
        ),
        Mistake(
            lambda edges: set(),
            "that is always empty: no edge starts at a dead end, so look at where edges end.",
        ),
        Mistake(
            lambda edges: {b for _, b in edges},
            "those are all nodes that an edge enters; remove those that an edge leaves.",
        ),
        Mistake(
            _stripped,
            "too many: you removed the dead ends and looked again. Pruning does that; here, look once.",
        ),
        Mistake(
            lambda edges: sorted(_ends(edges)),
            "these are the right nodes, but in a list; return a set.",
        ),
    ],
)
