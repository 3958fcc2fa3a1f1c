"""The frames of each edge and of each macro-edge of a motion graph, as arrays.

An array has a row for each edge, each frame or each macro-edge. `MacroEdges` defines macro-edges.
"""

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
from mocap.graphs.tuned import TUNED

Edge = tuple[Node, Node, int]

FRAME = 1  # column of (clip, frame)


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """E edges of a motion graph as arrays, and the F frames that they play, edge after edge.

    A frame is a blend of two frames of clips: `alpha` times `here` plus `1 - alpha` times `there`, after
    `there` has been aligned with `here`.

    Parameters
    ----------
    first, frames : shape (E,), the row of the first frame of an edge, and the number of its frames.
    cost : shape (E,), the RMS distance of a transition; 0 for a stretch of clip.
    blended : shape (E,), whether an edge is a transition.
    angle, rotation, translation : shape (E,), the angle (radians) and the planar transform
        p ↦ rotation · p + translation that aligns the clip that an edge enters with the clip that it leaves.
        For a stretch of clip it is the identity.
    of : shape (F,), the edge of a frame.
    here, there : shape (F, 2), the frames of the clips that the edge leaves and enters, as (clip, frame). For
        a stretch of clip they are the same.
    alpha : shape (F,), the weight of `here`.
    """

    first: Indices
    frames: Indices
    cost: Array
    blended: Mask
    angle: Array
    rotation: Points
    translation: Points
    of: Indices
    here: Indices  # reads: name: `steering` reads this field
    there: Indices  # reads: name: `steering` reads this field
    alpha: Array

    @property
    def owner(self) -> Indices:
        """The frame of a clip with the larger weight, (F, 2), whose labels and contacts the blend has."""
        return np.where(self.alpha[:, None] >= 0.5, self.here, self.there)


def require_node(motion_graph: MotionGraph, node: Node) -> None:
    """Raise `NoWalk` unless a node is in the graph."""
    if node not in motion_graph.graph:
        clip, frame = node
        frames = [f for c, f in motion_graph.graph if c == clip]
        if not frames:
            raise NoWalk(f"The graph has no node {node}, and none in that clip.")
        nearest = min(frames, key=lambda choice: abs(choice - frame))
        raise NoWalk(f"The graph has no node {node}; the nearest is {(clip, nearest)}.")


