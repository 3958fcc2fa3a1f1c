"""The search of `cheapest_walk` in notebook 07, right or with something changed."""

import operator
from collections.abc import Callable

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.course.checks.inputs import State

StepsFrom = Callable[[State], list[tuple[float, State]]]
"""The edges that leave a state: the length of each, and the state at its end."""

FoundWalk = tuple[float, list[State], int]
"""The cost of a walk, its states, and the number of walks expanded."""

Waiting = list[tuple[float, list[State]]]
"""Walks to expand, each with its cost."""


def longer_walks(
    steps_from: StepsFrom,
    cost: float,
    walk: list[State],
    add: Callable[[float, float], float] = operator.add,
) -> Waiting:
    """Lengthen a walk by each edge that leaves its last state, and add the edge's length to its cost."""
    return [(add(cost, length), [*walk, state]) for length, state in steps_from(walk[-1])]


def cheapest_last(walks: Waiting) -> Waiting:
    """Sort walks by falling cost, equal ones in their order."""
    return sorted(walks, key=lambda walk: -walk[0])


def cheapest_first(walks: Waiting) -> Waiting:
    """Sort walks by rising cost."""
    return sorted(walks, key=lambda walk: walk[0])


def cheapest_alone(walks: Waiting) -> Waiting:
    """Keep the cheapest walk."""
    return cheapest_last(walks)[-1:]


class Variant(NamedTuple):
    """The parts of the search that students change; the defaults are those of the right one.

    Attributes
    ----------
    arrange : puts the longer walks in the order in which they are pushed.
    is_cut : whether a walk of some cost is cut, after a complete one of another cost.
    expands_complete : complete walks are expanded as well.
    add : from the cost of a walk and the length of an edge to the cost of the longer walk.
    is_first : the search ends at the first complete walk.
    position : the index of the waiting walk to expand: -1 for a stack, 0 for a queue.
    """

    arrange: Callable[[Waiting], Waiting] = cheapest_last
    is_cut: Callable[[float, float], bool] = operator.ge
    expands_complete: bool = False
    add: Callable[[float, float], float] = operator.add
    is_first: bool = False
    position: int = -1


RIGHT = Variant()
"""The search as notebook 07 has it."""


def search(
    steps_from: StepsFrom, start: State, is_done: Callable[[State], bool], variant: Variant = RIGHT
) -> FoundWalk:
    """Find the complete walk of least cost depth first: its cost, its states, and the number expanded.

    If no walk is complete, the cost is inf, and there are no states.
    """
    best: tuple[float, list[State]] = (np.inf, [])
    waiting = [(0.0, [start])]
    expanded = 0
    while waiting:
        cost, walk = waiting.pop(variant.position)
        if best[1] and variant.is_cut(cost, best[0]):
            continue
        if is_done(walk[-1]):
            best = (cost, walk)
            if variant.is_first:
                break
            if not variant.expands_complete:
                continue
        expanded += 1
        waiting += variant.arrange(longer_walks(steps_from, cost, walk, variant.add))
    return *best, expanded
