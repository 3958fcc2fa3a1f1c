"""A motion graph as arrays, for searches that look at thousands of edges at once.

A point (x, z) on the ground is the complex number z + ix: a turn by θ about +y is then a product with
exp(iθ), and a planar transform is p ↦ turn · p + move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap.errors import NoWalk
from mocap.motion_graph import MotionGraph, Node
from mocap.transforms import heading
from mocap.walks import Edge, FrameTable, edge_table, frame_table, ranges, require_node

Array = NDArray[np.float64]
Points = NDArray[np.complex128]
Indices = NDArray[np.intp]

AHEAD = (1 / 6, 1 / 3, 1 / 2)  # seconds


@dataclass(frozen=True, eq=False)
class CompiledGraph:
    """N nodes and E edges, sorted by the node they leave, and the root's track on each.

    Parameters
    ----------
    source : the graph.
    nodes, edges : what the indices stand for.
    first : shape (N + 1,), edges `first[n]` to `first[n + 1]` leave node n.
    target : shape (E,), the node an edge leads to.
    frames, cost, blended : shape (E,), as in the graph; `blended` are the transitions, other edges cost 0.
    turn, move : shape (E,), the transform of a transition, else 1 and 0.
    track_first : shape (E,), where an edge's frames start among all T frames of all edges.
    track : shape (T,), where the root is, in the coordinates of the clip that the edge leaves.
    step : shape (T,), metres from the frame before.
    at : shape (N,), where the root is at a node, in the coordinates of its clip.
    ahead : shape (N, 3), where it is `AHEAD` seconds later if the clip just goes on, as fast past its end as before.
    going : shape (N,), the direction it moves in, or where it stands, faces (radians).
    labels : the names of the labels.
    bears : shape (L, T), which frames bear them.
    """

    source: MotionGraph
    nodes: list[Node]
    edges: list[Edge]
    first: Indices
    target: Indices
    frames: Indices
    cost: Array
    blended: NDArray[np.bool_]
    turn: Points
    move: Points
    track_first: Indices
    track: Points
    step: Array
    at: Points
    ahead: Points
    going: Array
    labels: list[str]
    bears: NDArray[np.bool_]

    @property
    def fps(self) -> float:
        """Frames a second."""
        return self.source.clips[0].fps

    def index(self, node: Node) -> int:
        """Find a node's number, or raise `NoWalk`."""
        require_node(self.source, node)
        return self.nodes.index(node)


def on_ground(points: ArrayLike) -> Points:
    """Turn points (..., 3) into complex numbers z + ix.

    Examples
    --------
    >>> complex(on_ground([3.0, 1.0, 2.0]))
    (2+3j)
    """
    points = np.asarray(points, float)
    return np.asarray(points[..., 2] + 1j * points[..., 0])


def compile_graph(graph: MotionGraph | CompiledGraph) -> CompiledGraph:
    """Turn a graph into arrays; one that is compiled already comes back as it is.

    Raises
    ------
    NoWalk : for a graph without edges.
    """
    if isinstance(graph, CompiledGraph):
        return graph
    nodes, edges = sorted(graph.graph), sorted(graph.graph.edges(keys=True))
    if not edges:
        raise NoWalk("The graph has no edges.")
    index = {node: n for n, node in enumerate(nodes)}
    table = edge_table(graph, edges)
    frames = frame_table(table, graph.window)
    turn, move = np.exp(1j * np.asarray(table.transform.angle)), table.transform.z + 1j * table.transform.x
    roots = _Roots(graph)
    track = frames.alpha * roots[frames.here]
    track += (1 - frames.alpha) * (turn[frames.edge] * roots[frames.there] + move[frames.edge])
    track_first = np.cumsum(table.frames) - table.frames
    step = np.abs(np.diff(track, prepend=0))
    step[track_first] = np.abs(track[track_first] - roots[table.leaves - [0, 1]])
    standing = np.array(nodes)
    labels = sorted({label for clip in graph.clips for label in clip.labels})
    return CompiledGraph(
        source=graph,
        nodes=nodes,
        edges=edges,
        first=np.searchsorted([index[start] for start, _, _ in edges], np.arange(len(nodes) + 1)),
        target=np.array([index[end] for _, end, _ in edges]),
        frames=table.frames,
        cost=table.cost,
        blended=table.blended,
        turn=turn,
        move=move,
        track_first=track_first,
        track=track,
        step=step,
        at=roots[standing],
        ahead=(ahead := roots.ahead(standing, graph.clips[0].fps)),
        going=roots.going(standing, ahead),
        labels=labels,
        bears=_bearing(graph, frames, labels),
    )


def walk_track(graph: CompiledGraph, edges: Indices, turn: complex, move: complex) -> tuple[Points, Indices]:
    """Place the root on the ground in every frame of a walk, and tell which of the graph's frames these are.

    Parameters
    ----------
    graph : N nodes, E edges.
    edges : numbers of edges, each starting where the one before ends.
    turn, move : place the first edge's clip: p -> turn · p + move.
    """
    turns = np.cumprod([turn, *graph.turn[edges]])[:-1]
    moves = move + np.concatenate([[0], np.cumsum(turns * graph.move[edges])[:-1]])
    frames = graph.frames[edges]
    rows = ranges(graph.track_first[edges], frames)
    return np.repeat(moves, frames) + np.repeat(turns, frames) * graph.track[rows], rows


class _Roots:
    """Where the root of each clip's frames is on the ground; before the first frame and after the last it stands."""

    def __init__(self, graph: MotionGraph) -> None:
        self.last = np.array([len(clip) - 1 for clip in graph.clips])
        self.first = np.cumsum(self.last + 1) - self.last - 1
        self.points = on_ground(np.concatenate([clip.root_positions for clip in graph.clips]))
        self.turns = np.concatenate([clip.rotations[:, 0] for clip in graph.clips])

    def __getitem__(self, frames: Indices) -> Points:
        return np.asarray(self.points[self._rows(frames)])

    def ahead(self, frames: Indices, fps: float) -> Points:
        """Look ahead by `AHEAD` seconds, shape (N, 3)."""
        end = np.stack([frames[:, 0], self.last[frames[:, 0]]], axis=1)
        back = max(1, round(fps / 6))
        speed = (self[end] - self[end - [0, back]]) / back
        found = []
        for seconds in AHEAD:
            then = frames + [0, max(1, round(fps * seconds))]
            found.append(self[then] + speed * np.maximum(then[:, 1] - end[:, 1], 0))
        return np.stack(found, axis=1)

    def going(self, frames: Indices, ahead: Points) -> Array:
        """Tell the direction of the next moments, or how the root is turned where they lead nowhere."""
        way = ahead[:, -1] - self[frames]
        return np.where(np.abs(way) > 0.1, np.angle(way), heading(self.turns[self._rows(frames)]))

    def _rows(self, frames: Indices) -> Indices:
        clip, frame = frames.T
        return np.asarray(self.first[clip] + np.clip(frame, 0, self.last[clip]))


def _bearing(graph: MotionGraph, frames: FrameTable, labels: list[str]) -> NDArray[np.bool_]:
    """Tell which frames bear which label, in a transition that of the clip with the larger weight."""
    owner = np.where(frames.alpha[:, None] >= 0.5, frames.here, frames.there)
    bears = np.zeros((len(labels), len(owner)), bool)
    for number, clip in enumerate(graph.clips):
        of_clip = owner[:, 0] == number
        for label, mark in clip.labels.items():
            bears[labels.index(label), of_clip] = mark[owner[of_clip, 1]]
    return bears
