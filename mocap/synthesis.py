"""Out of the graph: walks, and the motions they stand for.

A walk is a list of edges (start node, end node, key), each starting where the one before ends.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mocap.blending import blend, cubic_weights
from mocap.errors import MocapError, NoWalk
from mocap.motion import Motion, concatenate
from mocap.motion_graph import MotionGraph, Node
from mocap.transforms import IDENTITY

Edge = tuple[Node, Node, int]


class Seam(NamedTuple):
    """A transition on a walk: the `frame` of the motion at which it starts, and its `cost` in metres."""

    frame: int
    cost: float


def random_walk(
    motion_graph: MotionGraph,
    *,
    seconds: float,
    seed: int = 0,
    settle: float = 1.0,
    start: Node | None = None,
) -> list[Edge]:
    """Wander through a graph for a while.

    Where the last transition is `settle` seconds past, the walk takes one of the transitions at hand, the
    likelier the less it costs; else it goes on along the clip. Where the clip does not go on, it must leave.

    Parameters
    ----------
    motion_graph : the graph, pruned, so that a walk never ends.
    seconds : how long the motion shall be at least.
    seed : the same seed gives the same walk.
    settle : seconds of clip between two transitions, where the graph allows.
    start : the first node; by default one drawn at random.

    Returns
    -------
    Edges, as many as needed.

    Raises
    ------
    NoWalk : for a start that the graph lacks, and where the walk runs into a dead end.

    Notebook: 00-quickstart
    """
    if not (np.isfinite(seconds) and seconds > 0):
        raise MocapError(f"A walk must last longer than 0 s, got {seconds} s.")
    graph, fps = motion_graph.graph, motion_graph.clips[0].fps
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))] if start is None else start
    if node not in graph:
        raise NoWalk(f"The graph has no node {node}.")
    walk: list[Edge] = []
    frames, since = 0, 0
    while frames < seconds * fps:
        edges = list(graph.out_edges(node, keys=True, data=True))
        onward = [edge for edge in edges if edge[3]["kind"] == "clip"]
        leaving = [edge for edge in edges if edge[3]["kind"] == "transition"]
        choices = leaving if leaving and (since >= settle * fps or not onward) else onward
        if not choices:
            raise NoWalk(f"The walk ends at node {node} after {frames / fps:.1f} s: prune the graph first.")
        odds = np.array([1 / (edge[3].get("cost", 0.0) + 1e-3) for edge in choices])
        *edge, data = choices[random.choice(len(choices), p=odds / odds.sum())]
        walk.append((edge[0], edge[1], edge[2]))
        node, frames = edge[1], frames + data["frames"]
        since = since + data["frames"] if data["kind"] == "clip" else 0
    return walk


def to_motion(motion_graph: MotionGraph, walk: Sequence[Edge], *, name: str = "walk") -> Motion:
    """Play a walk: stretches of clip as they are, transitions blended, each placed where the last one led.

    Every frame is moved by the product of the transforms of the transitions passed so far [KGP02, 4.1].
    A walk that passes none repeats its clip bit for bit.

    Parameters
    ----------
    motion_graph : the graph.
    walk : edges, each starting where the one before ends.
    name : the new motion's name.

    Returns
    -------
    As many frames as the edges have together; it starts where its first clip is.

    Raises
    ------
    NoWalk : for an empty walk, an edge that the graph lacks, or one that starts elsewhere.

    Notebook: 00-quickstart
    """
    _require_walk(motion_graph, walk)
    window = motion_graph.window
    place, pieces = IDENTITY, []
    for start, end, key in walk:
        edge = motion_graph.graph.edges[start, end, key]
        source, target = motion_graph.clips[start[0]], motion_graph.clips[end[0]]
        if edge["kind"] == "clip":
            piece = source[start[1] : end[1]]
            pieces.append(piece if place is IDENTITY else place.motion(piece))
        else:
            leaving = source[start[1] : start[1] + window]
            entering = edge["transform"].motion(target[end[1] - window : end[1]])
            pieces.append(place.motion(blend(leaving, entering, cubic_weights(window))))
            place = place.after(edge["transform"])
    return replace(concatenate(pieces), name=name)


def _require_walk(motion_graph: MotionGraph, walk: Sequence[Edge]) -> None:
    if not walk:
        raise NoWalk("The walk has no edges.")
    for edge in walk:
        if not motion_graph.graph.has_edge(*edge):
            raise NoWalk(f"The graph has no edge {edge}.")
    for (_, end, _), (start, _, _) in pairwise(walk):
        if end != start:
            raise NoWalk(f"The walk jumps from node {end} to node {start}.")


def seams(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[Seam]:
    """List the transitions that a walk passes.

    Notebook: 00-quickstart
    """
    found, frame = [], 0
    for edge in walk:
        data = motion_graph.graph.edges[edge]
        if data["kind"] == "transition":
            found.append(Seam(frame, data["cost"]))
        frame += data["frames"]
    return found


def sources(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[tuple[int, str]]:
    """Tell which clip a walk plays from which frame on; within a transition it changes half-way."""
    found, frame = [(0, motion_graph.clips[walk[0][0][0]].name)], 0
    for start, end, key in walk:
        data = motion_graph.graph.edges[start, end, key]
        if data["kind"] == "transition" and end[0] != start[0]:
            found.append((frame + data["frames"] // 2, motion_graph.clips[end[0]].name))
        frame += data["frames"]
    return found
