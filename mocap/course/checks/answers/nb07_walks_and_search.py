"""Notebook 07: inputs, right answers and mistakes of `product_of` and `cheapest_walk`."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import close
from mocap.course.checks.answers.common import Arguments, same_pose
from mocap.course.checks.inputs import State, is_at, ways_from

StepsFrom = Callable[[State], list[tuple[float, State]]]
"""The edges that leave a state: the length of each, and the state at its end."""

FoundWalk = tuple[float, list[State], int]
"""The cost of a walk, its states, and the number of walks expanded."""

Waiting = list[tuple[float, list[State]]]
"""Walks to expand, each with its cost."""


def longer_walks(steps_from: StepsFrom, cost: float, walk: list[State]) -> Waiting:
    """Lengthen a walk by each edge that leaves its last state."""
    return [(cost + length, [*walk, state]) for length, state in steps_from(walk[-1])]


def cheapest_last(walks: Waiting) -> Waiting:
    """Sort walks by falling cost, equal ones in their order."""
    return sorted(walks, key=lambda walk: -walk[0])


def cheapest_first(walks: Waiting) -> Waiting:
    """Sort walks by rising cost."""
    return sorted(walks, key=lambda walk: walk[0])


def cheapest_alone(walks: Waiting) -> Waiting:
    """Keep the cheapest walk."""
    return cheapest_last(walks)[-1:]


def search(
    steps_from: StepsFrom,
    start: State,
    is_done: Callable[[State], bool],
    arranged: Callable[[Waiting], Waiting] = cheapest_last,
    position: int = -1,
) -> FoundWalk:
    """Search as the notebook does: the least cost, the states of this walk, and the number expanded."""
    best: tuple[float, list[State]] = (np.inf, [])
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop(position)
        if cost >= best[0]:
            continue
        if is_done(walk[-1]):
            best = (cost, walk)
            continue
        expanded += 1
        waiting += arranged(longer_walks(steps_from, cost, walk))
    return *best, expanded


# ---- product_of


def draw_product_of(rng: np.random.Generator) -> Arguments:
    """Draw transforms; some rotate by nothing, by nearly nothing, by half a turn, or do nothing at all."""
    rows = rng.normal(size=(rng.integers(2, 8), 3)) * [1.0, 2.0, 2.0]
    rows[rng.integers(len(rows)), 0] = rng.choice([0.0, 1e-12, np.pi, -np.pi, 3.0])
    if rng.uniform() < 0.3:
        rows[rng.integers(len(rows))] = 0.0
    return (rows,)


def right_product_of(transforms: Array) -> tuple[float, float, float]:
    """Each step is rotated by the angles before it."""
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(1j * angle)
        angle += rotation
    return angle, position.imag, position.real


same_product_of = same_pose


def mistake_steps_not_rotated(transforms: Array) -> object:
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(0)
        angle += rotation
    return angle, position.imag, position.real


def mistake_rotated_by_itself(transforms: Array) -> object:
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(1j * (angle + rotation))
        angle += rotation
    return angle, position.imag, position.real


def mistake_rotated_backwards(transforms: Array) -> object:
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(-1j * angle)
        angle += rotation
    return angle, position.imag, position.real


def mistake_product_reversed(transforms: Array) -> object:
    return right_product_of(transforms[::-1])


# ---- cheapest_walk


def draw_cheapest_walk(rng: np.random.Generator) -> Arguments:
    """Draw eight nodes with three edges each, some of them loops, a start, a goal, and a limit of edges."""
    lengths = {}
    for node in range(1, 9):
        ends = rng.choice(8, size=3, replace=False) + 1
        lengths[node] = {int(end): float(rng.uniform(0.1, 2)) for end in ends}
    start, goal = rng.choice(8, size=2, replace=False) + 1
    steps_from = partial(ways_from, lengths, int(rng.integers(3, 7)))
    return steps_from, (int(start), 0), partial(is_at, int(goal))


def right_cheapest_walk(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> FoundWalk:
    """Search as the notebook does: the least cost, the states of this walk, and the number expanded."""
    return search(steps_from, start, is_done)


def same_cheapest_walk(answer: Any, wanted: FoundWalk) -> bool:  # noqa: ANN401
    cost, walk, expanded = wanted
    return close(answer[0], cost) and list(answer[1]) == walk and bool(answer[2] == expanded)


def mistake_first_complete_walk(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop()
        if is_done(walk[-1]):
            return cost, walk, expanded
        expanded += 1
        waiting += cheapest_last(longer_walks(steps_from, cost, walk))
    return np.inf, [], expanded


def mistake_no_bound(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    best: tuple[float, list[State]] = (np.inf, [])
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop()
        if is_done(walk[-1]):
            best = min(best, (cost, walk))
            continue
        expanded += 1
        waiting += cheapest_last(longer_walks(steps_from, cost, walk))
    return *best, expanded


def mistake_dearest_first(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    return search(steps_from, start, is_done, arranged=cheapest_first)


def mistake_unsorted(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    return search(steps_from, start, is_done, arranged=list)


def mistake_oldest_first(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    return search(steps_from, start, is_done, position=0)


def mistake_cheapest_edge_alone(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    return search(steps_from, start, is_done, arranged=cheapest_alone)


def mistake_places_met(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    best: tuple[float, list[State]] = (np.inf, [])
    met = set()
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop()
        place, _ = walk[-1]
        if cost >= best[0] or place in met:
            continue
        met.add(place)
        if is_done(walk[-1]):
            best = (cost, walk)
            continue
        expanded += 1
        waiting += cheapest_last(longer_walks(steps_from, cost, walk))
    return *best, expanded


def mistake_pops_counted(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    best: tuple[float, list[State]] = (np.inf, [])
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop()
        expanded += 1
        if cost >= best[0]:
            continue
        if is_done(walk[-1]):
            best = (cost, walk)
            continue
        waiting += cheapest_last(longer_walks(steps_from, cost, walk))
    return *best, expanded


def mistake_start_missing(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    return cost, walk[1:], expanded
