"""Answers, right and wrong, of exercises about walks."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath
from mocap.course.check import close, close_angles

# ---- Notebook 07


def product_in_turn(transforms: Array) -> tuple[float, float, float]:
    """Multiply rows (angle, x, z): each step is turned by the angles before it."""
    angle, at = 0.0, 0j
    for turn, x, z in transforms:
        at += (z + 1j * x) * np.exp(1j * angle)
        angle += turn
    return angle, at.imag, at.real


def same_place(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare (angle, x, z), the angles up to whole turns."""
    angle, *shift = given
    return len(shift) == 2 and close_angles(angle, wanted[0]) and close(shift, wanted[1:])


Lengths = dict[int, dict[int, float]]
At = tuple[int, int]  # a node, and the edges walked before it
Ways = Callable[[At], list[tuple[float, At]]]


def ways_from(lengths: Lengths, longest: int, state: At) -> list[tuple[float, At]]:
    """Lengthen a walk by each edge of its last node, unless it has so many already."""
    node, made = state
    return [(more, (end, made + 1)) for end, more in lengths[node].items()] if made < longest else []


def is_at(goal: int, state: At) -> bool:
    """Say whether a walk is at its goal."""
    return state[0] == goal


def cheapest(ways: Ways, start: At, done: Callable[[At], bool]) -> tuple[float, list[At], int]:
    """Search as the notebook does: the least cost, the states of this walk, and the number expanded."""
    best: tuple[float, list[At]] = (np.inf, [])
    waiting, expanded = [(0.0, [start])], 0
    while waiting:
        cost, walk = waiting.pop()
        if cost >= best[0]:
            continue
        if done(walk[-1]):
            best = cost, walk
            continue
        expanded += 1
        found = [(cost + more, [*walk, state]) for more, state in ways(walk[-1])]
        waiting += sorted(found, key=lambda longer: -longer[0])
    return *best, expanded


# ---- Notebooks 08 and 08c


Line = Callable[[Array], Any]
Walk = tuple[complex, complex, float, float]
Edge = tuple[int, Points, complex, complex, float]
Longer = list[tuple[int, complex, complex, float, float]]


def draw_polyline(rng: np.random.Generator) -> Array:
    """Draw four to eight corners of a line."""
    return np.asarray(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))


def path_cost(track: Array, path: Line, along: float, steps: Array) -> tuple[float, float]:
    """Add up Eq. 9 over the points of a track, and say how far along the path it has come."""
    reached = along + np.cumsum(steps)
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def draw_turn(rng: np.random.Generator) -> complex:
    """Draw a turn over the ground."""
    return complex(np.exp(1j * rng.uniform(-3, 3)))


def lengthen(walk: Walk, edges: list[Edge], path: Line, least: float) -> Longer:
    """Lengthen a walk by each edge: its end, transform, arc length and cost."""
    turn, move, along, cost = walk
    longer = []
    for end, track, edge_turn, edge_move, price in edges:
        placed = turn * track + move
        steps = np.maximum(np.abs(np.diff(placed)), least)
        more, reached = path_cost(np.stack([placed.imag, placed.real], axis=1), path, along, steps)
        longer.append((end, turn * edge_turn, move + turn * edge_move, reached, cost + more + price))
    return longer


# ---- Notebook 08b


def seconds_until(track: Array, heading: float, frame: int, back: int) -> float:
    """Find the frame, counted from the command, in which a walk goes the new way; -1 if it never does."""
    moved = track[back:] - track[:-back]
    off = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    off = np.abs((off + np.pi) % (2 * np.pi) - np.pi)
    obeys = off[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


# ---- Notebook 19


def greedy(a: Points, b: Points) -> Indices:
    """Assign the nearest pair first, then the nearest of those that are left."""
    squares, order = abs(a[:, None] - b) ** 2, np.zeros(len(a), int)
    for _ in a:
        i, j = divmod(int(squares.argmin()), len(b))
        order[i] = j
        squares[i], squares[:, j] = np.inf, np.inf
    return order