def edge_table(motion_graph: MotionGraph, edges: Sequence[Edge]) -> EdgeTable:
    """Tabulate edges, and the two frames of clips that each of their frames blends [KGP02, Eqs. 5-7].

    Each frame is blended at most once, because a transition enters its clip at the frame after its window. A
    transition of 10 frames from frame 60 to frame 20 blends the frames 60 to 69 with the frames 10 to 19.

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
    number = {edge: index for index, edge in enumerate(dict.fromkeys(map(tuple, edges)))}
    distinct = np.array([number[tuple(edge)] for edge in edges], np.intp)  # a long walk often repeats an edge
    data = [motion_graph.graph.edges[edge] for edge in number]
    frames = np.array([edge["frames"] for edge in data], np.intp)[distinct]
    blended = np.array([edge["kind"] == "transition" for edge in data], bool)[distinct]
    cost = np.array([edge.get("cost", 0.0) for edge in data], float)[distinct]
    transforms = np.array([edge.get("transform", IDENTITY) for edge in data], float).reshape(-1, 3)[distinct]
    aligning = PlanarTransform(*transforms.T)
    angle = np.asarray(aligning.angle)
    rotation = aligning.rotation
    translation = aligning.translation
    first = np.asarray(np.cumsum(frames) - frames, np.intp)
    of = np.repeat(np.arange(len(edges)), frames)
    elapsed = np.arange(len(of)) - first[of]  # frames since the edge's first
    ends = np.array([(start, end) for start, end, _ in number], np.intp).reshape(-1, 2, 2)[distinct]
    leaving = ends[of, 0]
    entering = ends[of, 1]
    leaving[:, FRAME] += elapsed
    entering[:, FRAME] += elapsed - frames[of]
    in_blend = blended[of]
    alpha = np.ones(len(of))
    alpha[in_blend] = cubic_weights(motion_graph.window)[elapsed[in_blend]]
    return EdgeTable(
        first=first,
        frames=frames,
        cost=cost,
        blended=blended,
        angle=angle,
        rotation=rotation,
        translation=translation,
        of=of,
        here=leaving,
        there=entering,
        alpha=alpha,
    )


def clip_rows(clips: Sequence[Motion], frames: Indices) -> Indices:
    """Return the rows of frames (clip, frame), shape (N, 2), in the concatenated clips.

    Frames outside a clip are clamped to its first or last frame.

    Examples
    --------
    >>> from mocap import datasets
    >>> clip = datasets.sample("walk_straight")[:90]
    >>> clip_rows([clip, clip], np.array([[0, 5], [1, 5], [1, 99]]))
    array([  5,  95, 179])
    """
    lengths = np.array([len(clip) for clip in clips])
    starts = np.cumsum(lengths) - lengths
    clip, frame = frames.T
    return np.asarray(starts[clip] + np.clip(frame, 0, lengths[clip] - 1))


@dataclass(frozen=True, eq=False)
class MacroEdges:
    """All H macro-edges of a compiled graph with N nodes, sorted by the node that they leave.

    A macro-edge is a sequence of edges that a search takes in one step. It follows the clip until it takes a
    transition, or has lasted `TUNED.longest_macro_edge` seconds, or reaches a dead end. Edges are often only
    a frame or two long: with single edges, a search would find the same walks in many more steps.

    Parameters
    ----------
    first : shape (N + 1,), the macro-edges `first[n]` to `first[n + 1] - 1` leave node n.
    stretch, stretches : shape (H,), the first stretch of clip, and the number of stretches before `last`.
    last : shape (H,), the last edge of a macro-edge, a transition or a stretch of clip.
    starts, counts : shape (H, 2), two ranges of rows in the arrays of all frames, given by first row and
        number: the stretches before the last edge, and the last edge.
    frames : shape (H,), the number of frames of each macro-edge.

    Examples
    --------
    A clip of 90 frames has a transition from frame 60 to frame 20. One macro-edge leaves the start, one
    leaves frame 20, two leave frame 60, and none leaves the end:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)[:90]
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> macro_edges = graphs.compile_graph(graphs.from_transitions([clip], [back], window=10)).macro_edges
    >>> macro_edges.first.tolist(), macro_edges.frames.tolist()
    ([0, 1, 2, 4, 4], [20, 40, 10, 30])
    """

    first: Indices
    stretch: Indices
    stretches: Indices
    last: Indices
    starts: Indices
    counts: Indices
    frames: Indices

    def leaving(self, nodes: Indices) -> tuple[Indices, Indices]:
        """Return the macro-edges that leave some nodes: for each an index into `nodes`, and its number."""
        first = self.first[nodes]
        count = self.first[nodes + 1] - first
        return np.repeat(np.arange(len(nodes)), count), ranges(first, count)

    def rows(self, macro_edges: Indices) -> tuple[Indices, Indices]:
        """Return the rows of all frames of some macro-edges, and for each row an index into `macro_edges`."""
        rows = ranges(self.starts[macro_edges].ravel(), self.counts[macro_edges].ravel())
        return rows, np.repeat(np.arange(len(macro_edges)), self.frames[macro_edges])

    def edges(self, macro_edges: Indices) -> Indices:
        """Return the edges of some macro-edges, in order."""
        first = np.stack([self.stretch[macro_edges], self.last[macro_edges]], axis=1)
        counts = np.stack([self.stretches[macro_edges], np.ones_like(macro_edges)], axis=1)
        return ranges(first.ravel(), counts.ravel())


def find_macro_edges(edges: EdgeTable, starts: Indices, nodes: int, fps: float) -> MacroEdges:
    """Enumerate the macro-edges: from every node follow the clip, and leave it by each transition on the way.

    Parameters
    ----------
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    starts : shape (E,), the number of the node that each edge leaves.
    nodes : the number of nodes. They are sorted, therefore a stretch of clip leads from node n to node n + 1.
    fps : frames per second.
    """
    stretch_from: list[int | None] = [None] * nodes
    transitions_from: list[list[int]] = [[] for _ in range(nodes)]
    for edge, (node, blended) in enumerate(zip(starts.tolist(), edges.blended.tolist(), strict=True)):
        if blended:
            transitions_from[node].append(edge)
        else:
            stretch_from[node] = edge
    lengths = edges.frames.tolist()
    longest = TUNED.longest_macro_edge * fps
    macro_edges: list[MacroEdge] = []
    for node in range(nodes):
        macro_edges += _macro_edges_from(node, stretch_from, transitions_from, lengths, longest=longest)
    node_of, stretches, last = np.array(macro_edges).T
    stretch = np.array([-1 if edge is None else edge for edge in stretch_from])[node_of]
    # A macro-edge plays two ranges of frames: those of its consecutive stretches, and those of
    # `last`.
    frames_before = np.append(0, np.cumsum(edges.frames))
    followed = np.where(stretches > 0, frames_before[stretch + stretches] - frames_before[stretch], 0)
    played = edges.frames[last]
    first = np.searchsorted(node_of, np.arange(nodes + 1))
    rows = np.stack([frames_before[stretch], frames_before[last]], axis=1)
    counts = np.stack([followed, played], axis=1)
    return MacroEdges(
        first=first,
        stretch=stretch,
        stretches=stretches,
        last=last,
        starts=rows,
        counts=counts,
        frames=counts.sum(axis=1),
    )


# The node that it leaves, the number of stretches before its last edge, that edge.
MacroEdge = tuple[int, int, int]


def _macro_edges_from(
    node: int,
    stretch_from: Sequence[int | None],
    transitions_from: Sequence[Sequence[int]],
    lengths: Sequence[int],
    *,
    longest: float,
) -> list[MacroEdge]:
    """Enumerate the macro-edges from a node: one by each transition on the way, and one within the clip.

    Parameters
    ----------
    node : the node from which the macro-edges start.
    stretch_from, transitions_from : for each node, the stretch of clip and the transitions that leave it.
    lengths : the number of frames of each edge.
    longest : frames of clip after which a macro-edge ends.
    """
    macro_edges: list[MacroEdge] = []
    current = node
    frames = 0
    while True:
        macro_edges += [(node, current - node, transition) for transition in transitions_from[current]]
        stretch = stretch_from[current]
        if stretch is None:
            return macro_edges  # the clip ends here
        frames += lengths[stretch]
        current += 1
        dead_end = stretch_from[current] is None and not transitions_from[current]
        if frames >= longest or dead_end:
            return [*macro_edges, (node, current - node - 1, stretch)]
