"""What each edge of a motion graph plays, as arrays: one row per edge, one row per frame."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, ranges
from mocap.blending.weights import cubic_weights
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.motion_graph import MotionGraph, Node

Edge = tuple[Node, Node, int]


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
