"""Strongly connected components of a motion graph, and the nodes that a walk can reach."""

from collections.abc import Hashable, Iterable
from itertools import chain, compress

import networkx as nx
import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from mocap._shared.arrays import Indices, Mask

Labels = frozenset[str]
Nodes = frozenset[Hashable]

NO_LABELS: Labels = frozenset()


def largest_components(graph: nx.MultiDiGraph, by_labels: bool) -> dict[Labels, tuple[Nodes, int]]:
    """Find the largest strongly connected component by frames of clips, of all edges or for each label set.

    Parameters
    ----------
    graph : the graph.
    by_labels : whether to find a component for each label set, from the edges with exactly these labels.

    Returns
    -------
    For each label set, the nodes of its component (none if it has no cycle) and the number of its frames of
    clips.

    Examples
    --------
    Two nodes walk, two nodes run:

    >>> graph = nx.MultiDiGraph()
    >>> walk, run = frozenset({"walk"}), frozenset({"run"})
    >>> _ = graph.add_edges_from([(1, 2), (2, 1)], kind="clip", frames=9, labels=walk)
    >>> _ = graph.add_edges_from([(3, 4), (4, 3)], kind="clip", frames=5, labels=run)
    >>> components = largest_components(graph, by_labels=True)
    >>> {min(labels): (sorted(nodes), frames) for labels, (nodes, frames) in components.items()}
    {'walk': ([1, 2], 18), 'run': ([3, 4], 10)}

    Notebook: 06b-pruning-clips
    """
    ends = numbered_edges(graph)
    edges = [edge for _, _, edge in graph.edges(data=True)]
    frames = np.array([edge["frames"] if edge["kind"] == "clip" else 0 for edge in edges], int)
    rows: dict[Labels, list[int]] = {}  # the edges with each label set
    for row, edge in enumerate(edges):
        labels = edge.get("labels", NO_LABELS) if by_labels else NO_LABELS
        rows.setdefault(labels, []).append(row)
    components = {}
    for labels, chosen in rows.items():
        inside, played = largest_component(ends[chosen], frames[chosen], len(graph))
        components[labels] = (frozenset(compress(graph, inside)), played)
    return components


def largest_component(edges: Indices, frames: Indices, count: int) -> tuple[Mask, int]:
    """Find the strongly connected component with the most frames. Ties are broken by the number of edges.

    Parameters
    ----------
    edges : start and end nodes, numbers from 0 to count - 1, shape (E, 2).
    frames : the number of frames that each edge plays, shape (E,).
    count : the number of nodes.

    Returns
    -------
    A mask of the nodes of the component, shape (count,), and the number of its frames. The mask is False
    everywhere if there is no cycle.

    Examples
    --------
    >>> largest_component(np.array([[0, 1], [1, 0], [1, 2], [2, 2]]), np.array([3, 4, 9, 5]), 3)
    (array([ True,  True, False]), 7)

    Notebook: 06b-pruning-clips
    """
    adjacency = coo_array((np.ones(len(edges), bool), tuple(edges.T)), shape=(count, count))
    _, component = connected_components(adjacency, directed=True, connection="strong")  # of each node
    start, end = component[edges].T
    inside = start == end
    if not inside.any():
        return np.zeros(count, bool), 0
    edge_counts = np.bincount(start[inside])
    frame_counts = np.bincount(start[inside], frames[inside])
    largest = np.lexsort([edge_counts, frame_counts])[-1]
    return component == largest, int(frame_counts[largest])


def numbered_edges(graph: nx.MultiDiGraph) -> Indices:
    """Return the edges of a graph as pairs of numbers, which count its nodes in their order, shape (E, 2).

    Examples
    --------
    >>> numbered_edges(nx.MultiDiGraph([("a", "b"), ("b", "c"), ("b", "a")])).tolist()
    [[0, 1], [1, 2], [1, 0]]

    Notebook: 06b-pruning-clips
    """
    number = {node: index for index, node in enumerate(graph)}
    return np.array([(number[start], number[end]) for start, end in graph.edges()], int).reshape(-1, 2)


def on_cycles(edges: Indices, count: int) -> Mask:
    """Tell which of `count` nodes are on a cycle, which may consist of a single edge.

    Examples
    --------
    >>> on_cycles(np.array([[0, 1], [1, 0], [1, 2], [3, 3]]), 4)
    array([ True,  True, False,  True])
    """
    adjacency = coo_array((np.ones(len(edges), bool), tuple(edges.T)), shape=(count, count))
    _, component = connected_components(adjacency, directed=True, connection="strong")
    is_on_cycle = np.bincount(component)[component] > 1
    is_on_cycle[edges[edges[:, 0] == edges[:, 1], 0]] = True
    return np.asarray(is_on_cycle)


def reachable(edges: Indices, starts: Mask) -> Mask:
    """Tell which nodes are reachable from some start nodes, including these, all given by their numbers.

    Examples
    --------
    >>> reachable(np.array([[0, 1], [1, 2], [3, 0]]), np.array([True, False, False, False]))
    array([ True,  True,  True, False])
    """
    count = len(starts)
    # One more node, from which an edge leads to each start node.
    first_edges = np.stack([np.full(starts.sum(), count), np.flatnonzero(starts)], axis=1)
    all_edges = np.concatenate([edges, first_edges])
    ones = np.ones(len(all_edges), bool)
    adjacency = csr_array((ones, tuple(all_edges.T)), shape=(count + 1, count + 1))
    visited = np.zeros(count + 1, bool)
    visited[breadth_first_order(adjacency, count, return_predecessors=False)] = True
    return visited[:-1]


def reached(graph: nx.MultiDiGraph, start: Iterable[Hashable]) -> set[Hashable]:
    """Find all nodes that are reachable from some start nodes, including these.

    Examples
    --------
    >>> sorted(reached(nx.MultiDiGraph([(1, 2), (2, 3), (4, 1)]), [1]))
    [1, 2, 3]
    """
    return set(chain.from_iterable(nx.bfs_layers(graph, start)))
