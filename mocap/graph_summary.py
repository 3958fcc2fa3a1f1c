"""Reading a graph: what it can play, how soon a walk can turn off, and what a threshold does to all that."""

from collections.abc import Sequence
from typing import NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from mocap.errors import MocapError
from mocap.kinematics import velocities
from mocap.matching import point_cloud
from mocap.motion import Motion
from mocap.pruning import Labels, name, reached
from mocap.transforms import PlanarTransform
from mocap.transitions import Transition

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


class Summary(NamedTuple):
    """What a motion graph can play.

    `frames` of the clips, which last `seconds`; `nodes`, `edges`, `transitions` of them; `out_degree`, the
    mean number of edges that leave a node; `mean_wait` and `worst_wait`, the seconds from a frame of a clip
    until a transition leaves it, infinite where the clip ends first; `reachable`, for each label set the
    others that a walk which starts with it can come to.
    """

    frames: int
    seconds: float
    nodes: int
    edges: int
    transitions: int
    out_degree: float
    mean_wait: float
    worst_wait: float
    reachable: dict[Labels, frozenset[Labels]]

    def table(self) -> str:
        """Write it in lines for people."""
        wait = f"{self.mean_wait:.2f} s away on average, {self.worst_wait:.2f} s at worst"
        rows = [
            ("frames", f"{self.frames} of the clips, {self.seconds:.1f} s"),
            ("nodes", f"{self.nodes}, with {self.out_degree:.2f} edges out of each"),
            ("edges", f"{self.edges}, of them {self.transitions} transitions"),
            ("turn-off", wait if np.isfinite(self.worst_wait) else "none before the end of some clip"),
        ]
        if len(self.reachable) > 1:
            rows += [
                (name(here), f"leads to {', '.join(sorted(map(name, there))) or 'nothing else'}")
                for here, there in self.reachable.items()
            ]
        return "\n".join(f"{what:<12} {text}" for what, text in rows)


def summary(graph: nx.MultiDiGraph, *, fps: float) -> Summary:
    """Sum up the graph of a `MotionGraph`.

    Parameters
    ----------
    graph : its `graph`, pruned or not.
    fps : frames a second of its clips.
    """
    transitions = [edge["kind"] == "transition" for _, _, edge in graph.edges(data=True)]
    frames, mean_wait, worst_wait = _waits(graph)
    return Summary(
        frames,
        frames / fps,
        graph.number_of_nodes(),
        graph.number_of_edges(),
        sum(transitions),
        graph.number_of_edges() / max(graph.number_of_nodes(), 1),
        mean_wait / fps,
        worst_wait / fps,
        _reachable(graph),
    )


def _waits(graph: nx.MultiDiGraph) -> tuple[int, float, float]:
    """Count the frames of clip, and how many frames before a turn-off they are: on average, and at worst."""
    turn_offs = {node for node, _, kind in graph.edges(data="kind") if kind == "transition"}
    stretches = [(a, b) for a, b, kind in graph.edges(data="kind") if kind == "clip"]
    ahead: dict[tuple[int, int], float] = {}  # from a node to the next turn-off
    frames, total, worst = 0, 0.0, 0.0
    for start, end in sorted(stretches, reverse=True):  # so that what follows is known
        after = 0.0 if end in turn_offs else ahead.get(end, np.inf)
        length = end[1] - start[1]
        ahead[start] = length + after
        # The frames wait length + after, … 1 + after; the first not at all where it is a turn-off.
        skipped = 1 if start in turn_offs else 0
        frames += length
        if length > skipped:
            total += (length - skipped) * (after + (length - skipped + 1) / 2)
            worst = max(worst, length - skipped + after)
    return frames, total / max(frames, 1), worst


def _reachable(graph: nx.MultiDiGraph) -> dict[Labels, frozenset[Labels]]:
    """Find for each label set of the clips which others a walk that starts with it can come to."""
    starts: dict[Labels, set[tuple[int, int]]] = {}
    for start, _, edge in graph.edges(data=True):
        if edge["kind"] == "clip":
            starts.setdefault(edge["labels"], set()).add(start)
    ways = {here: reached(graph, nodes) for here, nodes in starts.items()}
    return {
        here: frozenset(there for there in starts if there != here and starts[there] & ways[here])
        for here in starts
    }


class Sweep(NamedTuple):
    """Thresholds, metres, and for each what the graph would be; all arrays of shape (T,).

    `transitions`, and `nodes` and `edges` of the whole graph; nodes and frames of the component that plays
    most frames, 0 where nothing makes a cycle; the mean of the transitions' costs, metres, and of the jumps
    in their points' velocities, metres a second, 0 where there is no transition.
    """

    thresholds: Array
    transitions: Counts
    nodes: Counts
    edges: Counts
    largest_nodes: Counts
    largest_frames: Counts
    mean_cost: Array
    mean_jump: Array


