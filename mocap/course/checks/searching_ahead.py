"""Random input and answers, right and wrong, for `07b-searching-ahead.toml`."""

import numpy as np

from mocap._shared.arrays import Array

Graph = dict[int, list[int]]


def draw_count_walks(rng: np.random.Generator) -> tuple[Graph, int, int]:
    """Draw a graph of two to six nodes, with up to three edges each, two of which may lead to one node."""
    count = int(rng.integers(2, 7))
    graph = {node: rng.integers(0, count, rng.integers(1, 4)).tolist() for node in range(count)}
    return graph, int(rng.integers(count)), int(rng.integers(1, 8))


def counted(graph: Graph, node: int, edges: int) -> int:
    """Count walks from the end: those of n edges start with one edge, and n - 1 are left."""
    walks = dict.fromkeys(graph, 1)  # the empty walk
    for _ in range(edges):
        walks = {n: sum(walks[end] for end in ends) for n, ends in graph.items()}
    return walks[node]


def end_nodes(graph: Graph, node: int, edges: int) -> int:
    ends = {node}
    for _ in range(edges):
        ends = {end for start in ends for end in graph[start]}
    return len(ends)


def off(points: Array, before: int, goal: complex, frames: int) -> float:
    """Add up the squared distances from a point that walks straight to the goal in so many frames."""
    made = before + np.arange(1, len(points) + 1)
    wanted = goal * np.minimum(1, made / frames)
    return float((np.abs(points - wanted) ** 2).sum())
