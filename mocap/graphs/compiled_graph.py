"""A motion graph as arrays, for searches that look at thousands of edges at once.

Ground points are complex numbers z + ix, and planar transforms are p ↦ turn · p + move, as in `body.planar`.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points, ranges
from mocap._shared.records import dataclass
from mocap.body.motion import gather_marks
from mocap.body.planar import heading, on_ground
from mocap.errors import NoWalk
from mocap.graphs.edge_tables import Edge, EdgeTable, Hops, clip_rows, edge_table, find_hops, require_node
from mocap.graphs.motion_graph import MotionGraph, Node, require_graph

AHEAD = (1 / 4, 1 / 2, 3 / 4)  # seconds
LEAST = 0.3  # metres per second: standing counts as this, so that no walk stands for ever; γ in [KGP02, 5.1]


@dataclass(frozen=True, eq=False)
class CompiledGraph(EdgeTable):
    """A motion graph as arrays: the `EdgeTable` of all E edges, of T frames together, N nodes and H hops.

    Parameters
    ----------
    source : the graph.
    nodes : sorted by clip and frame.
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    target : shape (E,), the number of the node that an edge enters.
    at : shape (N,), where the root is at a node, in the coordinates of its clip.
    ahead : shape (N, 3), where it is after `AHEAD` seconds of clip; past the clip's end its velocity stays.
    going : shape (N,), the direction of its movement, or where it stands still, its heading (radians).
    ground, step : shape (T,), where the root is in each frame, in the coordinates of the clip that the edge
        leaves; and metres from the frame before.
    label_names, bears : the L labels, and shape (L, T), whether a frame bears them.
    hops : the hops from each node.
    """

    source: MotionGraph
    nodes: list[Node]
    edges: list[Edge]
    target: Indices
    at: Points  # reads: name: public, and read by searches everywhere
    ahead: Points
    going: Array
    ground: Points
    step: Array
    label_names: list[str]
    bears: Mask
    hops: Hops

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.source.fps

    @cached_property
    def progress(self) -> Array:
        """Each frame's progress, metres, (T,): its step, or γ if it is less [KGP02, least progress]."""
        return np.maximum(self.step, LEAST / self.fps)

    def index(self, node: Node) -> int:
        """Find a node's number, or raise `NoWalk`."""
        require_node(self.source, node)
        return self.nodes.index(node)

    def label_number(self, name: str) -> int:
        """Find a label's number, -1 for "", or raise `NoWalk`."""
        if name and name not in self.label_names:
            have = ", ".join(self.label_names) or "none"
            raise NoWalk(f"No clip of the graph bears the label '{name}'; there are: {have}.")
        return self.label_names.index(name) if name else -1


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
    require_graph(graph)
    kinds = graph.graph.edges(keys=True, data="kind")
    ordered = sorted(kinds, key=lambda edge: (edge[-1] == "transition", edge))
    edges = [(start, end, key) for start, end, key, _ in ordered]
    if not edges:
        raise NoWalk("The graph has no edges.")
    nodes = sorted(graph.graph)
    index = {node: n for n, node in enumerate(nodes)}
    leaves, target = (np.array([index[edge[end]] for edge in edges]) for end in (0, 1))
    table = edge_table(graph, edges)
    roots = on_ground(np.concatenate([clip.root_positions for clip in graph.clips]))
    # The labels of a frame in a transition are those of the clip with the larger weight.
    marks = gather_marks([clip.labels for clip in graph.clips], table.owner)
    names = sorted(marks)
    bears = np.array([marks[name] for name in names], bool).reshape(-1, len(table.of))
    parts = (target, *_standing(graph, np.array(nodes), roots), *_tracks(graph, table, roots))
    hops = find_hops(table, leaves, len(nodes), graph.fps)
    whole: list[Any] = [*vars(table).values(), graph, nodes, edges, *parts, names, bears, hops]
    return CompiledGraph(*whole)


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
    direction = ahead[:, -1] - root(frame)
    turns = np.concatenate([motion.rotations[:, 0] for motion in graph.clips])
    faces = heading(turns[clip_rows(graph.clips, nodes)])
    return root(frame), ahead, np.where(np.abs(direction) > 0.1, np.angle(direction), faces)


def _tracks(graph: MotionGraph, edges: EdgeTable, roots: Points) -> tuple[Points, Array]:
    """Follow the root along every edge, blended as the poses are [KGP02, Eq. 5]: places, and steps."""
    turn = edges.turn[edges.of]
    move = edges.move[edges.of]
    source_roots = roots[clip_rows(graph.clips, edges.here)]
    target_roots = roots[clip_rows(graph.clips, edges.there)]
    ground = edges.alpha * source_roots + (1 - edges.alpha) * (turn * target_roots + move)
    step = np.abs(np.diff(ground, prepend=0))
    preceding = clip_rows(graph.clips, edges.here[edges.first] - np.array([0, 1]))
    step[edges.first] = np.abs(ground[edges.first] - roots[preceding])
    return ground, step


def walk_track(graph: CompiledGraph, edges: Indices, turn: complex, move: complex) -> tuple[Points, Indices]:
    """Compute where the root is on the ground in every frame of a walk, and the rows of these frames.

    Parameters
    ----------
    graph : the compiled graph.
    edges : numbers of edges; each starts where the one before ends.
    turn, move : place the first edge's clip: p ↦ turn · p + move.

    Returns
    -------
    The root, shape (F,), and the rows of its frames among those of all edges, shape (F,).
    """
    turns = np.cumprod([turn, *graph.turn[edges]])[:-1]
    moves = move + np.concatenate([[0], np.cumsum(turns * graph.move[edges])[:-1]])
    frames = graph.frames[edges]
    rows = ranges(graph.first[edges], frames)
    return np.repeat(moves, frames) + np.repeat(turns, frames) * graph.ground[rows], rows
