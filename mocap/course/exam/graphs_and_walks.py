"""Questions 10 to 15 of the exam: graphs, pruning, random walks, searches and distances, by hand."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise, permutations
from typing import Any

import networkx as nx
import numpy as np

from mocap import plain
from mocap.course.exam.drawing import Draws, Question
from mocap.course.exam.wording import number, texts

BLEND = 10  # frames of a transition
MILLIMETRES = 10  # in a centimetre
BRANCHES = ("A", "B", "C")
GOALS = {"A": 2, "B": 2, "C": 1}  # edges to goals
NUMBERS = {2: "Two", 3: "Three", 4: "Four"}
CYCLES = (3, 3)  # nodes of the two cycles

Arrows = dict[tuple[int, int], int]
"""The seconds of each arrow of a graph."""


def size_of_graph(draws: Draws) -> Question:
    """Question 10: the nodes and edges of a graph before pruning: 2 c + 4 m, and n − c + 2 m."""
    clips = draws.integer("clips", 2, 4)
    matches = draws.integer("matches", 3, 9)
    nodes = 2 * clips + 4 * matches
    edges = nodes - clips + 2 * matches
    values = texts(clips=NUMBERS[clips], matches=matches)
    return Question(values, [f"{nodes} nodes (3)", f"{edges} edges (2)"], [])


def shortest_loop(draws: Draws) -> Question:
    """Question 11: the shortest closed walk by a match of a clip with itself."""
    early = draws.integer("early", 20, 60, 5)
    late = early + draws.integer("apart", 60, 140, 5)
    drawn = f"transitions from {late} to {early + BLEND}, and from {early} to {late + BLEND} (2)"
    played = f"frames {early + BLEND} to {late - 1} and a blend of ten"
    closed = f"the closed walk plays {played}: {late - early} (2)"
    return Question(
        texts(early=early, late=late),
        [drawn, closed],
        ["whether a match between two clips gives a closed walk (1)"],
    )


def pruned_graph(draws: Draws) -> Question:
    """Question 12: the components of a graph, the kept one, and the missing transition."""
    arrows, order = _arrows(draws)
    graph = nx.MultiDiGraph(list(arrows))
    completed: list[set[Any]] = list(plain.components(graph))  # in the order in which it completes them
    seconds = [sum(time for pair, time in arrows.items() if {*pair} <= nodes) for nodes in completed]
    *_, second_most, most_seconds = sorted(seconds)
    kept = completed[seconds.index(most_seconds)]
    pairs = [pair for pair in permutations(graph, 2) if pair not in arrows]
    whole = [pair for pair in pairs if len(plain.components(nx.MultiDiGraph([*arrows, pair]))) == 1]
    shown = [_arrow(pair, time) for pair, time in arrows.items()]
    values = texts(arrows=", ".join(draws.shuffled("arrows", shown)), first=order[0])
    listed = f"{', '.join(map(_set_text, completed))} (2)"
    largest = f"{_set_text(kept)} is kept, with {most_seconds} s; the next one has {second_most} s (1)"
    missing = ", ".join(_arrow(pair) for pair in sorted(whole))
    recorded = f"from and to: {missing} (2, or 1 for a single answer)"
    return Question(values, [listed, largest, recorded], [])


def _arrow(pair: tuple[int, int], seconds: int = 1) -> str:
    """Write an arrow, with its seconds if it does not take one."""
    start, end = pair
    return f"{start} → {end}" if seconds == 1 else f"{start} → {end} ({seconds})"


def _arrows(draws: Draws) -> tuple[Arrows, list[int]]:
    """Draw a graph: a cycle, from which an arrow leads to another cycle, and from there one to a dead end."""
    order = draws.shuffled("nodes", range(1, sum(CYCLES) + 2))
    first = order[: CYCLES[0]]
    second = order[CYCLES[0] : sum(CYCLES)]
    rings = [*pairwise([*first, first[0]]), *pairwise([*second, second[0]])]
    leave = draws.choice("leave", first)
    enter = draws.choice("enter", second)
    last = draws.choice("last", second)
    arrows = dict.fromkeys([*rings, (leave, enter), (last, order[-1])], 1)
    arrows[draws.choice("slow", rings)] = draws.integer("seconds", 3, 6)
    return arrows, order


def _set_text(nodes: set[int]) -> str:
    """Write a set of nodes."""
    return f"{{{', '.join(map(str, sorted(nodes)))}}}"


def odds_of_transitions(draws: Draws) -> Question:
    """Question 13: probabilities inverse to distances."""
    distances = sorted(draws.shuffled("distances", range(1, 9))[:3])  # cm
    odds = np.array([1 / (MILLIMETRES * distance + 1) for distance in distances])
    percent = [f"{number(100 * value, 0)} %" for value in odds / odds.sum()]
    first, second, third = distances
    values = {"distances": f"{first}, {second} and {third} cm"}
    return Question(values, [f"{', '.join(percent)} (4)"], ["what would happen without the millimetre (1)"])


def expanded_walks(draws: Draws) -> Question:
    """Question 14: the walks that branch and bound expands, with and without a lower bound."""
    attempt = 0
    costs, goals = _costs(draws, attempt)
    while _count(costs, goals, 0) == _count(costs, goals, 1):
        attempt += 1
        costs, goals = _costs(draws, attempt)
    values = {f"goals_{name.lower()}": " and ".join(map(str, goals[name])) for name in BRANCHES}
    values["branches"] = "{}, {} and {}".format(*costs.values())
    unbounded = f"without the bound, {_count(costs, goals, 0)} walks, including the start (3)"
    bounded = f"with the bound, {_count(costs, goals, 1)} (2)"
    discarded = "a walk that costs as much as the best is discarded"
    return Question(values, [unbounded, f"{bounded}; {discarded}"], [])


Goals = Mapping[str, list[int]]


def _costs(draws: Draws, attempt: int) -> tuple[dict[str, int], dict[str, list[int]]]:
    """Draw the costs of edges to A, B and C, in increasing order, and from there to goals."""
    first = draws.integer(f"{attempt} A", 1, 3)
    second = first + draws.integer(f"{attempt} B", 1, 3)
    third = second + draws.integer(f"{attempt} C", 1, 3)
    costs = dict(zip(BRANCHES, (first, second, third), strict=True))
    goals: dict[str, list[int]] = {}
    for name, count in GOALS.items():
        goals[name] = [draws.integer(f"{attempt} {name} {goal}", 1, 6) for goal in range(count)]
    return costs, goals


def _count(costs: Mapping[str, int], goals: Goals, bound: int) -> int:
    """Count the walks that are expanded: the start, and each that can still be better than the best."""
    expanded = 1
    best = np.inf
    for name in sorted(costs, key=costs.__getitem__):
        if costs[name] + bound < best:
            expanded += 1
            best = min(best, costs[name] + min(goals[name]))
    return expanded


def swaying_walker(draws: Draws) -> Question:
    """Question 15: the distance at equal arc length of a walker who sways."""
    sway = draws.integer("sway", 3, 8)  # per cent
    metres = draws.integer("metres", 8, 20)
    lag = 100 * metres * (1 - 1 / (1 + sway / 100))  # cm
    return Question(
        texts(sway=sway, metres=metres),
        [f"{number(lag, 0)} cm at equal arc length (3)"],
        ["the distance to the nearest point (1)", "which of them a viewer sees (1)"],
    )


QUESTIONS = {
    10: size_of_graph,
    11: shortest_loop,
    12: pruned_graph,
    13: odds_of_transitions,
    14: expanded_walks,
    15: swaying_walker,
}
"""The functions that draw questions, by their numbers in `exam.md`."""
