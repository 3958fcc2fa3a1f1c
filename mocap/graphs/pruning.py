"""Pruning: remove the dead ends and sinks of a graph, so that every walk can be continued [KGP02, 3.4].

In a strongly connected graph every node is reachable from every other. Pruning therefore keeps the largest
strongly connected component. To keep every kind of motion, it can keep a component for each set of labels,
which consists of the edges with exactly these labels, and all edges between the kept nodes. In the paper,
only transitions lead from one kept component to another. Here a stretch of clip may also do so, for example
one from walking to running, because a recorded change is better than any blend.

The functions take any `networkx.MultiDiGraph`. Its edges must have `frames` and `kind`, and `labels` for
pruning by labels.
"""

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from itertools import permutations

import networkx as nx
import numpy as np

from mocap._shared.collector import uncollected
from mocap._shared.records import dataclass
from mocap.errors import MocapError, NoWalk, warn
from mocap.graphs.components import (
    NO_LABELS,
    Labels,
    Nodes,
    largest_components,
    numbered_edges,
    on_cycles,
    reachable,
    reached,
)
from mocap.graphs.motion_graph import MotionGraph, require_graph

NOTES_NODES = range(1, 9)
NOTES_SUCCESSORS = {1: (2,), 2: (3, 6), 3: (1, 4), 4: (4,), 6: (5, 7), 7: (5, 8), 8: (3,)}
NOTES_ARROWS = tuple((start, end) for start, ends in NOTES_SUCCESSORS.items() for end in ends)
"""The edges of the graph of the notes, after [KGP02, Fig. 4]."""


def prune(motion_graph: MotionGraph, *, by_labels: bool = False) -> MotionGraph:
    """Keep the largest strongly connected component, in which every walk can be continued.

    In the paper: [KGP02, 3.4].

    The largest component is the one with the most frames of clips [KGP02, 3.4]. Dead ends are removed, and
    sinks, which no walk can leave. `graphs.prune_graph` also returns a reason for each removed edge.

    Parameters
    ----------
    motion_graph : the graph, which is not changed.
    by_labels : keep a component for each set of labels, from the edges with exactly these labels, and the
        edges between the components.

    Raises
    ------
    NoWalk : if the graph has no cycle, and therefore every walk ends.

    Warns
    -----
    MocapWarning : for components without a frame of a clip, and for those from which another one cannot be
        reached.

    Examples
    --------
    A transition back closes a cycle, which does not contain the start and the end of the clip:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> list(prune(graphs.from_transitions([clip], [back], window=10)).graph)
    [(0, 60), (0, 20)]

    Notebook: 00-quickstart
    """
    require_graph(motion_graph)
    return replace(motion_graph, graph=prune_graph(motion_graph.graph, by_labels=by_labels).graph)


Edge = tuple[Hashable, Hashable, int]  # start, end, key


class Reason(StrEnum):
    """The reason for which an edge is removed, a property of the node at one of its ends.

    Examples
    --------
    >>> print(Reason.DEAD_END)
    dead end: on no cycle
    """

    DEAD_END = "dead end: on no cycle"
    SINK = "sink: on a cycle, but reaches nothing that is kept"
    UNREACHED = "unreached: on a cycle, but nothing that is kept leads there"
    ASIDE = "aside: its labels form no loop here, or only a loop in a smaller component"


@dataclass(frozen=True)
class Pruning:
    """The result of pruning: the kept graph, and the removed nodes and edges. `prune_graph` shows an example.

    Parameters
    ----------
    graph : the kept nodes and edges.
    components : for each label set with a cycle, the nodes of its kept component, or without labels a
        single entry for the empty set.
    removed : the removed edges, each with a reason.
    orphans : the removed nodes.
    """

    graph: nx.MultiDiGraph
    components: Mapping[Labels, Nodes]
    removed: Mapping[Edge, Reason]
    orphans: tuple[Hashable, ...]

    def report(self) -> str:
        """Summarise the kept graph, and the number of edges removed for each reason, in a few lines."""
        lines = [f"kept {self.graph.number_of_nodes()} nodes and {self.graph.number_of_edges()} edges"]
        if len(self.components) > 1:
            lines += [f"  {len(nodes)} nodes: {name(labels)}" for labels, nodes in self.components.items()]
        lines.append(f"removed {len(self.orphans)} nodes and {len(self.removed)} edges")
        counts = Counter(self.removed.values())
        lines += [f"  {counts[reason]} edges: {reason}" for reason in Reason if counts[reason]]
        return "\n".join(lines)


def name(labels: Labels) -> str:
    """Format a label set as text.

    Examples
    --------
    >>> name(frozenset({"walk", "turn"})), name(NO_LABELS)
    ('turn+walk', 'no label')

    Notebook: 06b-pruning-clips
    """
    return "+".join(sorted(labels)) or "no label"


