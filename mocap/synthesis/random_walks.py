"""Random walks: wander through a motion graph for as long as one likes."""

from collections.abc import Iterator

import numpy as np

from mocap.errors import MocapError, NoWalk
from mocap.graphs.edge_tables import Edge, require_node
from mocap.graphs.motion_graph import MotionGraph, Node


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

    Notebook: 07-walks-and-search
    """
    if not (np.isfinite(seconds) and seconds > 0):
        raise MocapError(f"A walk must last longer than 0 s, got {seconds} s.")
    walk: list[Edge] = []
    frames = 0
    for edge in wander(motion_graph, seed=seed, settle=settle, start=start):
        walk.append(edge)
        frames += motion_graph.graph.edges[edge]["frames"]
        if frames >= seconds * motion_graph.clips[0].fps:
            break
    return walk


def wander(
    motion_graph: MotionGraph, *, seed: int = 0, settle: float = 1.0, start: Node | None = None
) -> Iterator[Edge]:
    """Give the edges of a random walk one by one, for ever; see `random_walk`.

    Notebook: 07-walks-and-search
    """
    graph, fps = motion_graph.graph, motion_graph.clips[0].fps
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))] if start is None else start
    require_node(motion_graph, node)
    frames, since = 0, 0
    while True:
        edges = list(graph.out_edges(node, keys=True, data=True))
        onward = [edge for edge in edges if edge[3]["kind"] == "clip"]
        leaving = [edge for edge in edges if edge[3]["kind"] == "transition"]
        choices = leaving if leaving and (since >= settle * fps or not onward) else onward
        if not choices:
            raise NoWalk(f"The walk ends at node {node} after {frames / fps:.1f} s: prune the graph first.")
        odds = np.array([1 / (edge[3].get("cost", 0.0) + 1e-3) for edge in choices])
        start_, node, key, data = choices[random.choice(len(choices), p=odds / odds.sum())]
        yield start_, node, key
        frames += data["frames"]
        since = since + data["frames"] if data["kind"] == "clip" else 0
