"""Checks of notebook 07."""

from itertools import pairwise
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake, close, close_angles


def _shares(costs: Array) -> Array:
    return np.asarray(np.cumsum(1 / (costs + 1e-3)) / np.sum(1 / (costs + 1e-3)))


def _chosen(shares: Array, chance: float) -> int:
    """Find the first item whose running share exceeds the chance."""
    return min(int(np.searchsorted(shares, chance, side="right")), len(shares) - 1)


choose_transition = Check(
    name="choose_transition",
    asks="the number of the chosen transition, an integer from 0 on",
    start="give each transition the share 1 / (cost + 0.001) of the sum, lay the shares end to end from "
    "0 to 1, "
    "and see into which of them the chance falls.",
    draw=lambda rng: (rng.uniform(1e-4, 0.06, rng.integers(2, 7)), float(rng.uniform())),
    truth=lambda costs, chance: _chosen(_shares(costs), chance),
    trials=60,
    mistakes=[
        Mistake(
            lambda costs, chance: _chosen(np.cumsum(costs) / np.sum(costs), chance),
            "this is the homework's slip: the worse a transition, the likelier you make it.",
        ),
        Mistake(
            lambda costs, chance: int(np.argmin(costs)),
            "you always take the cheapest one, so the walk is the same each time: use the chance.",
        ),
        Mistake(
            lambda costs, chance: int(chance * len(costs)),
            "all transitions have the same probability in your answer: use the costs.",
        ),
        Mistake(
            lambda costs, chance: _chosen(np.cumsum(1 / (costs + 1e-3)), chance),
            "your shares do not add up to 1, so the chance nearly always falls into the first: divide by "
            "the sum.",
        ),
        Mistake(
            lambda costs, chance: _chosen(_shares(costs), chance) + 1,
            "the shares are right, but you count from 1: the first transition has the number 0.",
        ),
        Mistake(
            lambda costs, chance: int(np.argmin(np.abs(np.diff(_shares(costs), prepend=0) - chance))),
            "you look for the share that is nearest to the chance; lay the shares end to end "
            "(`np.cumsum`) instead.",
        ),
    ],
)


def _product(transforms: Array, turned: str = "before") -> tuple[float, float, float]:
    """Multiply rows (angle, x, z); `turned` says by which angle each step is turned."""
    angle, at = 0.0, 0j
    for turn, x, z in transforms:
        by = {"before": angle, "after": angle + turn, "backwards": -angle, "never": 0.0}[turned]
        at += (z + 1j * x) * np.exp(1j * by)
        angle += turn
    return angle, at.imag, at.real


def _same_place(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    return close_angles(given[0], wanted[0]) and close(given[1:], wanted[1:])


def _random_transforms(rng: np.random.Generator) -> tuple[Array]:
    """Draw transforms; some turn by nothing, by nearly nothing, by half a turn, or do nothing at all."""
    rows = rng.normal(size=(rng.integers(2, 8), 3)) * [1.0, 2.0, 2.0]
    rows[rng.integers(len(rows)), 0] = rng.choice([0.0, 1e-12, np.pi, -np.pi, 3.0])
    if rng.uniform() < 0.3:
        rows[rng.integers(len(rows))] = 0.0
    return (rows,)


product_of = Check(
    name="product_of",
    asks="the angle, x and z of the product T1 T2 … Tn of the rows",
    start="go through the rows and keep the angle so far; turn each step by it before you add it.",
    draw=_random_transforms,
    truth=_product,
    same=_same_place,
    mistakes=[
        Mistake(
            lambda transforms: _product(transforms, "never"),
            "you add the steps as they are; each must first be turned by the angles before it.",
        ),
        Mistake(
            lambda transforms: _product(transforms, "after"),
            "you turn each step by its own angle too; only the angles of the transforms before it count.",
        ),
        Mistake(
            lambda transforms: _product(transforms, "backwards"),
            "you turn the steps in the wrong direction: check the sign of the sine.",
        ),
        Mistake(
            lambda transforms: _product(transforms[::-1]),
            "that is the product in the other order: the last transform should be the innermost.",
        ),
    ],
)


Lengths = dict[int, dict[int, float]]


def _random_graph(rng: np.random.Generator) -> tuple[Lengths, int, int, int]:
    """Draw eight nodes with three edges each, some of them loops, a start, a goal, and a limit of edges."""
    lengths = {
        node: {int(after): float(rng.uniform(0.1, 2)) for after in rng.choice(8, size=3, replace=False) + 1}
        for node in range(1, 9)
    }
    start, goal = rng.choice(8, size=2, replace=False) + 1
    return lengths, int(start), int(goal), int(rng.integers(3, 7))


def _shortest(
    lengths: Lengths, start: int, goal: int, longest: int, *, slip: str = ""
) -> tuple[float, list[int]]:
    """Search as the notebook does: the cost of the shortest walk of at most so many edges, and its nodes."""
    best: tuple[float, list[int]] = (np.inf, [])
    waiting, met = [(0.0, [start])], set()
    while waiting:
        cost, walk = waiting.pop()
        if cost >= best[0] or (slip == "met once" and walk[-1] in met):
            continue
        met.add(walk[-1])
        if walk[-1] == goal:
            best = (cost, walk)
            if slip == "first found":
                break
        elif len(walk) + (slip == "counts nodes") <= longest + (slip == "one too long"):
            ways = sorted(lengths[walk[-1]].items(), key=lambda way: -way[1])
            ways = ways[-1:] if slip == "greedy" else ways
            waiting += [(cost + more, [*walk, node]) for node, more in ways]
    return best


def _fewest(lengths: Lengths, start: int, goal: int, longest: int) -> tuple[float, list[int]]:
    each = {node: {after: more + 100 for after, more in row.items()} for node, row in lengths.items()}
    _, walk = _shortest(each, start, goal, longest)
    return sum(lengths[a][b] for a, b in pairwise(walk)) if walk else np.inf, walk


shortest_walk = Check(
    name="shortest_walk",
    asks="the length of the shortest walk from start to goal with at most `longest` edges, and the list "
    "of its "
    "nodes; inf and [] where there is none",
    start="keep a stack of (length so far, list of nodes). Pop one; skip it if it is as long as the best; "
    "if its last node is the goal, it is the best; else push it with each next node, the shortest last, "
    "unless it has `longest` edges.",
    draw=_random_graph,
    truth=_shortest,
    same=lambda given, wanted: close(given[0], wanted[0]) and list(given[1]) == list(wanted[1]),
    trials=60,
    mistakes=[
        Mistake(
            lambda *task: _shortest(*task, slip="first found"),
            "you stop at the first complete walk; another one may be shorter.",
        ),
        Mistake(
            lambda *task: _shortest(*task, slip="greedy"),
            "you follow only the shortest edge of each node: push all of them, the shortest last.",
        ),
        Mistake(
            lambda *task: _shortest(*task, slip="met once"),
            "you skip a node that some walk has met before; a walk may come back to it by a shorter way.",
        ),
        Mistake(
            lambda *task: _shortest(*task, slip="counts nodes"),
            "your walks end one edge too early: a walk of n edges has n + 1 nodes.",
        ),
        Mistake(
            lambda *task: _shortest(*task, slip="one too long"),
            "your walks may have one edge too many: a walk of n edges has n + 1 nodes.",
        ),
        Mistake(
            _fewest,
            "you look for the fewest edges; add up the lengths.",
        ),
        Mistake(
            lambda *task: (_shortest(*task)[0], _shortest(*task)[1][1:]),
            "the length is right, but the start belongs to the list of nodes.",
        ),
    ],
)