def notes_example(arrows: Sequence[tuple[int, int]] = NOTES_ARROWS) -> nx.MultiDiGraph:
    """Return the eight-node graph of the notes, after [KGP02, Fig. 4]: node 5 is a dead end, node 4 a sink.

    Parameters
    ----------
    arrows : pairs (start, end) of nodes 1 to 8; those of the notes by default. Each is a second of motion.

    Raises
    ------
    MocapError : for other nodes, which the pictures of the course cannot draw.

    Examples
    --------
    >>> pruning = prune_graph(notes_example())
    >>> sorted(pruning.graph), sorted(pruning.orphans)
    ([1, 2, 3, 6, 7, 8], [4, 5])

    Notebook: 06-pruning
    """
    graph = nx.MultiDiGraph()
    graph.add_edges_from(arrows, kind="clip", frames=30, labels=NO_LABELS)
    graph.add_nodes_from(NOTES_NODES)
    if unknown := [node for node in graph if node not in NOTES_NODES]:
        raise MocapError(f"The graph of the notes has the nodes 1 to 8, not {unknown[0]!r:.40}.")
    return graph


@uncollected()
def prune_graph(graph: nx.MultiDiGraph, *, by_labels: bool = False, least_frames: int = 1) -> Pruning:
    """Keep the largest strongly connected component, of all edges or of each label set [KGP02, 3.4].

    In the paper: [KGP02, 3.4; warnings].

    The largest component is the one whose stretches of clip have the most frames. The time is linear in the
    number of edges, and by labels in the number of edges times that of the kept label sets.

    Parameters
    ----------
    graph : the graph, which is not changed.
    by_labels : keep a component for each label set, and the edges between them.
    least_frames : the number of frames of clips in a component below which a label set gives a warning. Sets
        that are the union of smaller sets give none, because they mark changes between kinds of motion.

    Returns
    -------
    The kept part as a new graph in which every walk can be continued, and the removed nodes and edges.

    Raises
    ------
    NoWalk : if there is no cycle, or none with a single label set, and therefore every walk ends.

    Warns
    -----
    MocapWarning : for label sets with too few frames, and for ordered pairs of components without a path from
        the first to the second.

    Examples
    --------
    >>> for edge, reason in sorted(prune_graph(notes_example()).removed.items()):
    ...     print(edge, reason.name)
    (3, 4, 0) SINK
    (4, 4, 0) SINK
    (6, 5, 0) DEAD_END
    (7, 5, 0) DEAD_END

    Notebook: 06b-pruning-clips
    """
    largest = largest_components(graph, by_labels)
    components = {labels: nodes for labels, (nodes, _) in largest.items() if nodes}
    if not components:
        edges = " of edges with the same labels" if len(largest) > 1 else ""
        raise NoWalk(f"The graph has no cycle{edges}, so a walk through it ends: allow costlier transitions.")
    kept: Nodes = frozenset().union(*components.values())
    pruned = _part(graph, kept)
    frames = {labels: count for labels, (_, count) in largest.items()}
    for message in _shortcomings(frames, least_frames, pruned, components):
        warn(message)
    reasons = _reasons(graph, kept)
    ends = ((edge, edge[0] if edge[1] in kept else edge[1]) for edge in graph.edges(keys=True))
    removed = {edge: reasons[end] for edge, end in ends if end in reasons} if reasons else {}
    return Pruning(pruned, components, removed, tuple(reasons))


def _part(graph: nx.MultiDiGraph, kept: Nodes) -> nx.MultiDiGraph:
    """Copy some nodes and the edges between them, in the order of the graph, on which random walks depend."""
    part = nx.MultiDiGraph(**graph.graph)
    part.add_nodes_from((node, data) for node, data in graph.nodes(data=True) if node in kept)
    edges = graph.edges(keys=True, data=True)
    part.add_edges_from(edge for edge in edges if edge[0] in kept and edge[1] in kept)
    return part


def _reasons(graph: nx.MultiDiGraph, kept: Nodes) -> dict[Hashable, Reason]:
    """Return the reason for removing each node that is not kept, in the order of the graph."""
    if len(kept) == len(graph):
        return {}
    edges = numbered_edges(graph)
    is_kept = np.array([node in kept for node in graph])
    is_on_cycle = on_cycles(edges, len(graph))
    is_descendant = reachable(edges, is_kept)
    is_ancestor = reachable(edges[:, ::-1], is_kept)

    def reason(number: int) -> Reason:
        if not is_on_cycle[number]:
            return Reason.DEAD_END
        if not is_ancestor[number]:
            return Reason.SINK
        return Reason.ASIDE if is_descendant[number] else Reason.UNREACHED

    return {node: reason(number) for number, node in enumerate(graph) if node not in kept}


def _shortcomings(
    frames: Mapping[Labels, int], minimum: int, graph: nx.MultiDiGraph, components: Mapping[Labels, Nodes]
) -> Iterator[str]:
    """Yield a message for each label set with too few frames, and each pair of components without a path."""
    for labels, count in frames.items():
        together = NO_LABELS.union(*(subset for subset in frames if subset < labels))
        if count < minimum and (labels != together or not labels):
            kind = f" with {name(labels)}" if len(frames) > 1 else ""
            yield f"{count} frames of clip stay{kind}, fewer than the {minimum} asked for."
    if len(components) < 2:
        return
    descendants = {labels: reached(graph, nodes) for labels, nodes in components.items()}
    for source, target in permutations(components, 2):
        if not components[target] & descendants[source]:
            yield (
                f"No way leads from {name(source)} ({len(components[source])} nodes) to {name(target)} "
                f"({len(components[target])} nodes): allow costlier transitions between the two."
            )
