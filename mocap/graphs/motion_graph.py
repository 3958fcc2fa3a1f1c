"""Motion graphs: all ways through the clips that look like one motion, as a `networkx` graph [KGP02].

A node is a choice point (clip, frame): "the next frame is this one". An edge from it is either a stretch of
that clip up to its next choice point, or a transition: `window` blended frames that lead to another node. So
each edge plays some frames, and the frames of a walk are those of its edges in order.
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
from mocap.body.motion import Motion, require_compatible, require_motions
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
"""What may be meant by an attribute that a motion graph does not have."""


@dataclass(frozen=True, eq=False)
class MotionGraph:
    """A graph over clips; its edges refer to frames, the frames stay in the clips.

    Parameters
    ----------
    clips : the motions; the first number of a node is an index of this tuple.
    window : frames in a transition.
    graph : the `networkx.MultiDiGraph`. Nodes are pairs (clip, frame). Edges have `kind` ("clip" or
        "transition"), `frames`, and `labels`, a frozenset of all labels of the frames that they play or
        blend. Transitions also have `cost` (RMS distance, metres) and `transform`, which lays the clip they
        enter on the clip they leave.

    Examples
    --------
    A clip without transitions is one edge:

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
        """Frames per second, of all clips."""
        return self.clips[0].fps

    def count(self, kind: str) -> int:
        """Count the edges of a kind, "clip" or "transition"; raise `MocapError` for another kind."""
        if kind not in KINDS:
            raise MocapError(f"Edges are of the kinds 'clip' and 'transition', got {described(kind)}.")
        return sum(edge_kind == kind for _, _, edge_kind in self.graph.edges(data="kind"))


def require_graph(graph: object) -> MotionGraph:
    """Return a motion graph as it is; raise for anything else, with the call that makes one.

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
    """Build the motion graph of some clips: find the transitions, and cut the clips where they touch.

    In the paper: [KGP02, 3].

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, with different names.
    window : frames in a transition, about a third of a second.
    threshold : every transition has an RMS distance of the points below this, metres; or one threshold for
        each pair of labels, as for `matching.find_transitions`.
    joint_weights, taper, progress, executor, jobs : as for `matching.find_transitions`.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips of different skeletons or rates, two clips of one name, or clips
        shorter than the window. To join rates: `build([resample(clip, 30) for clip in clips], ...)`.

    Examples
    --------
    A lower threshold gives fewer transitions:

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
    """Build the motion graph with exactly these transitions.

    A transition leaves its first clip at the frame where its window starts, and enters the second at
    the frame after the window ends [KGP02, 3.3].

    Raises
    ------
    SkeletonMismatch, MocapError : for clips of different skeletons or rates, two clips of one name, and
        transitions outside the clips.

    Examples
    --------
    One transition from frame 60 back to frame 10; it enters after its window, at frame 20:

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
    """Cut clips where transitions leave and enter, and join the pieces; `from_transitions` calls this.

    Parameters
    ----------
    clips, transitions : as for `from_transitions`, but not checked.
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
    # Within a clip the nodes are in the order of time, therefore each is joined to its successor.
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
    """Merge the choice points of a clip that are within a few frames, where every old walk stays possible.

    Where two clips stay alike for a while, transitions leave from several frames in a row. Moved to one frame
    they cost a little more, but a walk meets all of them at once. A transition may leave its clip later than
    before, or enter the other earlier, never the reverse: so no frame of a clip is lost.
    The moved transitions are aligned and measured again. Where one would cost `threshold` or more, run over
    the end of its clip, or blend windows that overlap, the point that moved further goes back to its frame.

    Parameters
    ----------
    motion_graph : the graph before pruning, because the ends of the clips come back.
    within : the largest number of frames between the first and the last point of a group.
    threshold : moved transitions stay below this RMS distance, metres; as for `graphs.build`.

    Returns
    -------
    A graph over the same clips; transitions between the same two points become one.

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
    old = list(measured)
    goals = _goals(old, within)
    while True:  # each round sends at least one point back, or is the last
        new = [(goals[a], goals[b]) for a, b in old]
        fresh = [ends for ends in dict.fromkeys(new) if ends not in measured]
        measured.update(_measured(clips, window, fresh))
        fine = {ends for ends, transition in measured.items() if transition.cost < threshold}
        bad = [a for a, b in zip(old, new, strict=True) if a != b and b not in fine]
        if not bad:
            return from_transitions(clips, [measured[ends] for ends in dict.fromkeys(new)], window=window)
        for back in {max(ends, key=lambda node: abs(node[1] - goals[node][1])) for ends in bad}:
            goals[back] = back


def _transition(a: Node, b: Node, window: int, cost: float, transform: PlanarTransform) -> Transition:
    """Return the transition between two nodes; it enters its clip `window` frames before the second."""
    source, leave = a
    target, end = b
    return Transition(source, leave, target, end - window, cost, transform)


def _goals(transitions: Sequence[Ends], within: int) -> dict[Node, Node]:
    """Map each choice point to that of its group where the last transition leaves, else to the first one."""
    exits = {leave for leave, _ in transitions}
    entries = {enter for _, enter in transitions}
    groups: list[list[Node]] = []
    for node in sorted(exits | entries):
        last = groups[-1] if groups else [(-1, 0)]
        is_near = last[0][0] == node[0] and node[1] - last[0][1] <= within
        if is_near and not (node in exits and any(member in entries for member in last)):
            last.append(node)
        else:
            groups.append([node])
    goals: dict[Node, Node] = {}
    for group in groups:
        goal = max((node for node in group if node in exits), default=group[0])
        goals.update(dict.fromkeys(group, goal))
    return goals


def _measured(
    clips: Sequence[Motion], window: int, ends: Sequence[Ends]
) -> Iterator[tuple[Ends, Transition]]:
    """Align windows from node to node, where they lie inside their clips apart, and measure what remains."""
    ends = [(a, b) for a, b in ends if _has_windows(clips, window, a, b)]
    cloud = join_clouds(clips, None, window, 0, np.float64)
    starts = np.cumsum([0, *map(len, clips)])
    clip, frame = np.moveaxis(np.array(ends, np.intp).reshape(-1, 2, 2), -1, 0)  # (N, 2) each
    leave, enter = (starts[clip] + frame - [0, window]).T
    fits = fit(cloud, cloud, leave, enter).T.tolist()
    for (a, b), (cost, angle, x, z) in zip(ends, fits, strict=True):
        yield (a, b), _transition(a, b, window, cost, PlanarTransform(angle, x, z))


def _has_windows(clips: Sequence[Motion], window: int, a: Node, b: Node) -> bool:
    """Check that the windows of a transition from a to b are inside their clips, and do not overlap."""
    source, leave = a
    target, end = b
    enter = end - window
    is_inside = leave + window <= len(clips[source]) and enter >= 0
    return is_inside and (source != target or abs(enter - leave) >= window)
