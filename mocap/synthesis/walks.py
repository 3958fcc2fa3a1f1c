"""A walk through a motion graph: a list of edges, each of which starts where the one before ends.

An edge is (start node, end node, key). The frames of a walk are those of its edges in order. Every frame is
one frame of a clip, or a blend of two.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap.errors import NoWalk
from mocap.graphs.edge_tables import Edge, edge_table
from mocap.graphs.motion_graph import MotionGraph


class Seam(NamedTuple):
    """A transition on a walk: the `frame` of the motion at which it starts, and its `cost` in metres."""

    frame: int
    cost: float


def seams(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[Seam]:
    """List the transitions that a walk takes.

    Examples
    --------
    A clip with one transition back to an earlier frame, and a walk that takes it once:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> seams(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)])
    [Seam(frame=40, cost=0.02)]

    Notebook: 07-walks-and-search
    """
    edges = edge_table(motion_graph, walk)
    first = np.cumsum(edges.frames) - edges.frames
    return [Seam(int(first[i]), float(edges.cost[i])) for i in np.flatnonzero(edges.blended)]


def sources(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[tuple[int, str]]:
    """List the clips that a walk plays, each with its first frame; in a transition the clip changes half-way.

    Examples
    --------
    A transition of 10 frames leads from one clip to another:

    >>> from mocap import body, datasets, graphs, matching
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "sneak")]
    >>> over = matching.Transition(0, 60, 1, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions(clips, [over], window=10)
    >>> sources(graph, [((0, 0), (0, 60), 0), ((0, 60), (1, 20), 0)])
    [(0, 'walk_circle'), (65, 'sneak')]

    Notebook: 07-walks-and-search
    """
    found, frame = [(0, motion_graph.clips[walk[0][0][0]].name)], 0
    for start, end, key in walk:
        data = motion_graph.graph.edges[start, end, key]
        if data["kind"] == "transition" and end[0] != start[0]:
            found.append((frame + data["frames"] // 2, motion_graph.clips[end[0]].name))
        frame += data["frames"]
    return found


def require_walk(motion_graph: MotionGraph, walk: Sequence[Edge]) -> None:
    """Raise `NoWalk` for an empty walk, a missing edge, or an edge that starts away from the last one's end.

    Examples
    --------
    >>> from mocap import datasets, graphs
    >>> graph = graphs.from_transitions([datasets.sample("walk_circle")], [], window=10)
    >>> require_walk(graph, [((0, 0), (0, 99), 0)])
    Traceback (most recent call last):
    mocap.errors.NoWalk: The graph has no edge ((0, 0), (0, 99), 0).
    """
    if not walk:
        raise NoWalk("The walk has no edges.")
    for edge in walk:
        if not motion_graph.graph.has_edge(*edge):
            raise NoWalk(f"The graph has no edge {edge}.")
    for (_, end, _), (start, _, _) in pairwise(walk):
        if end != start:
            raise NoWalk(f"The walk jumps from node {end} to node {start}.")
