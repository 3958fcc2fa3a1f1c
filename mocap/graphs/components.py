"""Strongly connected components of a motion graph, and the nodes that a walk can reach."""

from collections.abc import Hashable, Iterable
from itertools import chain, compress

import networkx as nx
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from mocap._shared.arrays import Indices, Mask

Labels = frozenset[str]
Nodes = frozenset[Hashable]

NO_LABELS: Labels = frozenset()


def largest_components(graph: nx.MultiDiGraph, by_labels: bool) -> dict[Labels, tuple[Nodes, int]]:
    """Find the strongly connected component that plays most frames of clip, of all edges or per label set.

    Parameters
    ----------
    graph : the graph.
    by_labels : whether to find one component for each label set, from the edges with exactly these labels.

    Returns
    -------
    For each label set the nodes of its component (none where it has no cycle), and its frames of clip.

    Examples
    --------
    Two nodes walk, two nodes run:

    >>> graph = nx.MultiDiGraph()
    >>> walk, run = frozenset({"walk"}), frozenset({"run"})
    >>> _ = graph.add_edges_from([(1, 2), (2, 1)], kind="clip", frames=9, labels=walk)
    >>> _ = graph.add_edges_from([(3, 4), (4, 3)], kind="clip", frames=5, labels=run)
    >>> found = largest_components(graph, by_labels=True)
    >>> {min(labels): (sorted(nodes), frames) for labels, (nodes, frames) in found.items()}
    {'walk': ([1, 2], 18), 'run': ([3, 4], 10)}

    Notebook: 06b-pruning-clips
    """
    number = {node: n for n, node in enumerate(graph)}
    ways = np.array([(number[a], number[b]) for a, b in graph.edges()], int).reshape(-1, 2)
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


def largest_component(ways: Indices, frames: Indices, count: int) -> tuple[Mask, int]:
    """Find the strongly connected component that plays most frames; of equal ones, the one with most edges.

    Parameters
    ----------
    ways : edges from node to node, numbers from 0 to count - 1, shape (E, 2).
    frames : frames that each edge plays, shape (E,).
    count : the number of nodes.

    Returns
    -------
    Which nodes are in the component, shape (count,), and its frames; no nodes where there is no cycle.

    Examples
    --------
    >>> largest_component(np.array([[0, 1], [1, 0], [1, 2], [2, 2]]), np.array([3, 4, 9, 5]), 3)
    (array([ True,  True, False]), 7)

    Notebook: 06b-pruning-clips
    """
    matrix = coo_array((np.ones(len(ways), bool), tuple(ways.T)), shape=(count, count))
    part = connected_components(matrix, directed=True, connection="strong")[1]  # the number of each node's
    start, end = part[ways].T
    inside = start == end
    if not inside.any():
        return np.zeros(count, bool), 0
    edges = np.bincount(start[inside])
    played = np.bincount(start[inside], frames[inside])
    best = np.lexsort([edges, played])[-1]
    return part == best, int(played[best])


def reached(graph: nx.MultiDiGraph, start: Iterable[Hashable]) -> set[Hashable]:
    """Find the nodes that a walk from some nodes can reach, and these nodes themselves.

    Examples
    --------
    >>> sorted(reached(nx.MultiDiGraph([(1, 2), (2, 3), (4, 1)]), [1]))
    [1, 2, 3]
    """
    return set(chain.from_iterable(nx.bfs_layers(graph, start)))