def threshold_sweep(
    clips: Sequence[Motion], transitions: Sequence[Transition], thresholds: ArrayLike, *, window: int
) -> Sweep:
    """Tell what the motion graph would be at many thresholds, from one search for transitions.

    The transitions are sorted by cost once; a threshold then is how many of them count, and all its numbers
    but the components are sums up to there. Each component takes a time linear in the edges.

    Parameters
    ----------
    clips : the motions.
    transitions : from `find_transitions`, below the largest threshold.
    thresholds : shape (T,), metres.
    window : frames in a transition.
    """
    levels = np.asarray(thresholds, float)
    if levels.ndim != 1 or not (levels > 0).all():
        raise MocapError(f"Thresholds are numbers above 0 m, got {levels.tolist()}.")
    costs = np.array([t.cost for t in transitions])
    order = np.argsort(costs, kind="stable")
    jumps = velocity_jumps(clips, transitions, window=window)
    counts = np.searchsorted(costs[order], levels, side="left")
    ends = np.array([((t.source, t.leave), (t.target, t.enter + window)) for t in transitions], int)
    graph = _Growing(clips, ends.reshape(-1, 2, 2)[order])
    nodes = [graph.nodes(count) for count in counts]
    largest = np.array([graph.largest(count) for count in counts]).reshape(-1, 2)
    whole = np.array(nodes, int)
    return Sweep(
        levels,
        counts,
        whole,
        counts + whole - len(clips),  # a clip with n nodes has n - 1 stretches
        largest[:, 0],
        largest[:, 1],
        _means(costs[order], counts),
        _means(jumps[order], counts),
    )


def _means(values: Array, counts: Counts) -> Array:
    """Average the first so many values."""
    return np.asarray(np.cumsum([0, *values])[counts] / np.maximum(counts, 1))


class _Growing:
    """A motion graph as arrays, to which transitions come one by one.

    Its nodes are those that it will have in the end: cutting a stretch of clip earlier than need be leaves
    the frames of every component what they are.
    """

    def __init__(self, clips: Sequence[Motion], ends: NDArray[np.intp]) -> None:
        rims = [[clip, frame] for clip, motion in enumerate(clips) for frame in (0, len(motion))]
        points, number = np.unique(np.concatenate([rims, ends.reshape(-1, 2)]), axis=0, return_inverse=True)
        self.count = len(points)
        self.ways = number.reshape(-1)[len(rims) :].reshape(-1, 2)  # (N, 2), node to node
        (here,) = np.nonzero(points[1:, 0] == points[:-1, 0])
        self.stretches = np.stack([here, here + 1], axis=1)
        self.frames = points[here + 1, 1] - points[here, 1]
        self.since = np.full(self.count, len(ends) + 1)  # how many transitions it takes to make the node
        np.minimum.at(self.since, self.ways, np.arange(1, len(ends) + 1)[:, None])
        self.since[number.reshape(-1)[: len(rims)]] = 0

    def nodes(self, transitions: int) -> int:
        """Count the nodes once so many transitions are there."""
        return int((self.since <= transitions).sum())

    def largest(self, transitions: int) -> tuple[int, int]:
        """Count the nodes and the frames of the component that plays most frames."""
        start, end = np.concatenate([self.stretches, self.ways[:transitions]]).T
        matrix = coo_array((np.ones(len(start), bool), (start, end)), shape=(self.count, self.count))
        _, part = connected_components(matrix, directed=True, connection="strong")
        inside = part[start] == part[end]
        if not inside.any():
            return 0, 0
        here = inside[: len(self.frames)]
        frames = np.bincount(part[self.stretches[here, 0]], self.frames[here], minlength=part.max() + 1)
        edges = np.bincount(part[start[inside]], minlength=part.max() + 1)
        best = np.lexsort([edges, frames])[-1]
        return int(((part == best) & (self.since <= transitions)).sum()), int(frames[best])


def velocity_jumps(clips: Sequence[Motion], transitions: Sequence[Transition], *, window: int) -> Array:
    """Measure how differently the points move on both sides of each transition, at the middle of its window.

    Returns
    -------
    The RMS over the points of ‖v - T v'‖, shape (N,), metres a second.
    """
    moving = [velocities(point_cloud(clip), clip.fps) for clip in clips]
    middle = window // 2
    jumps = np.empty(len(transitions))
    for place, t in enumerate(transitions):
        turned = PlanarTransform(t.transform.angle, 0.0, 0.0).points(moving[t.target][t.enter + middle])
        gaps = moving[t.source][t.leave + middle] - turned
        jumps[place] = np.sqrt((gaps**2).sum(-1).mean())
    return jumps
