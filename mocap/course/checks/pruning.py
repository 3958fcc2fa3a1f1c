"""Random input and answers, right and wrong, for `06-pruning.toml`.

A graph is {node: the nodes that its edges lead to}.
"""

from collections.abc import Iterable, Mapping

import networkx as nx
import numpy as np

Successors = dict[int, list[int]]


def draw_graph(rng: np.random.Generator) -> Successors:
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}


def digraph(successors: Mapping[int, Iterable[int]]) -> nx.DiGraph:
    return nx.DiGraph({node: list(ends) for node, ends in successors.items()})


def after(successors: Successors, start: int) -> set[int]:
    return {int(node) for node in nx.descendants(digraph(successors), start)}


def on_cycle(successors: Successors, node: int) -> bool:
    return any(node in after(successors, end) | {end} for end in successors[node])


def stripped(successors: Successors, both_ways: bool) -> set[int]:
    """Remove nodes without a successor, or without a predecessor, until none are left."""
    left = digraph(successors)
    while poor := [n for n in left if not left.out_degree(n) or (both_ways and not left.in_degree(n))]:
        left.remove_nodes_from(poor)
    return set(successors) - set(left)


def same_members(given: Iterable[object], wanted: set[object]) -> bool:
    return set(given) == wanted


def same_sets(given: Iterable[Iterable[object]], wanted: Iterable[set[int]]) -> bool:
    parts = list(map(frozenset, given))
    return set(parts) == set(map(frozenset, wanted)) and len(set(parts)) == len(parts)


def tarjan(successors: Successors) -> list[set[int]]:
    """Find the strongly connected components as Tarjan does."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    components: list[set[int]] = []

    def visit(node: int) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        for child in successors[node]:
            if child not in index:
                visit(child)
                low[node] = min(low[node], low[child])
            elif child in stack:
                low[node] = min(low[node], index[child])
        if low[node] == index[node]:
            at = stack.index(node)
            components.append(set(stack[at:]))
            del stack[at:]

    for node in successors:
        if node not in index:
            visit(node)
    return components
