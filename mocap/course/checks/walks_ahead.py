"""Checks of notebook 07b."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake

Graph = dict[int, list[int]]


def _random_graph(rng: np.random.Generator) -> tuple[Graph, int, int]:
    """Draw a graph of two to six nodes, with up to three edges each, two of which may lead to one node."""
    count = int(rng.integers(2, 7))
    graph = {node: rng.integers(0, count, rng.integers(1, 4)).tolist() for node in range(count)}
    return graph, int(rng.integers(count)), int(rng.integers(1, 8))


def _count(graph: Graph, node: int, edges: int, slip: str = "") -> int:
    walks = dict.fromkeys(graph, 1)  # the empty walk
    total = 1
    for _ in range(edges + {"one too many": 1, "one too few": -1}.get(slip, 0)):
        follow = {n: set(after) if slip == "once each" else after for n, after in graph.items()}
        walks = {n: sum(walks[end] for end in after) for n, after in follow.items()}
        total += walks[node]
    return total if slip == "shorter ones too" else walks[node]


def _ends(graph: Graph, node: int, edges: int) -> int:
    ends = {node}
    for _ in range(edges):
        ends = {end for start in ends for end in graph[start]}
    return len(ends)


count_walks = Check(
    name="count_walks",
    asks="how many walks of exactly so many edges start at the node",
    start="one walk has no edge: the empty one. A walk of n edges is an edge and a walk of n - 1 edges from "
    "its end, so make a table for 0, 1, 2, ... edges.",
    draw=_random_graph,
    truth=_count,
    mistakes=[
        Mistake(
            lambda graph, node, edges: _count(graph, node, edges, "shorter ones too"),
            "you count the shorter walks too: only those of exactly so many edges are asked for.",
        ),
        Mistake(
            lambda graph, node, edges: _count(graph, node, edges, "once each"),
            "two edges to the same node are two ways on: do not turn the list into a set.",
        ),
        Mistake(
            lambda graph, node, edges: _count(graph, node, edges, "one too many"),
            "your walks have one edge too many: the table of 0 edges is 1 everywhere.",
        ),
        Mistake(
            lambda graph, node, edges: _count(graph, node, edges, "one too few"),
            "your walks have one edge too few: the table of 0 edges is 1 everywhere.",
        ),
        Mistake(
            _ends,
            "you count the nodes at which walks end; several walks may end at one node.",
        ),
        Mistake(
            lambda graph, node, edges: len(graph[node]) ** edges,
            "that holds only where every node has as many edges as the first: add up over the ends instead.",
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


def _off(points: Array, before: int, goal: complex, frames: int, slip: str = "") -> float:
    """Add up the squared distances from a point that walks straight to the goal in so many frames."""
    made = before + np.arange(len(points)) + (slip != "from zero")
    share = made / frames if slip == "past the goal" else np.minimum(1, made / frames)
    if slip == "own clock":
        share = np.minimum(1, np.arange(1, len(points) + 1) / frames)
    wanted = np.full(len(points), goal) if slip == "goal" else goal * share
    far = np.abs(points - wanted)
    return float(far.sum() if slip == "not squared" else far[-1] ** 2 if slip == "last" else (far**2).sum())


price_on_the_way = Check(
    name="price_on_the_way",
    asks="the sum of the squared distances between the root and the point where it should be, m²",
    start="frame i of the edge (from 0) is frame before + i + 1 of the walk; by then the root should "
    "have made "
    "that share of the way to the goal, and at most all of it.",
    draw=lambda rng: (
        rng.normal(size=(n := int(rng.integers(1, 12)))) + 1j * rng.normal(size=n),
        int(rng.integers(0, 60)),
        complex(*rng.normal(size=2) * 3),
        int(rng.integers(30, 60)),
    ),
    truth=_off,
    trials=60,
    mistakes=[
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "goal"),
            "you measure to the goal itself; measure to the point that is on its way there.",
        ),
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "own clock"),
            "the wanted point starts again with each edge: count the frames walked before it, too.",
        ),
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "from zero"),
            "your wanted point is one frame late: the first frame of the walk is number 1.",
        ),
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "past the goal"),
            "your wanted point runs past the goal: its share of the way is at most 1.",
        ),
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "not squared"),
            "you add up distances; the cost is the sum of their squares.",
        ),
        Mistake(
            lambda points, before, goal, frames: _off(points, before, goal, frames, "last"),
            "you price only the last frame of the edge; add up over all of its frames.",
        ),
    ],
)
