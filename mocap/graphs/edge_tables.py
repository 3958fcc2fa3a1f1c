"""What each edge of a motion graph plays, and each hop, as arrays: one row per edge, per frame, per hop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, ranges
from mocap.blending.weights import cubic_weights
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.motion_graph import MotionGraph, Node

Edge = tuple[Node, Node, int]

HOP = 1 / 6  # seconds


class EdgeTable(NamedTuple):
    """Edges as arrays of one length: a stretch of clip has cost 0 and the identity as its `transform`."""

    leaves: Indices  # (E, 2): clip and frame
    enters: Indices  # (E, 2)
    frames: Indices
    blended: NDArray[np.bool_]  # whether it is a transition
    cost: Array
    transform: PlanarTransform  # of arrays: lays the clip it enters on the one it leaves


class FrameTable(NamedTuple):
    """What the frames of some edges are made of: `alpha` times frame `here`, the rest of frame `there`."""

    edge: Indices  # (F,): which of the edges a frame belongs to
    here: Indices  # (F, 2): clip and frame
    there: Indices  # (F, 2): the same as here on a stretch of clip
    alpha: Array  # (F,)

    @property
    def owner(self) -> Indices:
        """Whose labels and contacts each frame bears: the frame with the larger weight, (F, 2)."""
        return np.where(self.alpha[:, None] >= 0.5, self.here, self.there)


def require_node(motion_graph: MotionGraph, node: Node) -> None:
    """Raise `NoWalk` for a node that the graph lacks.

    Notebook: 07-walks-and-search
    """
    if node not in motion_graph.graph:
        clip, frame = node
        near = min(
            (n for n in motion_graph.graph if n[0] == clip), key=lambda n: abs(n[1] - frame), default=None
        )
        help_ = f"; the nearest is {near}" if near else ", and none in that clip"
        raise NoWalk(f"The graph has no node {node}{help_}.")


def edge_table(motion_graph: MotionGraph, edges: Sequence[Edge]) -> EdgeTable:
    """Gather what the graph knows of some edges.

    Notebook: 07-walks-and-search
    """
    data = [motion_graph.graph.edges[edge] for edge in edges]
    transforms = np.array([edge.get("transform", IDENTITY) for edge in data], float).reshape(-1, 3)
    return EdgeTable(
        np.array([start for start, _, _ in edges], np.intp).reshape(-1, 2),
        np.array([end for _, end, _ in edges], np.intp).reshape(-1, 2),
        np.array([edge["frames"] for edge in data], np.intp),
        np.array([edge["kind"] == "transition" for edge in data], bool),
        np.array([edge.get("cost", 0.0) for edge in data], float),
        PlanarTransform(*transforms.T),
    )


def frame_table(edges: EdgeTable, window: int) -> FrameTable:
    """Tell what every frame of some edges is made of [KGP02, Eqs. 5-7].

    Two blends never share a frame: a transition enters its clip at the frame after its window, and the next
    one leaves from there at the earliest.
    """
    edge = np.repeat(np.arange(len(edges.frames)), edges.frames)
    step = ranges(np.zeros_like(edges.frames), edges.frames)  # frames since the edge's first
    here, there = edges.leaves[edge], edges.enters[edge]
    here[:, 1] += step
    there[:, 1] += step - edges.frames[edge]
    alpha = np.ones(len(edge))
    blended = edges.blended[edge]
    alpha[blended] = cubic_weights(window)[step[blended]]
    return FrameTable(edge, here, there, alpha)


@dataclass(frozen=True, eq=False)
class Hops:
    """All H hops of a compiled graph, sorted by the node that they leave.

    A hop rides along the clip until it takes a transition, or has lasted `HOP` seconds. To step by edges, of
    a frame or two each, would come to the same walks.

    Parameters
    ----------
    first : shape (N + 1,), hops `first[n]` to `first[n + 1]` leave node n.
    ride, rides : shape (H,), the first stretch of clip that a hop rides along, and how many stretches.
    last : shape (H,), the edge that ends it: a transition, or the last stretch of the ride.
    starts, counts : shape (H, 2), the rows of frames that it plays, among those of all edges one after the
        other: first those of the ride before its last edge, then those of the last edge.
    """

    first: Indices
    ride: Indices
    rides: Indices
    last: Indices
    starts: Indices
    counts: Indices

    @cached_property
    def frames(self) -> Indices:
        """How many frames each hop plays, shape (H,)."""
        return np.asarray(self.counts.sum(axis=1))

    def leaving(self, nodes: Indices) -> tuple[Indices, Indices]:
        """List every hop from some nodes: which of the nodes it leaves, and its number."""
        first = self.first[nodes]
        count = self.first[nodes + 1] - first
        return np.repeat(np.arange(len(nodes)), count), ranges(first, count)

    def rows(self, hops: Indices) -> tuple[Indices, Indices]:
        """List the rows of all frames that some hops play, and which of the hops each belongs to."""
        rows = ranges(self.starts[hops].ravel(), self.counts[hops].ravel())
        return rows, np.repeat(np.arange(len(hops)), self.counts[hops].sum(axis=1))

    def edges(self, hops: Indices) -> Indices:
        """List the edges of some hops, in order."""
        rides = self.rides[hops]
        first = np.stack([self.ride[hops], self.last[hops]], axis=1)
        return ranges(first.ravel(), np.stack([rides, np.ones_like(rides)], axis=1).ravel())


def find_hops(edges: EdgeTable, leaves: Indices, nodes: int, fps: float) -> Hops:
    """Find the hops: from every node ride on, stretch by stretch, and leave by each transition on the way.

    A stretch of clip leads from node n to node n + 1, because the nodes are sorted.

    Parameters
    ----------
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    leaves : shape (E,), the number of the node that each edge leaves.
    nodes : how many there are.
    fps : frames per second.
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
        origins = np.repeat(origin, ways)
        found.append((origins, np.full(len(origins), count), ranges(first[here], ways)))
        riding = onward[here] >= 0
        origin, here, stretch = origin[riding], here[riding] + 1, onward[here[riding]]
        ridden, count = ridden[riding] + edges.frames[stretch], count + 1
        # A ride ends when it has lasted long enough, or its clip goes no further.
        over = (ridden >= HOP * fps) | ((onward[here] < 0) & (first[here] == first[here + 1]))
        found.append((origin[over], np.full(over.sum(), count - 1), stretch[over]))
        here, origin, ridden = here[~over], origin[~over], ridden[~over]
    start, rides, last = (np.concatenate(column) for column in zip(*found, strict=True))
    order = np.argsort(start, kind="stable")
    ride, rides, last = onward[start[order]], rides[order], last[order]
    leaving = np.searchsorted(start[order], np.arange(nodes + 1))
    return Hops(leaving, ride, rides, last, *_played(edges, ride, rides, last))


def _played(edges: EdgeTable, ride: Indices, rides: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Find the rows of frames that hops play; the stretches of a ride follow one another."""
    ends = np.cumsum(edges.frames)
    starts = np.stack([ends[ride] - edges.frames[ride], ends[last] - edges.frames[last]], axis=1)
    ridden = np.where(rides > 0, ends[ride + rides - 1] - starts[:, 0], 0)
    return starts, np.stack([ridden, edges.frames[last]], axis=1)
