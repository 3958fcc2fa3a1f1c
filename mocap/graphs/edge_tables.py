"""The frames that each edge and each hop of a motion graph plays, as arrays: a row per edge, frame or hop."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points, ranges
from mocap._shared.records import dataclass
from mocap.blending.weights import cubic_weights
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.motion_graph import MotionGraph, Node

Edge = tuple[Node, Node, int]

HOP = 1 / 6  # seconds of clip, after which a hop ends


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """E edges of a graph as arrays, and the F frames that they play, those of an edge after those before it.

    A frame is a blend: `alpha` times frame `here` plus `1 - alpha` times frame `there`, laid on it.

    Parameters
    ----------
    first, frames : shape (E,), where the frames of an edge start among those of all, and how many they are.
    cost, blended : shape (E,), as in the graph; `blended` are the transitions, a stretch of clip costs 0.
    angle, turn, move : shape (E,), lay the clip that an edge enters on the one that it leaves: the turn in
        radians, and p ↦ turn · p + move; 0, 1 and 0 on a stretch of clip.
    of : shape (F,), the edge that a frame belongs to.
    here, there : shape (F, 2), clips and frames; the same on a stretch of clip.
    alpha : shape (F,), the weight of `here`.
    """

    first: Indices
    frames: Indices
    cost: Array
    blended: Mask
    angle: Array
    turn: Points
    move: Points
    of: Indices
    here: Indices
    there: Indices
    alpha: Array

    @property
    def owner(self) -> Indices:
        """The clip frame with the larger weight, (F, 2): its labels and contacts are those of the blend."""
        return np.where(self.alpha[:, None] >= 0.5, self.here, self.there)


def require_node(motion_graph: MotionGraph, node: Node) -> None:
    """Raise `NoWalk` for a node that is not in the graph."""
    if node not in motion_graph.graph:
        of_clip = [n for n in motion_graph.graph if n[0] == node[0]]
        near = min(of_clip, key=lambda n: abs(n[1] - node[1]), default=None)
        help_ = f"; the nearest is {near}" if near else ", and none in that clip"
        raise NoWalk(f"The graph has no node {node}{help_}.")


def edge_table(motion_graph: MotionGraph, edges: Sequence[Edge]) -> EdgeTable:
    """List the data of some edges, and of what each of their frames is made [KGP02, Eqs. 5-7].

    No frame is part of two blends: a transition enters its clip at the frame after its window, and the next
    transition leaves at this frame or later. A transition of 10 frames from frame 60 into frame 20 blends
    frames 60 to 69 with frames 10 to 19.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> edges = edge_table(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)])
    >>> edges.frames.tolist(), edges.blended.tolist(), edges.cost.tolist(), edges.there[-1].tolist()
    ([40, 10], [False, True], [0.0, 0.02], [0, 19])
    """
    data = [motion_graph.graph.edges[edge] for edge in edges]
    frames = np.array([edge["frames"] for edge in data], np.intp)
    blended = np.array([edge["kind"] == "transition" for edge in data], bool)
    cost = np.array([edge.get("cost", 0.0) for edge in data], float)
    transforms = np.array([edge.get("transform", IDENTITY) for edge in data], float)
    lays = PlanarTransform(*transforms.reshape(-1, 3).T)
    first, of = np.asarray(np.cumsum(frames) - frames, np.intp), np.repeat(np.arange(len(edges)), frames)
    since = np.arange(len(of)) - first[of]  # frames since the edge's first
    ends = np.array([edge[:2] for edge in edges], np.intp).reshape(-1, 2, 2)
    here, there = ends[of, 0], ends[of, 1]
    here[:, 1] += since
    there[:, 1] += since - frames[of]
    alpha, mixed = np.ones(len(of)), blended[of]
    alpha[mixed] = cubic_weights(motion_graph.window)[since[mixed]]
    of_all = (np.asarray(lays.angle), lays.turn, lays.move)
    return EdgeTable(first, frames, cost, blended, *of_all, of, here, there, alpha)


def clip_rows(clips: Sequence[Motion], frames: Indices) -> Indices:
    """Find the rows of frames (N, 2) among those of all clips; outside a clip, of the nearest frame."""
    lengths = np.array([len(clip) for clip in clips])
    clip, frame = frames.T
    return np.asarray((np.cumsum(lengths) - lengths)[clip] + np.clip(frame, 0, lengths[clip] - 1))


@dataclass(frozen=True, eq=False)
class Hops:
    """All H hops of a compiled graph with N nodes, sorted by the node that they leave.

    A hop stays on the clip until it takes a transition or has lasted `HOP` seconds. Single edges, of a frame
    or two each, would give the same walks in many more steps.

    Parameters
    ----------
    first : shape (N + 1,), hops `first[n]` to `first[n + 1]` leave node n.
    ride, rides : shape (H,), the first stretch of clip of a hop, and the number of those before `last`.
    last : shape (H,), the last edge of a hop: a transition or a stretch of clip.
    starts, counts : shape (H, 2), the rows of frames that a hop plays, among the frames of all edges:
        first those of the stretches before the last edge, then those of the last edge.
    frames : shape (H,), the number of frames that each hop plays.
    """

    first: Indices
    ride: Indices
    rides: Indices
    last: Indices
    starts: Indices
    counts: Indices
    frames: Indices

    def leaving(self, nodes: Indices) -> tuple[Indices, Indices]:
        """List all hops that leave some nodes: the index of each one's node in `nodes`, and its number."""
        first = self.first[nodes]
        count = self.first[nodes + 1] - first
        return np.repeat(np.arange(len(nodes)), count), ranges(first, count)

    def rows(self, hops: Indices) -> tuple[Indices, Indices]:
        """List the rows of all frames that some hops play, and the index in `hops` that each belongs to."""
        rows = ranges(self.starts[hops].ravel(), self.counts[hops].ravel())
        return rows, np.repeat(np.arange(len(hops)), self.frames[hops])

    def edges(self, hops: Indices) -> Indices:
        """List the edges of some hops, in order."""
        first = np.stack([self.ride[hops], self.last[hops]], axis=1)
        return ranges(first.ravel(), np.stack([self.rides[hops], np.ones_like(hops)], axis=1).ravel())


