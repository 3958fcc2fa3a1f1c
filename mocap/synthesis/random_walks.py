"""Random walks: choose the transitions of a motion graph at random, for a walk of any length."""

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
    """Walk through a graph at random for a given time.

    When `settle` seconds of clip have passed since the last transition, the walk takes one of the transitions
    that leave its node, else it stays on the clip. At the end of a clip it takes a transition at once. The
    odds of a transition are 1 / (cost + 1 mm).

    Parameters
    ----------
    motion_graph : the graph, pruned, so that a walk never ends.
    seconds : the least duration of the motion.
    seed : the same seed gives the same walk.
    settle : seconds of clip between two transitions, where the graph allows this.
    start : the first node; by default a random one.

    Returns
    -------
    The edges of the walk; their frames last `seconds` or a little longer.

    Raises
    ------
    NoWalk : for a start that is not in the graph, and for a walk that reaches a dead end.
    MocapError : for a duration that is not above 0.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> walk = random_walk(graph, seconds=5, seed=1)
    >>> sum(graph.graph.edges[edge]["frames"] for edge in walk) >= 5 * 30
    True

    Notebook: 07-walks-and-search
    """
    edges = wander(motion_graph, seed=seed, settle=settle, start=start)
    return next(cut_walk(motion_graph, edges, seconds))


def cut_walk(
    motion_graph: MotionGraph, edges: Iterator[Edge], seconds: float, piece: float = np.inf
) -> Iterator[list[Edge]]:
    """Cut a walk without end into pieces of at least `piece` seconds, and end it after `seconds`."""
    for name, value in (("walk", seconds), ("piece", piece)):
        if not value > 0 or (name == "walk" and np.isinf(value)):
            raise MocapError(f"A {name} must last longer than 0 s, got {value} s.")
    fps, done, frames = motion_graph.fps, 0, 0
    walk: list[Edge] = []
    for edge in edges:
        walk.append(edge)
        frames += motion_graph.graph.edges[edge]["frames"]
        over = done + frames >= seconds * fps
        if over or frames >= piece * fps:
            yield walk
            walk, done, frames = [], done + frames, 0
        if over:
            return


def wander(
    motion_graph: MotionGraph, *, seed: int = 0, settle: float = 1.0, start: Node | None = None
) -> Iterator[Edge]:
    """Yield the edges of a random walk without end; the parameters are those of `random_walk`.

    Examples
    --------
    A clip with one transition back: the walk goes round for ever.

    >>> from itertools import islice
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.prune(graphs.from_transitions([clip], [back], window=10))
    >>> [end for _, end, _ in islice(wander(graph, start=(0, 20)), 4)]
    [(0, 60), (0, 20), (0, 60), (0, 20)]

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
