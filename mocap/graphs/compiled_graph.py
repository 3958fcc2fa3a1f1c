"""A motion graph as arrays, for searches that look at thousands of edges at once.

Ground points are complex numbers z + ix, and planar transforms are p ↦ turn · p + move, as in `body.planar`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points, ranges
from mocap.body.motion import gather_marks
from mocap.body.planar import heading, on_ground
from mocap.errors import NoWalk
from mocap.graphs.edge_tables import (
    Edge,
    EdgeTable,
    FrameTable,
    Hops,
    clip_rows,
    edge_table,
    find_hops,
    frame_table,
    require_node,
)
from mocap.graphs.motion_graph import MotionGraph, Node

AHEAD = (1 / 4, 1 / 2, 3 / 4)  # seconds


class Tracks(NamedTuple):
    """Where the root is in the T frames of all edges, one edge after the other.

    Parameters
    ----------
    first : shape (E,), the row at which each edge's frames start.
    ground : shape (T,), the root on the ground, in the coordinates of the clip that the edge leaves.
    step : shape (T,), metres from the frame before.
    """

    first: Indices
    ground: Points
    step: Array


class LabelTable(NamedTuple):
    """The labels of the T frames of all edges: `bears` has shape (L, T), in the order of the L `names`."""

    names: list[str]
    bears: Mask


@dataclass(frozen=True, eq=False)
class CompiledGraph:
    """A motion graph as arrays, with N nodes, E edges of T frames together, and H hops.

    Parameters
    ----------
    source : the graph.
    nodes : sorted by clip and frame.
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    target, frames, cost, blended : shape (E,), as in the graph; `blended` are the transitions.
    turn, move : shape (E,), the transform of a transition, else 1 and 0.
    at : shape (N,), where the root is at a node, in the coordinates of its clip.
    ahead : shape (N, 3), where it is after `AHEAD` seconds of clip; past the clip's end its velocity stays.
    going : shape (N,), the direction of its movement, or where it stands still, its heading (radians).
    plays, tracks : shape (T,), the frames of all edges, and where the root is in them.
    hops, labels : the hops from each node, and the labels of each frame.
    """

    source: MotionGraph
    nodes: list[Node]
    edges: list[Edge]
    target: Indices
    frames: Indices
    cost: Array
    blended: Mask
    turn: Points
    move: Points
    at: Points
    ahead: Points
    going: Array
    plays: FrameTable
    tracks: Tracks
    hops: Hops
    labels: LabelTable

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.source.fps

    def index(self, node: Node) -> int:
        """Find a node's number, or raise `NoWalk`."""
        require_node(self.source, node)
        return self.nodes.index(node)

    def label_number(self, name: str) -> int:
        """Find a label's number, -1 for "", or raise `NoWalk`."""
        if name and name not in self.labels.names:
            have = ", ".join(self.labels.names) or "none"
            raise NoWalk(f"No clip of the graph bears the label '{name}'; there are: {have}.")
        return self.labels.names.index(name) if name else -1


def compile_graph(graph: MotionGraph | CompiledGraph) -> CompiledGraph:
    """Turn a graph into arrays; a compiled graph comes back as it is.

    Raises
    ------
    NoWalk : for a graph without edges.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(), 30)]
    >>> compiled = compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> len(compiled.edges) == len(compiled.target), compile_graph(compiled) is compiled
    (True, True)

    Notebook: 08-path-synthesis
    """
    if isinstance(graph, CompiledGraph):
        return graph
    kinds = graph.graph.edges(keys=True, data="kind")
    ordered = sorted(kinds, key=lambda edge: (edge[3] == "transition", edge))
    edges = [(start, end, key) for start, end, key, _ in ordered]
    if not edges:
        raise NoWalk("The graph has no edges.")
    nodes = sorted(graph.graph)
    index = {node: n for n, node in enumerate(nodes)}
    leaves, target = (np.array([index[edge[end]] for edge in edges]) for end in (0, 1))
    table = edge_table(graph, edges)
    frames = frame_table(table, graph.window)
    roots = on_ground(np.concatenate([clip.root_positions for clip in graph.clips]))
    marks = gather_marks([clip.labels for clip in graph.clips], frames.owner)
    bears = np.array([marks[name] for name in sorted(marks)], bool).reshape(-1, len(frames.edge))
    way = table.transform
    of_edges = (target, table.frames, table.cost, table.blended, way.turn, way.move)
    standing = _standing(graph, np.array(nodes), roots)
    tracks = _tracks(graph, table, frames, roots)
    hops = find_hops(table, leaves, len(nodes), graph.fps)
    labels = LabelTable(sorted(marks), bears)  # in a transition those of the clip with the larger weight
    return CompiledGraph(graph, nodes, edges, *of_edges, *standing, frames, tracks, hops, labels)


def _standing(graph: MotionGraph, nodes: Indices, roots: Points) -> tuple[Points, Points, Array]:
    """Find where the root is at each node, where it is `AHEAD`, and in which direction it goes."""
    clip, frame = nodes.T
    last = np.array([len(motion) - 1 for motion in graph.clips])[clip]

    def root(frames: Indices) -> Points:
        return np.asarray(roots[clip_rows(graph.clips, np.stack([clip, frames], axis=1))])

    back = max(1, round(graph.fps / 6))
    speed = (root(last) - root(last - back)) / back
    steps = [frame + max(1, round(graph.fps * seconds)) for seconds in AHEAD]
    ahead = np.stack([root(then) + speed * np.maximum(then - last, 0) for then in steps], axis=1)
    way = ahead[:, -1] - root(frame)
    turns = np.concatenate([motion.rotations[:, 0] for motion in graph.clips])
    faces = heading(turns[clip_rows(graph.clips, nodes)])
    return root(frame), ahead, np.where(np.abs(way) > 0.1, np.angle(way), faces)


def _tracks(graph: MotionGraph, edges: EdgeTable, frames: FrameTable, roots: Points) -> Tracks:
    """Follow the root along every edge, blended as the poses are [KGP02, Eq. 5]."""
    turn, move = edges.transform.turn[frames.edge], edges.transform.move[frames.edge]
    here, there = (roots[clip_rows(graph.clips, some)] for some in (frames.here, frames.there))
    first = np.cumsum(edges.frames) - edges.frames
    ground = frames.alpha * here + (1 - frames.alpha) * (turn * there + move)
    step = np.abs(np.diff(ground, prepend=0))
    step[first] = np.abs(ground[first] - roots[clip_rows(graph.clips, edges.leaves - np.array([0, 1]))])
    return Tracks(first, ground, step)


def walk_track(graph: CompiledGraph, edges: Indices, turn: complex, move: complex) -> tuple[Points, Indices]:
    """Compute where the root is on the ground in every frame of a walk, and the rows of these frames.

    Parameters
    ----------
    graph : the compiled graph.
    edges : numbers of edges; each starts where the one before ends.
    turn, move : place the first edge's clip: p ↦ turn · p + move.

    Returns
    -------
    The root, shape (F,), and the rows in `graph.tracks`, shape (F,).
    """
    turns = np.cumprod([turn, *graph.turn[edges]])[:-1]
    moves = move + np.concatenate([[0], np.cumsum(turns * graph.move[edges])[:-1]])
    frames = graph.frames[edges]
    rows = ranges(graph.tracks.first[edges], frames)
    return np.repeat(moves, frames) + np.repeat(turns, frames) * graph.tracks.ground[rows], rows
