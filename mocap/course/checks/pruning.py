"""Checks of notebook 06. Graphs are {node: the nodes that its edges lead to}, or `networkx.DiGraph`."""

from collections.abc import Iterable, Mapping
from itertools import combinations, permutations

import networkx as nx
import numpy as np

from mocap.course.check import Check, Mistake

Successors = dict[int, list[int]]
Weighed = list[tuple[int, int, int]]  # start, end, frames


def _graph(rng: np.random.Generator) -> Successors:
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}


def _digraph(successors: Mapping[int, Iterable[int]]) -> nx.DiGraph:
    return nx.DiGraph({node: list(ends) for node, ends in successors.items()})


def _after(successors: Successors, start: int) -> set[int]:
    return {int(node) for node in nx.descendants(_digraph(successors), start)}


def _on_cycle(successors: Successors, node: int) -> bool:
    return any(node in _after(successors, end) | {end} for end in successors[node])


def _off_cycles(successors: Successors) -> set[int]:
    return {node for node in successors if not _on_cycle(successors, node)}


def _stripped(successors: Successors, both_ways: bool) -> set[int]:
    """Remove nodes without a successor, or without a predecessor, until none are left."""
    left = _digraph(successors)
    while poor := [n for n in left if not left.out_degree(n) or (both_ways and not left.in_degree(n))]:
        left.remove_nodes_from(poor)
    return set(successors) - set(left)


def _components(rng: np.random.Generator) -> tuple[list[set[int]], Weighed]:
    """Draw the components of a graph, and its edges with the frames that they play."""
    while True:
        graph = _digraph(_graph(rng))
        components = [set(part) for part in nx.strongly_connected_components(graph)]
        edges = [(a, b, int(rng.integers(5, 400))) for a, b in graph.edges]
        if any(_played(part, edges) for part in components):
            return components, edges


def _played(part: set[int], edges: Weighed) -> int:
    return sum(frames for start, end, frames in edges if start in part and end in part)


def _kinds(rng: np.random.Generator) -> tuple[nx.DiGraph, dict[str, set[int]]]:
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


def _without_way(graph: nx.Graph, kinds: Mapping[str, set[int]]) -> set[tuple[str, str]]:
    return {(a, b) for a, b in permutations(kinds, 2) if not _way(graph, kinds[a], kinds[b])}


def _way(graph: nx.Graph, here: set[int], there: set[int]) -> bool:
    return bool(nx.has_path(graph, min(here), min(there)))


def _same_members(given: Iterable[object], wanted: set[object]) -> bool:
    return set(given) == wanted


reachable = Check(
    name="reachable",
    asks="the set of nodes that a walk from `start` can reach, `start` included",
    start="keep the nodes seen so far, and a list of those whose successors you have not looked at yet.",
    draw=lambda rng: (_graph(rng), int(rng.integers(1, 4))),
    truth=lambda successors, start: {start} | _after(successors, start),
    same=_same_members,
    mistakes=[
        Mistake(
            lambda successors, start: {start, *successors[start]},
            "that is one step; go on from the nodes you have found.",
        ),
        Mistake(
            lambda successors, start: {*successors[start]}.union(*map(successors.get, successors[start])),
            "that is two steps; go on until no step finds a new node.",
        ),
        Mistake(
            lambda successors, start: set().union(*({e, *_after(successors, e)} for e in successors[start])),
            "`start` belongs to the set even if no way leads back to it.",
        ),
        Mistake(
            lambda successors, start: {start} | set(nx.ancestors(_digraph(successors), start)),
            "these are the nodes that lead to `start`: you go against the arrows.",
        ),
        Mistake(
            lambda successors, start: set(
                nx.node_connected_component(_digraph(successors).to_undirected(), start)
            ),
            "an edge leads in one direction only; you follow it in both.",
        ),
    ],
)

on_no_cycle = Check(
    name="on_no_cycle",
    asks="the set of nodes that lie on no cycle",
    start="a node is on a cycle if a way leads from one of its successors back to it.",
    draw=lambda rng: (_graph(rng),),
    truth=_off_cycles,
    same=_same_members,
    mistakes=[
        Mistake(
            lambda successors: {node for node, ends in successors.items() if not ends},
            "a node with successors can still be on no cycle: where do they lead?",
        ),
        Mistake(
            lambda successors: _stripped(successors, both_ways=False),
            "a node that no way leads back to is on no cycle, even if a walk from it never ends.",
        ),
        Mistake(
            lambda successors: _stripped(successors, both_ways=True),
            "you miss the nodes on the way from one cycle to another: they are on neither.",
        ),
        Mistake(
            lambda successors: {
                n for n in successors if not any(n in _after(successors, e) - {e} for e in successors[n])
            },
            "a node with an edge to itself is on a cycle, of one edge.",
        ),
    ],
)

component_to_keep = Check(
    name="component_to_keep",
    asks="the component whose edges play the most frames",
    start="for each component, add up the frames of the edges that stay within it; max() takes a `key`.",
    draw=_components,
    truth=lambda components, edges: max(components, key=lambda part: _played(part, edges)),
    same=_same_members,
    mistakes=[
        Mistake(
            lambda components, edges: max(components, key=len),
            "that has the most nodes; a walk plays edges, so count their frames.",
        ),
        Mistake(
            lambda components, edges: max(components, key=lambda p: sum(f for a, _, f in edges if a in p)),
            "an edge that leaves the component is not part of it: both its ends must be inside.",
        ),
        Mistake(
            lambda components, edges: max(components, key=lambda p: sum(f for _, b, f in edges if b in p)),
            "an edge that enters the component is not part of it: both its ends must be inside.",
        ),
        Mistake(
            lambda components, edges: max(
                components, key=lambda p: sum(a in p and b in p for a, b, _ in edges)
            ),
            "that has the most edges; some are long and some short, so count their frames.",
        ),
    ],
)

missing_ways = Check(
    name="missing_ways",
    asks="the set of ordered pairs (from, to) of kinds without a way from the first to the second",
    start="try all ordered pairs; nx.has_path(graph, a, b) says whether a way leads from a to b.",
    draw=_kinds,
    truth=_without_way,
    same=_same_members,
    mistakes=[
        Mistake(
            lambda graph, kinds: {
                pair for pair in combinations(kinds, 2) if not _way(graph, kinds[pair[0]], kinds[pair[1]])
            },
            "a way from a to b is not a way from b to a: try both orders.",
        ),
        Mistake(
            lambda graph, kinds: _without_way(graph.to_undirected(), kinds),
            "edges lead in one direction only; you follow them in both.",
        ),
        Mistake(
            lambda graph, kinds: _without_way(graph.reverse(), kinds),
            "your pairs are reversed: they must be (from, to).",
        ),
        Mistake(
            lambda graph, kinds: {
                (a, b)
                for a, b in permutations(kinds, 2)
                if not any(graph.has_edge(m, n) for m in kinds[a] for n in kinds[b])
            },
            "a way may lead through other nodes; you look for a single edge.",
        ),
        Mistake(
            lambda graph, kinds: set(permutations(kinds, 2)) - _without_way(graph, kinds),
            "those are the pairs with a way; return those without.",
        ),
    ],
)
