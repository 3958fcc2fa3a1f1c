"""Waits: walks through the standing stretches of a graph that last a given time."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from mocap._shared.records import NamedTuple
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, Node


class Standing(NamedTuple):
    """An edge between two standing nodes: the node at its other end, its frames, and its squared cost.

    Examples
    --------
    >>> Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0).frames
    60
    """

    edge: Edge
    node: Node
    frames: int
    price: float


Edges = Mapping[Node, list[Standing]]
Waits = dict[Node, list[Edge]]
"""A walk for each of some nodes, at which it ends (or starts, if edges are followed backwards)."""


class _Step(NamedTuple):
    """A node reached after some frames: the total price, the last edge, and the node and frames before."""

    price: float
    edge: Edge | None
    node: Node
    earlier: int


def standing_edges(graph: MotionGraph, nodes: Collection[Node], *, backwards: bool = False) -> Edges:
    """Return the edges between standing nodes, by the nodes from which they are followed.

    Examples
    --------
    >>> from mocap import datasets, graphs, body
    >>> clip = body.resample(datasets.sample("stop_and_go"), 30)
    >>> graph = graphs.from_transitions([clip[:60]], [], window=10)
    >>> standing_edges(graph, {(0, 0), (0, 60)})[0, 0][0].frames
    60
    """
    edges: dict[Node, list[Standing]] = {}
    for start, end, key, data in graph.graph.edges(nbunch=nodes, keys=True, data=True):
        if end in nodes:
            followed = (end, start) if backwards else (start, end)
            price = data.get("cost", 0.0) ** 2
            step = Standing((start, end, key), followed[1], data["frames"], price)
            edges.setdefault(followed[0], []).append(step)
    return edges


def find_waits(edges: Edges, start: Node, frames: int, slack: int) -> Waits:
    """Find walks from a standing node through standing nodes that last about a given time.

    Of the walks to a node, the one whose duration is nearest is returned, of these that with the smallest sum
    of squared seam costs, by dynamic programming over the frames.

    Parameters
    ----------
    edges : from `standing_edges`. Backwards, walks lead to `start`.
    start : a standing node.
    frames : the duration.
    slack : the largest difference from it. If no walk is within it, the result is empty.

    Examples
    --------
    >>> edges = {(0, 0): [Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0)]}
    >>> find_waits(edges, (0, 0), frames=58, slack=3)
    {(0, 60): [((0, 0), (0, 60), 0)]}
    """
    reached = _reached(edges, start, frames + slack)
    waits: Waits = {}
    for offset in sorted(range(-slack, slack + 1), key=abs):
        duration = frames + offset
        for node in reached[duration] if duration >= 0 else ():
            if node not in waits:
                waits[node] = _trace(reached, node, duration)
    return waits


def wait_durations(edges: Edges, starts: Iterable[Node], frames: int) -> dict[Node, list[int]]:
    """Return the durations of all waits from some nodes, at most so many frames, by their last nodes.

    Examples
    --------
    >>> edges = {(0, 0): [Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0)]}
    >>> wait_durations(edges, [(0, 0)], frames=90)
    {(0, 0): [0], (0, 60): [60]}
    """
    reached: list[set[Node]] = [set() for _ in range(frames + 1)]
    reached[0].update(starts)
    durations: dict[Node, list[int]] = {}
    for duration, nodes in enumerate(reached):
        for node in nodes:
            durations.setdefault(node, []).append(duration)
            for edge in edges.get(node, ()):
                if duration + edge.frames <= frames:
                    reached[duration + edge.frames].add(edge.node)
    return durations


def longest_wait(edges: Edges, start: Node, frames: int) -> list[Edge]:
    """Find the longest wait from a node, of at most so many frames.

    Examples
    --------
    >>> longest_wait({(0, 0): [Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0)]}, (0, 0), 90)
    [((0, 0), (0, 60), 0)]
    """
    reached = _reached(edges, start, frames)
    last = max(frame for frame, steps in enumerate(reached) if steps)
    return _trace(reached, next(iter(reached[last])), last)


def _reached(edges: Edges, start: Node, frames: int) -> list[dict[Node, _Step]]:
    """Return the nodes that are reached after each number of frames, with the best last step."""
    reached: list[dict[Node, _Step]] = [{} for _ in range(frames + 1)]
    reached[0][start] = _Step(0.0, None, start, 0)
    for frame, steps in enumerate(reached):
        for node, step in steps.items():
            for edge in edges.get(node, ()):
                later = frame + edge.frames
                price = step.price + edge.price
                if later <= frames and _is_better(price, reached[later].get(edge.node)):
                    reached[later][edge.node] = _Step(price, edge.edge, node, frame)
    return reached


def _is_better(price: float, step: _Step | None) -> bool:
    """Return whether a price is below that of a step, if there is one."""
    return step is None or price < step.price


def _trace(reached: list[dict[Node, _Step]], node: Node, frame: int) -> list[Edge]:
    """Return the edges by which a node is reached after `frame` frames, in their order in time."""
    walk: list[Edge] = []
    step = reached[frame][node]
    while step.edge is not None:
        walk.append(step.edge)
        step = reached[step.earlier][step.node]
    is_backwards = bool(walk) and walk[0][0] == node
    return walk if is_backwards else walk[::-1]
