"""Checks of notebook 06b. A graph is {node: the nodes that its edges lead to}, or a `networkx.DiGraph`."""

from collections.abc import Mapping
from itertools import combinations, permutations

import networkx as nx
import numpy as np

from mocap.course.check import Check, Mistake
from mocap.course.checks.pruning import Successors, _after, _digraph, _graph, _on_cycle, _same_members

Weighed = list[tuple[int, int, int]]  # start, end, frames


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


def _kept(rng: np.random.Generator) -> tuple[Successors, set[int]]:
    """Draw a graph and its strongly connected component of most nodes."""
    while True:
        graph = _graph(rng)
        kept = max(nx.strongly_connected_components(_digraph(graph)), key=len)
        if 1 < len(kept) < len(graph):
            return graph, {int(node) for node in kept}


def _why(successors: Successors, kept: set[int]) -> dict[int, str]:
    return {
        node: "dead end"
        if not _on_cycle(successors, node)
        else ("unreached" if _after(successors, node) & kept else "sink")
        for node in successors
        if node not in kept
    }


def _but(successors: Successors, kept: set[int], **other: str) -> dict[int, str]:
    """Give the reasons with some of them replaced."""
    return {
        node: other.get(reason.replace(" ", "_"), reason) for node, reason in _why(successors, kept).items()
    }


why_removed = Check(
    name="why_removed",
    asks="a dictionary from each node that goes to 'dead end', 'sink' or 'unreached'",
    start="on no cycle: dead end. On a cycle: does a way lead from the node to one that stays?",
    draw=_kept,
    truth=_why,
    mistakes=[
        Mistake(
            lambda successors, kept: {
                n: "sink" if why == "dead end" and successors[n] else why
                for n, why in _why(successors, kept).items()
            },
            "a node that edges leave can be on no cycle too, and then it is a dead end.",
        ),
        Mistake(
            lambda successors, kept: _but(successors, kept, unreached="sink"),
            "a node on a cycle from which a way leads to what stays is no sink: nothing leads back to it.",
        ),
        Mistake(
            lambda successors, kept: _but(successors, kept, sink="unreached", unreached="sink"),
            "'sink' and 'unreached' are exchanged: a walk can enter a sink and cannot leave it.",
        ),
        Mistake(
            lambda successors, kept: {n: _why(successors, kept).get(n, "sink") for n in successors},
            "give no reason for the nodes that stay.",
        ),
        Mistake(
            lambda successors, kept: _but(successors, kept, dead_end="sink"),
            "a node on no cycle is a dead end, even if only sinks follow it.",
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
