"""Motion graphs, as `networkx` graphs: nodes are choice points, edges are frames to be played [KGP02].

A node is a choice point (clip, frame), where frame is the next frame to be played. An edge from it is either
the stretch of that clip up to its next choice point, or a transition: `window` blended frames that lead to
another node. The frames of a walk are those of its edges, in order.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arguments import called_as
from mocap._shared.collector import uncollected
from mocap._shared.progress import Progress
from mocap._shared.quantities import check_frames, check_threshold, described
from mocap._shared.records import dataclass
from mocap._shared.suggestions import missing_attribute
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion, require_motions
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError
from mocap.graphs.components import Labels
from mocap.matching.minima import fit
from mocap.matching.transitions import Thresholds, Transition, find_transitions, join_clouds

Node = tuple[int, int]
KINDS = ("clip", "transition")  # of edges
EXPRESSIONS = {
    "nodes": "graph.graph.nodes",
    "edges": "graph.graph.edges",
    "transitions": 'graph.count("transition")',
    "save": "graphs.save(graph, 'graph.npz')",
    "prune": "graphs.prune(graph)",
}
"""Suggestions for unknown attributes of a motion graph."""


@dataclass(frozen=True, eq=False)
class MotionGraph:
    """A motion graph: clips, and a graph whose edges refer to their frames.

    Parameters
    ----------
    clips : the motions. The first number of a node is an index into this tuple.
    window : frames in a transition.
    graph : the `networkx.MultiDiGraph`. Nodes are pairs (clip, frame). Edges have `kind` ("clip" or
        "transition"), `frames`, their number, and `labels`, a frozenset of all labels of the frames that they
        play or blend. Transitions also have `cost` (RMS distance, metres) and `transform`, which aligns the
        clip that they enter with the clip that they leave.

    Examples
    --------
    A clip without transitions is a single edge:

    >>> from mocap import datasets
    >>> alone = from_transitions([datasets.sample("walk_curve_1")], [], window=10)
    >>> alone.count("clip"), alone.count("transition")
    (1, 0)
    """

    clips: tuple[Motion, ...]
    window: int
    graph: nx.MultiDiGraph

    def __repr__(self) -> str:
        return (
            f"MotionGraph({len(self.clips)} clips, {self.graph.number_of_nodes()} nodes, "
            f"{self.graph.number_of_edges()} edges, {self.count('transition')} of them transitions)"
        )

    if not TYPE_CHECKING:  # type checkers refuse an unknown attribute by themselves

        def __getattr__(self, name: str) -> object:
            raise missing_attribute(self, name, EXPRESSIONS)

    @property
    def fps(self) -> float:
        """Frames per second of the clips."""
        return self.clips[0].fps

    def count(self, kind: str) -> int:
        """Count the edges of a kind, "clip" or "transition"; raise `MocapError` for another kind."""
        if kind not in KINDS:
            raise MocapError(f"Edges are of the kinds 'clip' and 'transition', got {described(kind)}.")
        return sum(edge_kind == kind for _, _, edge_kind in self.graph.edges(data="kind"))


def require_graph(graph: object) -> MotionGraph:
    """Return a motion graph as it is. Raise for anything else, with the call that makes one.

    Examples
    --------
    >>> require_graph("graph.npz")
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes a MotionGraph, got the text 'graph.npz': graphs.load reads one.
    """
    if isinstance(graph, MotionGraph):
        return graph
    needs = f"This takes a MotionGraph, got {described(graph)}"
    if isinstance(graph, nx.Graph):
        raise MocapError(f"{needs}, its field `graph`: pass the MotionGraph itself.")
    if isinstance(graph, list | tuple | Motion):
        raise MocapError(f"{needs}: graphs.build(clips, window=10, threshold=0.04) makes one of clips.")
    if isinstance(graph, str | PathLike):
        raise MocapError(f"{needs}: graphs.load reads one.")
    raise MocapError(f"{needs}: the graph comes first, then what is asked of it.")


@called_as("graphs.build(clips, window=10, threshold=0.04)")
def build(  # noqa: PLR0913 (the parameters of `find_transitions`)
    clips: Sequence[Motion],
    *,
    window: int,
    threshold: Thresholds,
    joint_weights: ArrayLike | None = None,
    taper: ArrayLike | None = None,
    progress: Progress = iter,
    executor: Executor | None = None,
    jobs: int | None = None,
) -> MotionGraph:
    """Build the motion graph of clips: find the transitions, and cut the clips where they leave and enter.

    In the paper: [KGP02, 3].

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, with different names.
    window : frames in a transition, about a third of a second.
    threshold : the largest RMS distance of the points in a transition, metres, or one for each pair of
        labels, as for `matching.find_transitions`.
    joint_weights, taper, progress, executor, jobs : as for `matching.find_transitions`.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips of different skeletons or rates, two clips of one name, or clips
        shorter than the window. For clips of different rates: `build([resample(clip, 30) for clip in clips],
        ...)`.

    Examples
    --------
    A lower threshold results in fewer transitions:

    >>> from mocap import body, datasets
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> loose, strict = (build(clips, window=10, threshold=metres) for metres in (0.04, 0.02))
    >>> loose.count("transition") > strict.count("transition") > 0
    True

    Notebook: 00-quickstart
    """
    _require_names(clips)
    check_frames(window, "A window", clips[0].fps if len(clips) else None)
    check_threshold(threshold)
    transitions = find_transitions(
        clips,
        window=window,
        below=threshold,
        joint_weights=joint_weights,
        taper=taper,
        progress=progress,
        executor=executor,
        jobs=jobs,
    )
    return from_transitions(clips, transitions, window=window)


def labels_between(motion: Motion, start: int, end: int) -> Labels:
    """Collect the labels of the frames [start, end).

    Examples
    --------
    >>> from mocap import datasets
    >>> labels_between(datasets.sample("walk_circle"), 0, 10)
    frozenset({'walk'})
    """
    return frozenset(label for label, mark in motion.labels.items() if mark[start:end].any())


@uncollected()
def from_transitions(
    clips: Sequence[Motion], transitions: Sequence[Transition], *, window: int
) -> MotionGraph:
    """Build a motion graph from given transitions.

    A transition leaves the first clip at the first frame of its window, and enters the second clip at the
    frame after its window [KGP02, 3.3].

    Raises
    ------
    SkeletonMismatch, MocapError : for clips of different skeletons or rates, two clips of one name, and
        transitions outside the clips.

    Examples
    --------
    The window of one transition leads from frame 60 back to frame 10; it enters the clip at frame 20:

    >>> from mocap import body, datasets, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> from_transitions([clip], [back], window=10)
    MotionGraph(1 clips, 4 nodes, 4 edges, 1 of them transitions)

    Notebook: 05b-choice-points
    """
    _require_names(clips)
    check_frames(window, "A window", clips[0].fps if len(clips) else None)
    clips = require_compatible(clips)
    for t in transitions:
        for clip, start in ((t.source, t.leave), (t.target, t.enter)):
            if not (0 <= clip < len(clips) and 0 <= start <= len(clips[clip]) - window):
                span = f"{window} frames from frame {start} of clip {clip}"
                raise MocapError(f"A transition of {span} lies outside the clips.")
    return MotionGraph(clips, window, cut_and_join(clips, transitions, window))


def cut_and_join(clips: Sequence[Motion], transitions: Sequence[Transition], window: int) -> nx.MultiDiGraph:
    """Cut clips where transitions leave and enter, and join the pieces into a graph.

    `from_transitions` also checks its arguments.

    Parameters
    ----------
    clips, transitions : as for `from_transitions`.
    window : frames in a transition.

    Returns
    -------
    The graph of a `MotionGraph`.

    Examples
    --------
    >>> from mocap import body, datasets, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> list(cut_and_join([clip[:90]], [back], 10).edges(data="kind"))
    [((0, 0), (0, 20), 'clip'), ((0, 60), (0, 20), 'transition'), ((0, 60), (0, 90), 'clip'),
     ((0, 20), (0, 60), 'clip')]

    Notebook: 05-motion-graph
    """
    graph = nx.MultiDiGraph()
    for clip, motion in enumerate(clips):
        graph.add_nodes_from([(clip, 0), (clip, len(motion))])
    for t in transitions:
        leave = (t.source, t.leave)
        enter = (t.target, t.enter + window)
        source_labels = labels_between(clips[t.source], t.leave, t.leave + window)
        target_labels = labels_between(clips[t.target], t.enter, t.enter + window)
        edge = {"kind": "transition", "frames": window, "labels": source_labels | target_labels}
        graph.add_edge(leave, enter, **edge, cost=t.cost, transform=t.transform)
    # Sorted nodes of a clip are in the order of time: a stretch of clip joins each node to the next.
    for (clip, start), (next_clip, end) in pairwise(sorted(graph)):
        if clip == next_clip:
            labels = labels_between(clips[clip], start, end)
            graph.add_edge((clip, start), (clip, end), kind="clip", frames=end - start, labels=labels)
    return graph


def _require_names(clips: Sequence[Motion]) -> None:
    names = [clip.name for clip in require_motions(clips)]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise MocapError(f"Clips need different names; given twice: {', '.join(twice)}.")


Ends = tuple[Node, Node]


def merge_choice_points(motion_graph: MotionGraph, *, within: int, threshold: float) -> MotionGraph:
    """Merge choice points of a clip that are within a few frames, and keep all walks possible.

    If two clips remain similar for a while, transitions leave at several nearby frames. Merged at one frame,
    the transitions have a slightly higher cost, but a walk can choose between all of them. A transition may
    then leave its clip later, or enter the other clip earlier, but never the opposite, therefore no frame of
    a clip is lost. The moved transitions are aligned again, and their costs computed. If a moved transition
    has a cost of `threshold` or more, extends beyond the end of its clip or blends overlapping windows, its
    choice point that was moved by more frames is restored.

    Parameters
    ----------
    motion_graph : the graph before pruning, because the result has the ends of the clips again.
    within : the largest number of frames between the first and the last point of a group.
    threshold : the largest RMS distance of a moved transition, metres, as for `graphs.build`.

    Returns
    -------
    A graph over the same clips, with a single transition between the same two points.

    Raises
    ------
    MocapError : for a threshold that is not above 0.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.build(clips, window=10, threshold=0.03)
    >>> len(merge_choice_points(graph, within=3, threshold=0.04).graph) < len(graph.graph)
    True

    Notebook: 08c-judging-a-search
    """
    check_threshold(threshold)
    if not threshold > 0:
        raise MocapError(f"The threshold must be above 0 m, got {threshold} m.")
    clips = motion_graph.clips
    window = motion_graph.window
    measured: dict[Ends, Transition] = {}
    for a, b, edge in motion_graph.graph.edges(data=True):
        if edge["kind"] == "transition":
            measured[a, b] = _transition(a, b, window, edge["cost"], edge["transform"])
    originals = list(measured)
    targets = _merge_targets(originals, within)
    while True:  # each iteration restores at least one choice point, or is the last
        merged = [(targets[a], targets[b]) for a, b in originals]
        unmeasured = [ends for ends in dict.fromkeys(merged) if ends not in measured]
        measured.update(_measure(clips, window, unmeasured))
        valid = {ends for ends, transition in measured.items() if transition.cost < threshold}
        pairs = zip(originals, merged, strict=True)
        rejected = [original for original, ends in pairs if original != ends and ends not in valid]
        if not rejected:
            return from_transitions(clips, [measured[ends] for ends in dict.fromkeys(merged)], window=window)
        for node in {max(ends, key=lambda node: abs(node[1] - targets[node][1])) for ends in rejected}:
            targets[node] = node


def _transition(a: Node, b: Node, window: int, cost: float, transform: PlanarTransform) -> Transition:
    """Return the transition between two nodes. Its second window ends at the second node."""
    source, leave = a
    target, end = b
    return Transition(source, leave, target, end - window, cost, transform)


def _merge_targets(transitions: Sequence[Ends], within: int) -> dict[Node, Node]:
    """Map each choice point to the last exit of its group, or to its first point if it has no exit."""
    exits = {leave for leave, _ in transitions}
    entries = {enter for _, enter in transitions}
    groups: list[list[Node]] = []
    for node in sorted(exits | entries):
        group = groups[-1] if groups else []
        is_near = bool(group) and _frames_between(group[0], node) <= within
        # With an exit after it, an entry would move to a later frame, and frames of the clip would be lost.
        moves_entry = node in exits and any(member in entries for member in group)
        if is_near and not moves_entry:
            group.append(node)
        else:
            groups.append([node])
    targets: dict[Node, Node] = {}
    for group in groups:
        target = max((node for node in group if node in exits), default=group[0])
        targets.update(dict.fromkeys(group, target))
    return targets


def _frames_between(first: Node, second: Node) -> float:
    """Return the number of frames from a node to a later one, infinite in another clip."""
    first_clip, first_frame = first
    second_clip, second_frame = second
    return second_frame - first_frame if first_clip == second_clip else np.inf


def _measure(clips: Sequence[Motion], window: int, ends: Sequence[Ends]) -> Iterator[tuple[Ends, Transition]]:
    """Align the windows between pairs of nodes, and yield the resulting transitions.

    Pairs whose windows overlap or extend beyond their clips are skipped.
    """
    ends = [(a, b) for a, b in ends if _has_windows(clips, window, a, b)]
    cloud = join_clouds(clips, None, window, 0, np.float64)
    starts = np.cumsum([0, *map(len, clips)])
    clip, frame = np.moveaxis(np.array(ends, np.intp).reshape(-1, 2, 2), -1, 0)  # (N, 2) each
    leave, enter = (starts[clip] + frame - [0, window]).T
    fits = fit(cloud, cloud, leave, enter).T.tolist()
    for (a, b), (cost, angle, x, z) in zip(ends, fits, strict=True):
        yield (a, b), _transition(a, b, window, cost, PlanarTransform(angle, x, z))


def _has_windows(clips: Sequence[Motion], window: int, a: Node, b: Node) -> bool:
    """Return whether the windows of a transition from a to b are inside their clips, and do not overlap."""
    source, leave = a
    target, end = b
    enter = end - window
    is_inside = leave + window <= len(clips[source]) and enter >= 0
    return is_inside and (source != target or abs(enter - leave) >= window)
