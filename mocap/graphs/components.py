"""Strongly connected components of a motion graph, and what can be reached from where."""

from collections.abc import Hashable, Iterable
from itertools import compress

import networkx as nx
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Labels = frozenset[str]
Nodes = frozenset[Hashable]
Indices = NDArray[np.int64]

NO_LABELS: Labels = frozenset()


def numbered_edges(graph: nx.MultiDiGraph) -> Indices:
    """Write a graph's edges as rows (start, end) of node numbers, in the order of its nodes: shape (E, 2).

    Notebook: 06-pruning
    """
    number = {node: n for n, node in enumerate(graph)}
    return np.array([(number[a], number[b]) for a, b in graph.edges()], int).reshape(-1, 2)


def largest_components(
    graph: nx.MultiDiGraph, ways: Indices, by_labels: bool
) -> dict[Labels, tuple[Nodes, int]]:
    """Find the largest component of each label set, or of all edges.

    Parameters
    ----------
    graph, ways : the graph, and its edges as `numbered_edges` gives them.
    by_labels : whether each label set has a component of its own.

    Returns
    -------
    For each label set the nodes of its component, none where it has no cycle, and its frames of clip.

    Notebook: 06-pruning
    """
    edges = [edge for _, _, edge in graph.edges(data=True)]
    frames = np.array([edge["frames"] * (edge["kind"] == "clip") for edge in edges], int)
    labels = [edge.get("labels", NO_LABELS) if by_labels else NO_LABELS for edge in edges]
    sets = {one: n for n, one in enumerate(dict.fromkeys(labels))}
    which = np.array([sets[one] for one in labels], int)
    found = {}
    for one, n in sets.items():
        inside, count = largest_component(ways[which == n], frames[which == n], len(graph))
        found[one] = (frozenset(compress(graph, inside)), count)
    return found


def largest_component(ways: Indices, frames: Indices, count: int) -> tuple[NDArray[np.bool_], int]:
    """Find the strongly connected component that plays most frames; of equal ones, that with most edges.

    Parameters
    ----------
    ways : edges from node to node, numbers from 0 to count - 1, shape (E, 2).
    frames : what each plays, shape (E,).
    count : how many nodes there are.

    Returns
    -------
    Which nodes are in it, shape (count,), and its frames; none of them where there is no cycle.

    Examples
    --------
    >>> largest_component(np.array([[0, 1], [1, 0], [1, 2], [2, 2]]), np.array([3, 4, 9, 5]), 3)
    (array([ True,  True, False]), 7)

    Notebook: 06-pruning
    """
    part = component_numbers(ways, count)
    start, end = part[ways].T
    inside = start == end
    if not inside.any():
        return np.zeros(count, bool), 0
    edges = np.bincount(start[inside])
    played = np.bincount(start[inside], frames[inside])
    best = np.lexsort([edges, played])[-1]
    return part == best, int(played[best])


def component_numbers(ways: Indices, count: int) -> Indices:
    """Give each node the number of its strongly connected component, shape (count,).

    Parameters
    ----------
    ways, count : edges from node to node, and how many nodes there are; as for `largest_component`.

    Notebook: 06-pruning
    """
    matrix = coo_array((np.ones(len(ways), bool), tuple(ways.T)), shape=(count, count))
    return np.asarray(connected_components(matrix, directed=True, connection="strong")[1])


def induced(graph: nx.MultiDiGraph, kept: Nodes) -> nx.MultiDiGraph:
    """Copy the kept nodes, and all edges from one of them to another, in their order."""
    part = nx.MultiDiGraph(**graph.graph)
    part.add_nodes_from((node, data) for node, data in graph.nodes(data=True) if node in kept)
    part.add_edges_from(
        (start, end, key, data)
        for start, end, key, data in graph.edges(keys=True, data=True)
        if start in kept and end in kept
    )
    return part


def reached(graph: nx.MultiDiGraph, start: Iterable[Hashable]) -> set[Hashable]:
    """Collect the nodes that a walk from some nodes can come to, these nodes among them.

    Notebook: 06-pruning
    """
    seen = set(start)
    waiting = list(seen)
    while waiting:
        new = set(graph.successors(waiting.pop())) - seen
        seen |= new
        waiting += new
    return seen
