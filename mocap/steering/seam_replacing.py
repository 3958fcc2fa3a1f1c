"""A walk without some of its seams, which otherwise stays as it is where it can."""

from collections.abc import Sequence
from dataclasses import replace

from mocap.errors import NoWalk, shortened
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, Node


def transitions_from(motion_graph: MotionGraph, walk: Sequence[Edge], node: Node) -> list[Edge]:
    """Return all transitions of a graph that leave a node, if a walk takes one of them.

    Raises
    ------
    NoWalk : if the walk has none, with those that it has.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> transitions_from(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)], (0, 60))
    [((0, 60), (0, 20), 0)]
    """
    edges = motion_graph.graph.edges
    seams = dict.fromkeys(edge for edge in walk if edges[edge]["kind"] == "transition")
    leaving = motion_graph.graph.out_edges(node, keys=True)
    refused = [edge for edge in leaving if edges[edge]["kind"] == "transition"]
    if not any(edge in seams for edge in refused):
        names = [f"{motion_graph.clips[clip].name}:{frame}" for (clip, frame), _, _ in seams]
        shown = shortened(", ".join(names), 100) or "none"
        name = f"{shortened(motion_graph.clips[node[0]].name, 40)}:{node[1]}"
        raise NoWalk(f"The walk has no seam that leaves {name}; its seams leave {shown}.")
    return refused


def graph_without(motion_graph: MotionGraph, edges: Sequence[Edge]) -> MotionGraph:
    """Return a motion graph without some edges, and with all its nodes, so that walks may have dead ends.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> graph_without(graph, [((0, 60), (0, 20), 0)])
    MotionGraph(1 clips, 4 nodes, 3 edges, 0 of them transitions)
    """
    graph = motion_graph.graph.copy()
    graph.remove_edges_from(edges)
    return replace(motion_graph, graph=graph)


def fraction_kept(walk: Sequence[Edge], changed: Sequence[Edge], motion_graph: MotionGraph) -> float:
    """Return the fraction of the frames of a walk whose edges are also in a changed walk."""
    edges = motion_graph.graph.edges
    kept = set(changed)
    frames = [(edge in kept, edges[edge]["frames"]) for edge in walk]
    frames_kept = sum(count for is_kept, count in frames if is_kept)
    return float(frames_kept / sum(count for _, count in frames))
