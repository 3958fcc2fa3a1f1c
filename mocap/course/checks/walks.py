"""Checks of notebook 07."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake, close, close_angles

Tree = dict[int, list[tuple[float, int]]]

choice_odds = Check(
    name="choice_odds",
    asks="a probability for each transition, in proportion to 1 / (cost + 0.001), with the sum 1",
    start="take 1 / (costs + 0.001), and divide it by its sum.",
    draw=lambda rng: (rng.uniform(1e-4, 0.06, rng.integers(2, 7)),),
    truth=lambda costs: 1 / (costs + 1e-3) / np.sum(1 / (costs + 1e-3)),
    mistakes=[
        Mistake(
            lambda costs: costs / costs.sum(),
            "this is the homework's slip: the worse a transition, the likelier you make it.",
        ),
        Mistake(
            lambda costs: (costs + 1e-3) / np.sum(costs + 1e-3),
            "this is the homework's slip: the worse a transition, the likelier you make it.",
        ),
        Mistake(
            lambda costs: 1 / (costs + 1e-3),
            "the proportions are right, but probabilities add up to 1: divide by the sum.",
        ),
        Mistake(
            lambda costs: 1 / costs / np.sum(1 / costs),
            "a transition of cost 0 would divide by zero: add the millimetre first.",
        ),
        Mistake(
            lambda costs: np.full(len(costs), 1 / len(costs)),
            "all transitions have the same probability in your answer: use the costs.",
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


product_of = Check(
    name="product_of",
    asks="the angle, x and z of the product T1 T2 … Tn of the rows",
    start="go through the rows and keep the angle so far; turn each step by it before you add it.",
    draw=lambda rng: (rng.normal(size=(rng.integers(2, 8), 3)) * [1.0, 2.0, 2.0],),
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


def _random_tree(rng: np.random.Generator) -> Tree:
    """Grow a tree with two or three ways on at each fork, three forks deep: children by node."""
    tree: Tree = {0: []}
    layer = [0]
    for _ in range(3):
        below: list[int] = []
        for node in layer:
            children = range(len(tree), len(tree) + int(rng.integers(2, 4)))
            tree[node] = [(float(rng.uniform(0, 1)), child) for child in children]
            tree |= {child: [] for child in children}
            below += children
        layer = below
    return tree


def _cheapest(tree: Tree, slip: str = "") -> tuple[float, int]:
    best, visited, stack = np.inf, 0, [(0.0, 0, 0.0)]
    while stack:
        cost, node, step = stack.pop()
        visited += slip == "counts skipped ones"
        if {"no bound": -1.0, "own cost": step}.get(slip, cost) >= best:
            continue
        visited += slip != "counts skipped ones"
        best = min(best, cost) if not tree[node] else best
        if slip == "stops early" and not tree[node]:
            break
        children = [(cost + g, child, g) for g, child in tree[node]]
        stack += children if slip == "no order" else sorted(children, reverse=slip != "expensive first")
    return best, visited


cheapest_way = Check(
    name="cheapest_way",
    asks="the cost of the cheapest way from node 0 to a leaf, and the number of visited nodes",
    start="keep a stack of (cost so far, node). Pop one; skip it if it costs as much as the best leaf; else "
    "count it, and push its children so that the cheapest is popped first.",
    draw=lambda rng: (_random_tree(rng),),
    truth=_cheapest,
    trials=20,
    mistakes=[
        Mistake(
            lambda tree: _cheapest(tree, "no bound"),
            "the cost is right, but you visit every node: skip what already costs as much as the best leaf.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "expensive first"),
            "the cost is right, but you try the most expensive child first: a stack is popped at its end.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "no order"),
            "the cost is right, but you take the children in any order: an early good leaf skips more.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "counts skipped ones"),
            "the cost is right, but a skipped node is not visited: count after the test.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "own cost"),
            "you compare the cost of the last edge; compare the cost of the whole way so far.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "stops early"),
            "you stop at the first leaf, as a greedy search does; another leaf may cost less.",
        ),
    ],
)


def _least(place: Array, goal: Array, steps: int, stride: float) -> float:
    return float(max(0.0, np.hypot(*(goal - place)) - steps * stride) ** 2)


least_cost = Check(
    name="least_cost",
    asks="the smallest squared distance from the goal that `steps` more steps can reach",
    start="a straight walk to the goal is the best case: how far from the goal does it end?",
    draw=lambda rng: (rng.normal(size=2) * 3, rng.normal(size=2) * 3, int(rng.integers(0, 8)), 0.7),
    truth=_least,
    mistakes=[
        Mistake(
            lambda place, goal, steps, stride: float((np.hypot(*(goal - place)) - steps * stride) ** 2),
            "a body that reaches the goal before its last step can stop there: the bound is 0.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(np.sum((goal - place) ** 2)),
            "that ignores the steps still to come: it is no lower bound, and could cut the best walk.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(max(0.0, np.hypot(*(goal - place)) - steps * stride)),
            "right in metres, but the cost is in square metres.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(
                max(0.0, np.sum((goal - place) ** 2) - (steps * stride) ** 2)
            ),
            "subtract the distances first, then square: a difference of squares is something else.",
        ),
    ],
)