def find_hops(edges: EdgeTable, leaves: Indices, nodes: int, fps: float) -> Hops:
    """Find the hops: from every node follow the clip, and leave by each transition on the way.

    A stretch of clip leads from node n to node n + 1, because the nodes are sorted.

    Parameters
    ----------
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    leaves : shape (E,), the number of the node that each edge leaves.
    nodes : the number of nodes.
    fps : frames per second.
    """
    stretches = np.flatnonzero(~edges.blended)
    onward = np.full(nodes, -1)  # the stretch that leaves each node
    onward[leaves[stretches]] = stretches
    first = np.searchsorted(leaves[len(stretches) :], np.arange(nodes + 1)) + len(stretches)
    ride, ways, frames = onward.tolist(), first.tolist(), edges.frames.tolist()
    found = []  # the node that a hop leaves, the stretches before its last edge, and this edge
    for node in range(nodes):
        here, ridden, over = node, 0, False
        while not over:
            found += [(node, here - node, way) for way in range(ways[here], ways[here + 1])]
            if ride[here] == -1:
                break
            ridden, here = ridden + frames[ride[here]], here + 1
            # A hop ends when it has lasted long enough, or where nothing leaves its clip's end.
            over = ridden >= HOP * fps or (ride[here] == -1 and ways[here] == ways[here + 1])
        if over:
            found.append((node, here - node - 1, ride[here - 1]))
    start, rides, last = np.array(found).T
    # The stretches of a hop lie one after the other, and so do their frames.
    before = np.concatenate([[0], np.cumsum(edges.frames)])
    begin, end = np.stack([onward[start], last], axis=1), np.stack([onward[start] + rides, last + 1], axis=1)
    end[rides == 0, 0] = begin[rides == 0, 0]
    counts = before[end] - before[begin]
    first = np.searchsorted(start, np.arange(nodes + 1))
    return Hops(first, onward[start], rides, last, before[begin], counts, counts.sum(axis=1))
