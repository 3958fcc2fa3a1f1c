"""Random input and answers, right and wrong, for `08-path-synthesis.toml`."""

from collections.abc import Callable

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath

Line = Callable[[Array], Array]


def draw_polyline(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))


def path_cost(track: Array, path: Line, along: float, steps: Array) -> tuple[float, float]:
    reached = along + np.cumsum(steps)
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def step_lengths(track: Array) -> Array:
    return np.asarray(np.hypot(*np.diff(track, axis=0).T))


def draw_edge_cost(rng: np.random.Generator) -> tuple[Array, Line, float, float]:
    line = GroundPath(draw_polyline(rng))
    track = rng.normal(scale=0.05, size=(rng.integers(4, 12), 2)).cumsum(axis=0)
    return track, line.at, float(rng.uniform(0, line.length)), float(rng.uniform(0.02, 0.06))


def survivors(stand: Indices, costs: Array, width: int) -> Indices:
    order = np.argsort(costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return np.asarray(order[np.sort(first)[:width]])


def draw_survivors(rng: np.random.Generator) -> tuple[Indices, Array, int]:
    count = int(rng.integers(30, 60))
    return rng.integers(0, 2, size=(count, 4)), rng.permutation(count) / 100, int(rng.integers(3, 7))


Walk = tuple[complex, complex, float, float]
Edge = tuple[int, Points, complex, complex, float]
Longer = list[tuple[int, complex, complex, float, float]]


def draw_lengthen(rng: np.random.Generator) -> tuple[Walk, list[Edge], Line, float]:
    """Draw where a walk is, the edges that leave its node, a path, and the least progress per frame."""
    line = GroundPath(draw_polyline(rng))
    (x, z), along = line.at(0.4 * line.length), 0.4 * line.length
    walk = (complex(draw_turn(rng)), complex(z, x), along, float(rng.uniform(0.1, 2)))
    edges = []
    for end in rng.permutation(9)[: rng.integers(2, 5)].tolist():
        track = (rng.normal(scale=0.05, size=(rng.integers(3, 9), 2)) @ [1, 1j]).cumsum()
        move = complex(*rng.normal(size=2))
        edges.append((end, track, complex(draw_turn(rng)), move, float(rng.choice([0.0, 0.3]))))
    return walk, edges, line.at, 0.01


def draw_turn(rng: np.random.Generator) -> complex:
    return complex(np.exp(1j * rng.uniform(-3, 3)))


def lengthen(walk: Walk, edges: list[Edge], path: Line, least: float) -> Longer:
    turn, move, along, cost = walk
    longer = []
    for end, track, edge_turn, edge_move, price in edges:
        placed = turn * track + move
        steps = np.maximum(np.abs(np.diff(placed)), least)
        more, reached = path_cost(np.stack([placed.imag, placed.real], axis=1), path, along, steps)
        longer.append((end, turn * edge_turn, move + turn * edge_move, reached, cost + more + price))
    return longer
