"""A walk through a motion graph, as a list of edges and as arrays: what each of its frames is made of.

An edge is (start node, end node, key). A walk is a list of edges, each starting where the one before ends,
and its frames are those of its edges in order. Every frame is one frame of a clip, or a blend of two.
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
    """List the transitions that a walk passes.

    Notebook: 07-walks-and-search
    """
    edges = edge_table(motion_graph, walk)
    first = np.cumsum(edges.frames) - edges.frames
    return [Seam(int(first[i]), float(edges.cost[i])) for i in np.flatnonzero(edges.blended)]


def sources(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[tuple[int, str]]:
    """Tell which clip a walk plays from which frame on; within a transition it changes half-way.

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
    """Raise `NoWalk` for an empty walk, an edge that the graph lacks, or one that starts elsewhere."""
    if not walk:
        raise NoWalk("The walk has no edges.")
    for edge in walk:
        if not motion_graph.graph.has_edge(*edge):
            raise NoWalk(f"The graph has no edge {edge}.")
    for (_, end, _), (start, _, _) in pairwise(walk):
        if end != start:
            raise NoWalk(f"The walk jumps from node {end} to node {start}.")
