"""Notebook 07: inputs, right answers and mistakes of `product_of` and `cheapest_walk`."""

import operator
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments, same_pose
from mocap.course.checks.answers.searches import (
    FoundWalk,
    StepsFrom,
    Variant,
    cheapest_alone,
    cheapest_first,
    cheapest_last,
    longer_walks,
    search,
)
from mocap.course.checks.inputs import State, counted_ways_from, is_at, noted_requests
from mocap.course.comparisons import close


def placed(transforms: Array, rotated_by: Callable[[float, float], float]) -> tuple[float, float, float]:
    """Compose transforms, each step rotated by an angle made of the sum of those before it and the last."""
    angle = 0.0
    previous = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(1j * rotated_by(angle, previous))
        angle += rotation
        previous = rotation
    return angle, position.imag, position.real


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
    """Return the sum of all angles and the sum of the translations (x, z) as they are."""
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += z + 1j * x
        angle += rotation
    return angle, position.imag, position.real


def mistake_rotated_by_itself(transforms: Array) -> object:
    """Rotate each translation by the sum of the angles up to and including its own."""
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(1j * (angle + rotation))
        angle += rotation
    return angle, position.imag, position.real


def mistake_rotated_backwards(transforms: Array) -> object:
    """Rotate each translation by minus the sum of the angles before it."""
    angle = 0.0
    position = 0j
    for rotation, x, z in transforms:
        position += (z + 1j * x) * np.exp(-1j * angle)
        angle += rotation
    return angle, position.imag, position.real


def mistake_product_reversed(transforms: Array) -> object:
    """Return the product Tn … T2 T1."""
    return right_product_of(transforms[::-1])


def mistake_angles_converted(transforms: Array) -> object:
    """Rotate each translation by π/180 of the sum of the angles before it; return the sum itself."""
    return placed(transforms, lambda total, _: float(np.radians(total)))


def mistake_angle_of_row_before(transforms: Array) -> object:
    """Rotate each translation by the angle of the row before it alone, the first by 0."""
    return placed(transforms, lambda _, previous: previous)


def mistake_rotated_by_last_angle(transforms: Array) -> object:
    """Rotate every translation by the sum of the angles of all rows."""
    total = float(transforms[:, 0].sum())
    return placed(transforms, lambda *_: total)


def mistake_last_angle_alone(transforms: Array) -> object:
    """Return the angle of the last row with the x and z of the product."""
    return transforms[-1, 0], *right_product_of(transforms)[1:]


def mistake_z_before_x(transforms: Array) -> object:
    """Return the product as (angle, z, x)."""
    angle, x, z = right_product_of(transforms)
    return angle, z, x


def mistake_last_row_missing(transforms: Array) -> object:
    """Return the product of all transforms except the last."""
    return right_product_of(transforms[:-1])


def mistake_first_row_missing(transforms: Array) -> object:
    """Return the product of all transforms except the first."""
    return right_product_of(transforms[1:])


# ---- cheapest_walk


def draw_cheapest_walk(rng: np.random.Generator) -> Arguments:
    """Draw eight nodes with three edges each, some of them loops, a start, a goal, and a limit of edges.

    In one graph of two, walks of the same cost occur. The edges of a node always differ.
    """
    lengths = {}
    has_ties = rng.uniform() < 0.5
    for node in range(1, 9):
        ends = rng.choice(8, size=3, replace=False) + 1
        eighths = (rng.choice(8, size=3, replace=False) + 1) / 8  # their sums are exact
        drawn = eighths if has_ties else rng.uniform(0.1, 2, size=3)
        lengths[node] = {int(end): float(length) for end, length in zip(ends, drawn, strict=True)}
    start, goal = rng.choice(8, size=2, replace=False) + 1
    requests: list[State] = []
    steps_from = partial(counted_ways_from, requests, lengths, int(rng.integers(3, 7)))
    return steps_from, (int(start), 0), partial(is_at, int(goal))


