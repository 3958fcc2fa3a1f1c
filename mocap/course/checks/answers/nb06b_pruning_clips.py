"""Notebook 06b: inputs, right answers and mistakes of `why_removed` and `missing_ways`."""

from itertools import combinations, permutations

import networkx as nx
import numpy as np

from mocap.course.checks.answers.common import Arguments, draw_graph


def leads(graph: nx.DiGraph, ring: set[int], target: set[int]) -> bool:
    """Return whether a way leads from one ring of nodes to another."""
    return bool(nx.has_path(graph, min(ring), min(target)))


def joined(graph: nx.DiGraph, ring: set[int], target: set[int]) -> bool:
    """Return whether a single edge leads from one ring of nodes to another."""
    return any(True for _ in nx.edge_boundary(graph, ring, target))


# ---- why_removed


def draw_why_removed(rng: np.random.Generator) -> Arguments:
    """Draw a graph and its strongly connected component of most nodes."""
    graph: dict[int, list[int]] = {}
    kept: set[int] = set()
    while not 1 < len(kept) < len(graph):
        graph = draw_graph(rng)
        kept = max(nx.strongly_connected_components(nx.DiGraph(graph)), key=len)
    return graph, kept


def right_why_removed(successors: dict[int, list[int]], kept: set[int]) -> dict[int, str]:
    """Return why each node is removed: it is on no cycle, or one way to the kept ones is missing."""
    graph = nx.DiGraph(successors)
    reasons = {}
    for node in successors.keys() - kept:
        on_cycle = any(nx.has_path(graph, end, node) for end in successors[node])
        reason = "unreached" if nx.descendants(graph, node) & kept else "sink"
        reasons[node] = reason if on_cycle else "dead end"
    return reasons


def reworded(reasons: dict[int, str], words: dict[str, str]) -> dict[int, str]:
    """Exchange words in the reasons."""
    return {node: words.get(reason, reason) for node, reason in reasons.items()}


def mistake_dead_ends_with_edges_as_sinks(successors: dict[int, list[int]], kept: set[int]) -> object:
    """Return 'sink' for nodes on no cycle that have successors, and otherwise the right reasons."""
    return {
        node: "sink" if reason == "dead end" and successors[node] else reason
        for node, reason in right_why_removed(successors, kept).items()
    }


def mistake_unreached_as_sinks(successors: dict[int, list[int]], kept: set[int]) -> object:
    """Return 'sink' for all removed nodes on a cycle, and the right reason for the others."""
    return reworded(right_why_removed(successors, kept), {"unreached": "sink"})


def mistake_exchanged(successors: dict[int, list[int]], kept: set[int]) -> object:
    """Return 'sink' for 'unreached', and 'unreached' for 'sink'."""
    return reworded(right_why_removed(successors, kept), {"unreached": "sink", "sink": "unreached"})


def mistake_reason_for_all(successors: dict[int, list[int]], kept: set[int]) -> object:
    """Return the right reasons, and 'sink' for the nodes that are kept."""
    reasons = right_why_removed(successors, kept)
    return {node: reasons.get(node, "sink") for node in successors}


def mistake_dead_ends_as_sinks(successors: dict[int, list[int]], kept: set[int]) -> object:
    """Return 'sink' for all nodes on no cycle, and otherwise the right reasons."""
    return reworded(right_why_removed(successors, kept), {"dead end": "sink"})


# ---- missing_ways


def draw_missing_ways(rng: np.random.Generator) -> Arguments:
    """Draw a graph of rings, some joined by an edge, some by a node that is in no ring."""
    graph = nx.DiGraph()
    kinds = {}
    for first, kind in zip((0, 10, 20, 30), ("walk", "jog", "sneak", "stand"), strict=True):
        ring = list(range(first, first + int(rng.integers(2, 5))))
        nx.add_cycle(graph, ring)
        kinds[kind] = set(ring)
    graph.add_edge(*rng.choice([0, 10, 20, 30], 2, replace=False).tolist())
    start, end = rng.choice([0, 10, 20, 30], 2, replace=False).tolist()
    nx.add_path(graph, [start, 99, end])
    return graph, kinds


def right_missing_ways(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> set[tuple[str, str]]:
    """Return the pairs of kinds of motion between which no walk leads."""
    return {(a, b) for a, b in permutations(kinds, 2) if not leads(graph, kinds[a], kinds[b])}


def mistake_one_order(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> object:
    """Return the pairs without a walk from the kind listed first to the other, not in reverse."""
    return {(a, b) for a, b in combinations(kinds, 2) if not leads(graph, kinds[a], kinds[b])}


def mistake_both_directions(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> object:
    """Return the pairs between which no path leads in the undirected graph."""
    return right_missing_ways(graph.to_undirected(), kinds)


def mistake_reversed_pairs(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> object:
    """Return the pairs (a, b) without a walk from b to a."""
    return right_missing_ways(graph.reverse(), kinds)


def mistake_single_edges(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> object:
    """Return the pairs that no single edge joins, even if a longer walk does."""
    return {(a, b) for a, b in permutations(kinds, 2) if not joined(graph, kinds[a], kinds[b])}


def mistake_pairs_with_a_way(graph: nx.DiGraph, kinds: dict[str, set[int]]) -> object:
    """Return the pairs with a walk from the first kind to the second."""
    return set(permutations(kinds, 2)) - right_missing_ways(graph, kinds)
