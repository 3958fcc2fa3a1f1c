"""Waits: walks through the standing stretches of a graph, and frames held while the body stands."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Mapping, Sequence
from itertools import count

import numpy as np

from mocap._shared.arrays import Array
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


class Wait(NamedTuple):
    """A walk through standing nodes, and the number of its frames."""

    edges: Sequence[Edge]
    frames: int


class Hold(NamedTuple):
    """Frames that are added to a motion while its body stands.

    Parameters
    ----------
    frame : the frame before which they are added, counted without any holds. It may be the number of frames.
    back, ahead : the numbers of frames before and after it in which the body stands.
    added : the number of frames to add.
    """

    frame: int
    back: int
    ahead: int
    added: int


Edges = Mapping[Node, list[Standing]]
Waits = dict[Node, Wait]
"""A wait for each of some nodes, at which it ends (or starts, if edges are followed backwards)."""


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


def shortest_waits(edges: Edges, start: Node, *, smoothest: bool = False) -> Waits:
    """Find the shortest wait from a standing node to each one that can be reached (Dijkstra's algorithm).

    Parameters
    ----------
    edges : from `standing_edges`. Backwards, walks lead to `start`.
    start : a standing node.
    smoothest : whether to find the waits with the least sum of squared seam costs, and of these the shortest.

    Examples
    --------
    A stretch of 60 frames, and a seam that skips most of them:

    >>> clip = Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0)
    >>> skip = Standing(((0, 0), (0, 60), 1), (0, 60), 10, 0.0004)
    >>> shortest_waits({(0, 0): [clip, skip]}, (0, 0))[0, 60].frames
    10
    >>> shortest_waits({(0, 0): [clip, skip]}, (0, 0), smoothest=True)[0, 60].frames
    60
    """
    reached: dict[Node, _Reached] = {}
    order = count()  # so that equal keys are taken in the order in which they are found
    queue = [(0.0, 0.0, next(order), start, _Reached(0, start, None))]
    while queue:
        first_key, second_key, _, node, step = heapq.heappop(queue)
        if node in reached:
            continue
        reached[node] = step
        for edge in edges.get(node, ()):
            keys = (edge.price, edge.frames) if smoothest else (edge.frames, edge.price)
            longer = _Reached(step.frames + edge.frames, node, edge.edge)
            sums = (first_key + keys[0], second_key + keys[1])
            heapq.heappush(queue, (*sums, next(order), edge.node, longer))
    return {node: _trace(reached, node) for node in reached}


class _Reached(NamedTuple):
    """A node that is reached: the frames until then, the node before it, and the edge from there."""

    frames: int
    source: Node
    edge: Edge | None


def _trace(reached: Mapping[Node, _Reached], node: Node) -> Wait:
    """Return the wait by which a node is reached, with its edges in their order in time."""
    walk: list[Edge] = []
    step = reached[node]
    while step.edge is not None:
        walk.append(step.edge)
        step = reached[step.source]
    is_backwards = bool(walk) and walk[0][0] == node
    return Wait(walk if is_backwards else walk[::-1], reached[node].frames)


def longest_stand(edges: Edges, start: Node, frames: int) -> Wait:
    """Return the longest wait from a node without a seam, of at most so many frames.

    Examples
    --------
    >>> longest_stand({(0, 0): [Standing(((0, 0), (0, 60), 0), (0, 60), 60, 0.0)]}, (0, 0), 90).frames
    60
    """
    within_clips = {node: [edge for edge in leaving if edge.price == 0] for node, leaving in edges.items()}
    waits = shortest_waits(within_clips, start).values()
    return max((wait for wait in waits if wait.frames <= frames), key=lambda wait: wait.frames)


def held_frames(frames: int, holds: Sequence[Hold]) -> Array:
    """Return the fractional frame of a motion that is shown in each frame of the same motion with holds.

    A held body does not freeze: its time sways to and fro over the frames in which it stands, as a sine, and
    no faster than the motion itself. The hold begins and ends in the frame in which it is made.

    Parameters
    ----------
    frames : the number of frames of the motion.
    holds : in the order of their frames.

    Examples
    --------
    Three frames are added before the last one of five:

    >>> held_frames(5, [Hold(4, 2, 0, 3)]).round(1).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0, 3.3, 3.3, 4.0]
    """
    parts = []
    start = 0
    for hold in holds:
        parts += [np.arange(start, hold.frame, dtype=float), _swaying(hold, frames)]
        start = hold.frame
    return np.concatenate([*parts, np.arange(start, frames, dtype=float)])


def _swaying(hold: Hold, frames: int) -> Array:
    """Return the frames of a hold: a sine around the middle of the standing frames, from its frame on."""
    base = min(hold.frame, frames - 1)
    reach = (hold.back + hold.ahead) / 2
    if reach == 0:
        return np.full(hold.added, float(base))
    middle = (hold.ahead - hold.back) / 2
    periods = max(1, int(hold.added / (2 * np.pi * reach)))
    scale = min(1.0, hold.added / (2 * np.pi * reach * periods))
    fraction = np.arange(hold.added) / hold.added
    phase = 2 * np.pi * periods * fraction - np.arcsin(middle / reach)
    return np.asarray(base + scale * (middle + reach * np.sin(phase)))
