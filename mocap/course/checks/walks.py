"""Checks of notebook 07."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake, close, close_angles

Tree = dict[int, list[tuple[float, int]]]

choice_odds = Check(
    name="choice_odds",
    asks="one probability a transition, in proportion to 1 / (cost + 0.001), that add up to 1",
    start="take 1 / (costs + 0.001), and divide by the sum of that.",
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
            "in proportion, yes; but probabilities add up to 1: share them out.",
        ),
        Mistake(
            lambda costs: 1 / costs / np.sum(1 / costs),
            "a transition at no cost would take all, by a division by zero: add the millimetre first.",
        ),
        Mistake(
            lambda costs: np.full(len(costs), 1 / len(costs)),
            "all are alike to you; where do the costs come in?",
        ),
    ],
)


def _product(transforms: Array, turned: str = "before") -> tuple[float, float, float]:
    """Compose rows (angle, x, z); `turned` says by which angle each step is turned."""
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
    asks="the angle, x and z of all the transforms done one inside the other",
    start="go along the rows with the angle so far; turn each step by it before you add the step.",
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
            "you turn each step by its own angle too; a transform's step is in the world it leaves, so only "
            "the angles before it count.",
        ),
        Mistake(
            lambda transforms: _product(transforms, "backwards"),
            "you turn the steps the wrong way round: check the sign of the sine.",
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
        visited += slip == "counts cut ones"
        if {"no bound": -1.0, "own cost": step}.get(slip, cost) >= best:
            continue
        visited += slip != "counts cut ones"
        best = min(best, cost) if not tree[node] else best
        if slip == "stops early" and not tree[node]:
            break
        children = [(cost + g, child, g) for g, child in tree[node]]
        stack += children if slip == "no order" else sorted(children, reverse=slip != "dearest first")
    return best, visited


cheapest_way = Check(
    name="cheapest_way",
    asks="the cost of the cheapest way from node 0 to a leaf, and how many nodes were visited",
    start="keep a stack of (cost so far, node); pop one, skip it if it costs as much as the best leaf, else "
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
            lambda tree: _cheapest(tree, "dearest first"),
            "the cost is right, but you try the dearest child first: the end of the stack is popped first.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "no order"),
            "the cost is right, but the children come in any order: a good leaf early lets you cut more.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "counts cut ones"),
            "the cost is right; but a node that is cut was not visited: count after the test.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "own cost"),
            "you cut by the cost of the last edge; what counts is the cost of the whole way so far.",
        ),
        Mistake(
            lambda tree: _cheapest(tree, "stops early"),
            "you stop at the first leaf; that is greed, and another leaf may cost less.",
        ),
    ],
)


def _least(place: Array, goal: Array, steps: int, stride: float) -> float:
    return float(max(0.0, np.hypot(*(goal - place)) - steps * stride) ** 2)


least_cost = Check(
    name="least_cost",
    asks="the least squared distance from the goal that can be left after so many more steps",
    start="the straight way is the best case: how far from the goal is the body after walking it?",
    draw=lambda rng: (rng.normal(size=2) * 3, rng.normal(size=2) * 3, int(rng.integers(0, 8)), 0.7),
    truth=_least,
    mistakes=[
        Mistake(
            lambda place, goal, steps, stride: float((np.hypot(*(goal - place)) - steps * stride) ** 2),
            "a body that can reach the goal with steps to spare need not run past it: the bound is 0 there.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(np.sum((goal - place) ** 2)),
            "that forgets the steps still to come: it is no lower bound, and would cut the best walk.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(max(0.0, np.hypot(*(goal - place)) - steps * stride)),
            "in metres it is right; the cost is in square metres.",
        ),
        Mistake(
            lambda place, goal, steps, stride: float(
                max(0.0, np.sum((goal - place) ** 2) - (steps * stride) ** 2)
            ),
            "take the difference of the distances first, then square; squares do not subtract like that.",
        ),
    ],
)
