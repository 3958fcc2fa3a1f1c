"""Pruning: cut away what a walk could not leave, or not come back to [KGP02, 3.4].

A walk that shall go on for ever, anywhere it likes, needs a strongly connected graph: one in which every node
reaches every other. So the largest strongly connected component is kept. To get every kind of motion that the
clips are labelled with, it is kept once for each set of labels, of those edges that bear exactly these; then
whatever leads from one kept node to another stays as well. The paper lets only transitions lead from kept
component to kept component. Here a stretch of clip that passes from walking to running may, too: nobody
blends it better than the performer did.

The functions take any `networkx.MultiDiGraph`. Of its edges they read `frames`, `kind` and, where they are
asked to, `labels`.
"""

import warnings
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from itertools import compress, permutations

import networkx as nx
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from mocap.collecting import uncollected
from mocap.errors import MocapWarning, NoWalk

Labels = frozenset[str]
Nodes = frozenset[Hashable]
Edge = tuple[Hashable, Hashable, int]  # start, end, key
Indices = NDArray[np.int64]

NO_LABELS: Labels = frozenset()


class Reason(StrEnum):
    """Why an edge goes: what is wrong with the node at one of its ends."""

    DEAD_END = "dead end: on no cycle"
    SINK = "sink: on a cycle, but reaches nothing that stays"
    UNREACHED = "unreached: on a cycle, but nothing that stays leads there"
    ASIDE = "aside: on no cycle of one label set, or only on a smaller component's"


@dataclass(frozen=True)
class Pruning:
    """What pruning left, and what it took.

    Parameters
    ----------
    graph : the nodes and edges that stay.
    components : for each label set the nodes of its kept component, none where it has no cycle; without
        labels, one entry for the empty set.
    removed : every edge that went, and why.
    orphans : the nodes that went with their last edge.
    """

    graph: nx.MultiDiGraph
    components: Mapping[Labels, Nodes]
    removed: Mapping[Edge, Reason]
    orphans: tuple[Hashable, ...]

    def report(self) -> str:
        """Tell in a few lines what stays, and how many edges went for which reason."""
        lines = [f"kept {self.graph.number_of_nodes()} nodes and {self.graph.number_of_edges()} edges"]
        if len(self.components) > 1:
            lines += [f"  {len(nodes)} nodes: {name(labels)}" for labels, nodes in self.components.items()]
        lines.append(f"removed {len(self.orphans)} nodes and {len(self.removed)} edges")
        counts = Counter(self.removed.values())
        lines += [f"  {counts[reason]} edges: {reason}" for reason in Reason if counts[reason]]
        return "\n".join(lines)


def name(labels: Labels) -> str:
    """Write a label set, as in "turn+walk".

    Notebook: 06-pruning
    """
    return "+".join(sorted(labels)) or "no label"


def notes_example() -> nx.MultiDiGraph:
    """Give the eight-node graph of the notes, after [KGP02, Fig. 4]: node 5 is a dead end, node 4 a sink.

    Examples
    --------
    >>> found = prune_graph(notes_example())
    >>> sorted(found.graph), sorted(found.orphans)
    ([1, 2, 3, 6, 7, 8], [4, 5])

    Notebook: 06-pruning
    """
    graph = nx.MultiDiGraph()
    ends = [(1, 2), (2, 3), (2, 6), (3, 1), (3, 4), (4, 4), (6, 5), (6, 7), (7, 5), (7, 8), (8, 3)]
    graph.add_edges_from(ends, kind="clip", frames=30, labels=NO_LABELS)
    return graph


@uncollected()
def prune_graph(graph: nx.MultiDiGraph, *, by_labels: bool = False, least_frames: int = 1) -> Pruning:
    """Keep the largest strongly connected component, of all edges or of every label set's.

    Largest is the one whose stretches of clip have most frames. The time is linear in the edges; by labels,
    in the edges times the label sets that stay.

    Parameters
    ----------
    graph : left as it is.
    by_labels : keep a component for each label set, and the edges between these.
    least_frames : a warning tells of every label set whose component has fewer frames of clip. Sets that are
        no more than smaller sets put together do not count: they mark the passages from kind to kind.

    Returns
    -------
    What stays, a graph of its own, in which no walk ever ends; and what went.

    Raises
    ------
    NoWalk : where there is no cycle, or none of one label set, so that every walk ends.

    Warns
    -----
    MocapWarning : for label sets with too few frames, and for ordered pairs without a way from the first
        component to the second.

    Notebook: 06-pruning
    """
    ways = numbered_edges(graph)
    found = largest_components(graph, ways, by_labels)
    components = {labels: nodes for labels, (nodes, _) in found.items() if nodes}
    if not components:
        one = " of edges with the same labels" if len(found) > 1 else ""
        raise NoWalk(f"The graph has no cycle{one}, so a walk through it ends: allow costlier transitions.")
    kept: Nodes = frozenset().union(*components.values())
    pruned = induced(graph, kept)
    frames = {labels: count for labels, (_, count) in found.items()}
    for message in (*_too_short(frames, least_frames), *_missing_ways(pruned, components)):
        warnings.warn(message, MocapWarning, stacklevel=4)  # whoever called `motion_graph.prune`
    reasons = _reasons(graph, ways, kept)
    removed = {
        (start, end, key): reasons[start if end in kept else end]
        for start, end, key in graph.edges(keys=True)
        if start in reasons or end in reasons
    }
    return Pruning(pruned, components, removed, tuple(reasons))


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


def _reasons(graph: nx.MultiDiGraph, ways: Indices, kept: Nodes) -> dict[Hashable, Reason]:
    """Say of every node that goes what is wrong with it."""
    part = component_numbers(ways, len(graph))
    on_cycle = np.bincount(part)[part] > 1
    on_cycle[ways[ways[:, 0] == ways[:, 1], 0]] = True
    after = reached(graph, kept)
    before = reached(graph.reverse(copy=False), kept)
    return {
        node: _reason(cycle, node in before, node in after)
        for node, cycle in zip(graph, on_cycle.tolist(), strict=True)
        if node not in kept
    }


def _reason(on_cycle: bool, before: bool, after: bool) -> Reason:
    """Judge a node by whether it is on a cycle, leads to what is kept, and can be reached from there."""
    if not on_cycle:
        return Reason.DEAD_END
    if not before:
        return Reason.SINK
    return Reason.ASIDE if after else Reason.UNREACHED


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


def _too_short(frames: Mapping[Labels, int], least: int) -> Iterator[str]:
    """Name the label sets of which fewer frames stay than asked for."""
    for labels, count in frames.items():
        together = NO_LABELS.union(*(other for other in frames if other < labels))
        if count < least and (labels != together or not labels):
            kind = f" with {name(labels)}" if len(frames) > 1 else ""
            yield f"{count} frames of clip stay{kind}, fewer than the {least} asked for."


def _missing_ways(graph: nx.MultiDiGraph, components: Mapping[Labels, Nodes]) -> Iterator[str]:
    """Name the ordered pairs of kept components without a way from the first to the second."""
    ways = {labels: reached(graph, nodes) for labels, nodes in components.items()}
    for here, there in permutations(components, 2):
        if not components[there] & ways[here]:
            yield (
                f"No way leads from {name(here)} ({len(components[here])} nodes) to {name(there)} "
                f"({len(components[there])} nodes): allow costlier transitions between the two."
            )
