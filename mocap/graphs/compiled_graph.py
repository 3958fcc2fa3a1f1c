"""A motion graph as arrays, for searches that look at thousands of edges at once.

A point (x, z) on the ground is the complex number z + ix: a turn by θ about +y is then a product with
exp(iθ), and a planar transform is p ↦ turn · p + move.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Points, ranges
from mocap.body.planar import heading, on_ground
from mocap.errors import NoWalk
from mocap.graphs.edge_tables import Edge, EdgeTable, FrameTable, edge_table, frame_table, require_node
from mocap.graphs.motion_graph import MotionGraph, Node

AHEAD = (1 / 4, 1 / 2, 3 / 4)  # seconds
HOP = 1 / 6  # seconds


@dataclass(frozen=True, eq=False)
class CompiledGraph:
    """N nodes, E edges with T frames, and H hops.

    A hop is what a search steps by: a ride along the clip that ends in a transition, or has lasted `HOP`
    seconds. Stepping by edges, of a frame or two each, would come to the same walks.

    Parameters
    ----------
    source : the graph.
    nodes : sorted by clip and frame.
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    target, frames, cost, blended : shape (E,), as in the graph; `blended` are the transitions.
    turn, move : shape (E,), the transform of a transition, else 1 and 0.
    track_first : shape (E,), where an edge's frames start among those of all edges.
    track : shape (T,), where the root is, in the coordinates of the clip that the edge leaves.
    step : shape (T,), metres from the frame before.
    at : shape (N,), where the root is at a node, in the coordinates of its clip.
    ahead : shape (N, 3), where it is after `AHEAD` seconds if the clip goes on (past its end, as before).
    going : shape (N,), the direction it moves in, or where it stands, faces (radians).
    hop_first : shape (N + 1,), hops `hop_first[n]` to `hop_first[n + 1]` leave node n.
    ride, rides : shape (H,), the first stretch of clip that a hop rides along, and how many.
    last : shape (H,), the edge that ends it: a transition, or the last stretch of the ride.
    labels : the names of the labels.
    bears : shape (L, T), which frames bear them.
    """

    source: MotionGraph
    nodes: list[Node]
    edges: list[Edge]
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
    hop_first: Indices
    ride: Indices
    rides: Indices
    last: Indices
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


def compile_graph(graph: MotionGraph | CompiledGraph) -> CompiledGraph:
    """Turn a graph into arrays; one that is compiled already comes back as it is.

    Raises
    ------
    NoWalk : for a graph without edges.

    Notebook: 08-path-synthesis
    """
    if isinstance(graph, CompiledGraph):
        return graph
    nodes = sorted(graph.graph)
    kinds = graph.graph.edges(keys=True, data="kind")
    edges = [
        (start, end, key) for start, end, key, _ in sorted(kinds, key=lambda e: (e[3] == "transition", e))
    ]
    if not edges:
        raise NoWalk("The graph has no edges.")
    index = {node: n for n, node in enumerate(nodes)}
    leaves, target = (np.array([index[edge[end]] for edge in edges]) for end in (0, 1))
    table, roots = edge_table(graph, edges), _Roots(graph)
    frames, standing = frame_table(table, graph.window), np.array(nodes)
    return CompiledGraph(
        source=graph,
        nodes=nodes,
        edges=edges,
        target=target,
        frames=table.frames,
        cost=table.cost,
        blended=table.blended,
        **_tracks(table, frames, roots),
        at=roots[standing],
        ahead=roots.ahead(standing, graph.clips[0].fps),
        going=roots.going(standing, graph.clips[0].fps),
        **_hops(table, leaves, len(nodes), graph.clips[0].fps),
        **_bearing(graph, frames),
    )


def _tracks(edges: EdgeTable, frames: FrameTable, roots: _Roots) -> dict[str, Any]:
    """Follow the root along every edge, blended as the poses are [KGP02, Eq. 5]."""
    turn, move = edges.transform.turn, edges.transform.move
    first = np.cumsum(edges.frames) - edges.frames
    track = frames.alpha * roots[frames.here]
    track += (1 - frames.alpha) * (turn[frames.edge] * roots[frames.there] + move[frames.edge])
    step = np.abs(np.diff(track, prepend=0))
    step[first] = np.abs(track[first] - roots[edges.leaves - np.array([0, 1])])
    return {"turn": turn, "move": move, "track_first": first, "track": track, "step": step}


def _hops(edges: EdgeTable, leaves: Indices, nodes: int, fps: float) -> dict[str, Any]:
    """List the hops: from every node ride on, stretch by stretch, and leave by each transition on the way.

    A stretch of clip leads from node n to node n + 1, for the nodes are sorted.
    """
    rides = np.flatnonzero(~edges.blended)
    onward = np.full(nodes + 1, -1)  # the stretch that leaves each node
    onward[leaves[rides]] = rides
    first = np.searchsorted(leaves[len(rides) :], np.arange(nodes + 1)) + len(rides)
    # Of those still riding: where they are, and for how many frames they have been.
    here, ridden = np.arange(nodes), np.zeros(nodes, np.intp)
    origin, count, found = np.arange(nodes), 0, []
    while len(here):
        ways = first[here + 1] - first[here]
        leaving = np.repeat(origin, ways)
        found.append((leaving, np.full(len(leaving), count), ranges(first[here], ways)))
        riding = onward[here] >= 0
        origin, here, stretch = origin[riding], here[riding] + 1, onward[here[riding]]
        ridden, count = ridden[riding] + edges.frames[stretch], count + 1
        # A ride ends when it has lasted long enough, or its clip goes no further.
        over = (ridden >= HOP * fps) | ((onward[here] < 0) & (first[here] == first[here + 1]))
        found.append((origin[over], np.full(over.sum(), count - 1), stretch[over]))
        here, origin, ridden = here[~over], origin[~over], ridden[~over]
    start, rides, last = (np.concatenate(column) for column in zip(*found, strict=True))
    order = np.argsort(start, kind="stable")
    return {
        "hop_first": np.searchsorted(start[order], np.arange(nodes + 1)),
        "ride": onward[start[order]],
        "rides": rides[order],
        "last": last[order],
    }


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
    """Where the root of each clip's frames is on the ground; outside the clip it stands."""

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
        speed = (self[end] - self[end - np.array([0, back])]) / back
        found = []
        for seconds in AHEAD:
            then = frames + np.array([0, max(1, round(fps * seconds))])
            found.append(self[then] + speed * np.maximum(then[:, 1] - end[:, 1], 0))
        return np.stack(found, axis=1)

    def going(self, frames: Indices, fps: float) -> Array:
        """Tell the direction of the next moments, or how the root is turned where they lead nowhere."""
        way = self.ahead(frames, fps)[:, -1] - self[frames]
        return np.where(np.abs(way) > 0.1, np.angle(way), heading(self.turns[self._rows(frames)]))

    def _rows(self, frames: Indices) -> Indices:
        clip, frame = frames.T
        return np.asarray(self.first[clip] + np.clip(frame, 0, self.last[clip]))


def _bearing(graph: MotionGraph, frames: FrameTable) -> dict[str, Any]:
    """Tell which frames bear which label, in a transition that of the clip with the larger weight."""
    labels = sorted({label for clip in graph.clips for label in clip.labels})
    owner = np.where(frames.alpha[:, None] >= 0.5, frames.here, frames.there)
    bears = np.zeros((len(labels), len(owner)), bool)
    for number, clip in enumerate(graph.clips):
        of_clip = owner[:, 0] == number
        for label, mark in clip.labels.items():
            bears[labels.index(label), of_clip] = mark[owner[of_clip, 1]]
    return {"labels": labels, "bears": bears}