def right_cheapest_walk(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> FoundWalk:
    """Search as the notebook does: the least cost, the states of this walk, and the number expanded."""
    return search(steps_from, start, is_done)


def unseen_cheapest_walk(arguments: Arguments, answer: Any) -> str:  # noqa: ANN401
    """Name the mistake of a search that asks for the edges of a walk twice."""
    requests = noted_requests(arguments[0])
    return "asked_twice" if requests and len(requests) > answer[2] + 1 else ""


def same_cheapest_walk(answer: Any, wanted: FoundWalk) -> bool:  # noqa: ANN401
    """Check whether two searches found the same walk, at the same cost, with the same effort."""
    if len(wanted) < 3 or not isinstance(wanted[1], list):  # what a mistake returns
        return close(answer, wanted)
    cost, walk, expanded = wanted
    return close(answer[0], cost) and list(answer[1]) == walk and bool(answer[2] == expanded)


def mistake_first_complete_walk(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Return the first complete walk that the depth-first search meets."""
    return search(steps_from, start, is_done, Variant(is_first=True))


def mistake_no_bound(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Expand every incomplete walk, with no bound, and return the complete walk of least cost."""
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
    """Search depth first with the longer walks sorted so that the one of highest cost is popped first."""
    return search(steps_from, start, is_done, Variant(cheapest_first))


def mistake_unsorted(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Search depth first with the longer walks pushed in the order in which the graph lists them."""
    return search(steps_from, start, is_done, Variant(list))


def mistake_oldest_first(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Search breadth first: pop the walk that has waited longest, from a queue sorted by falling cost."""
    return search(steps_from, start, is_done, Variant(position=0))


def mistake_cheapest_edge_alone(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Search greedily: push only the cheapest of the longer walks of each walk."""
    return search(steps_from, start, is_done, Variant(cheapest_alone))


def mistake_places_met(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Cut also each walk to a node that another walk, of any number of edges, has reached before."""
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
    """Return the walk of least cost with the number of popped walks, also those cut or complete."""
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
    """Return the walk of least cost without its first state."""
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    return cost, walk[1:], expanded


def mistake_equal_walks_kept(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Cut a walk only if its cost is greater than that of the best complete walk, not if it is equal."""
    return search(steps_from, start, is_done, Variant(is_cut=operator.gt))


def mistake_asked_twice(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Return the right result, but request the edges of the states of the best walk once more."""
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    for state in [start, *walk]:
        steps_from(state)
    return cost, walk, expanded


def mistake_complete_walks_expanded(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Expand and count a complete walk like any other after storing it as the best."""
    return search(steps_from, start, is_done, Variant(expands_complete=True))


def mistake_complete_walks_expanded_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Expand and count complete walks, and push the longer walks in the order of the graph."""
    return search(steps_from, start, is_done, Variant(list, expands_complete=True))


def mistake_last_edge_alone(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Search with the length of its last edge as the cost of a walk."""
    return search(steps_from, start, is_done, Variant(add=lambda _, length: length))


def mistake_last_edge_alone_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Search with the length of the last edge as the cost, pushing walks in the order of the graph."""
    return search(steps_from, start, is_done, Variant(list, add=lambda _, length: length))


def mistake_first_complete_walk_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Return the first complete walk met if the longer walks are pushed in the order of the graph."""
    return search(steps_from, start, is_done, Variant(list, is_first=True))


def mistake_oldest_first_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Search breadth first, with the longer walks queued in the order of the graph."""
    return search(steps_from, start, is_done, Variant(list, position=0))


def mistake_oldest_first_reversed(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Search breadth first, with the longer walks queued by rising cost."""
    return search(steps_from, start, is_done, Variant(cheapest_first, position=0))


def mistake_walk_first(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Return (states, cost, number) of the right search."""
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    return walk, cost, expanded


def mistake_walk_first_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Return (states, cost, number) of a search that pushes walks in the order of the graph."""
    cost, walk, expanded = search(steps_from, start, is_done, Variant(list))
    return walk, cost, expanded


def mistake_number_missing(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Return (cost, states) of the right search, without the number of expanded walks."""
    return right_cheapest_walk(steps_from, start, is_done)[:2]


def mistake_number_missing_unsorted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Return (cost, states) of a search that pushes walks in the order of the graph."""
    return search(steps_from, start, is_done, Variant(list))[:2]


def mistake_last_state_alone(steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]) -> object:
    """Return the last state of the walk of least cost in place of the list of its states."""
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    return cost, (walk[-1] if walk else ()), expanded


def mistake_start_not_counted(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool]
) -> object:
    """Return the number of expanded walks minus one, with the right cost and states."""
    cost, walk, expanded = right_cheapest_walk(steps_from, start, is_done)
    return cost, walk, expanded - 1
