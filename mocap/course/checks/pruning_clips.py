"""Random input and answers, right and wrong, for `06b-pruning-clips.toml`.

A graph is {node: the nodes that its edges lead to}, or a `networkx.DiGraph`.
"""

from collections.abc import Mapping
from itertools import combinations, permutations

import networkx as nx
import numpy as np

from mocap.course.checks.pruning import Successors, after, digraph, draw_graph, on_cycle, same_members

Weighed = list[tuple[int, int, int]]  # start, end, frames


def draw_component_to_keep(rng: np.random.Generator) -> tuple[list[set[int]], Weighed]:
    """Draw the components of a graph, and its edges with the frames that they play."""
    while True:
        graph = digraph(draw_graph(rng))
        components = [set(part) for part in nx.strongly_connected_components(graph)]
        edges = [(a, b, int(rng.integers(5, 400))) for a, b in graph.edges]
        if any(played(part, edges) for part in components):
            return components, edges


def played(part: set[int], edges: Weighed) -> int:
    return sum(frames for start, end, frames in edges if start in part and end in part)


def draw_missing_ways(rng: np.random.Generator) -> tuple[nx.DiGraph, dict[str, set[int]]]:
    """Draw a graph of rings, some joined by an edge, some by a node that is in no ring."""
    graph, kinds = nx.DiGraph(), {}
    for first, kind in zip((0, 10, 20, 30), ("walk", "jog", "sneak", "stand"), strict=True):
        ring = list(range(first, first + int(rng.integers(2, 5))))
        nx.add_cycle(graph, ring)
        kinds[kind] = set(ring)
    graph.add_edge(*rng.choice([0, 10, 20, 30], 2, replace=False).tolist())
    here, there = rng.choice([0, 10, 20, 30], 2, replace=False).tolist()
    nx.add_path(graph, [here, 99, there])
    return graph, kinds


def without_way(graph: nx.Graph, kinds: Mapping[str, set[int]]) -> set[tuple[str, str]]:
    return {(a, b) for a, b in permutations(kinds, 2) if not way(graph, kinds[a], kinds[b])}


def way(graph: nx.Graph, here: set[int], there: set[int]) -> bool:
    return bool(nx.has_path(graph, min(here), min(there)))


def draw_why_removed(rng: np.random.Generator) -> tuple[Successors, set[int]]:
    """Draw a graph and its strongly connected component of most nodes."""
    while True:
        graph = draw_graph(rng)
        kept = max(nx.strongly_connected_components(digraph(graph)), key=len)
        if 1 < len(kept) < len(graph):
            return graph, {int(node) for node in kept}


def reasons(successors: Successors, kept: set[int]) -> dict[int, str]:
    found = {}
    for node in successors.keys() - kept:
        if not on_cycle(successors, node):
            found[node] = "dead end"
        else:
            found[node] = "unreached" if after(successors, node) & kept else "sink"
    return found
