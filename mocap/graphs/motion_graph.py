"""Motion graphs: all ways through the clips that look like one motion, as a `networkx` graph [KGP02].

A node is a choice point (clip, frame): "the next frame is this one". An edge from it is either a stretch of
that clip up to its next choice point, or a transition: `window` blended frames that lead to another node. So
each edge plays some frames, and the frames of a walk are those of its edges in order.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Unpack

import networkx as nx

from mocap._shared.collector import uncollected
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.graphs.components import Labels
from mocap.matching.transitions import Search, Thresholds, Transition, find_transitions

Node = tuple[int, int]


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
    >>> alone.count("clip"), alone.count("transition"), alone.frames == len(alone.clips[0])
    (1, 0, True)
    """

    clips: tuple[Motion, ...]
    window: int
    graph: nx.MultiDiGraph

    def __repr__(self) -> str:
        return (
            f"MotionGraph({len(self.clips)} clips, {self.graph.number_of_nodes()} nodes, "
            f"{self.graph.number_of_edges()} edges, {self.count('transition')} of them transitions)"
        )

    @property
    def fps(self) -> float:
        """Frames per second, of all clips."""
        return self.clips[0].fps

    def count(self, kind: str) -> int:
        """Count the edges of a kind, "clip" or "transition"."""
        return sum(edge_kind == kind for _, _, edge_kind in self.graph.edges(data="kind"))

    @property
    def frames(self) -> int:
        """The number of clip frames that the graph can play."""
        return sum(e["frames"] for _, _, e in self.graph.edges(data=True) if e["kind"] == "clip")


def build(
    clips: Sequence[Motion], *, window: int, threshold: Thresholds, **search: Unpack[Search]
) -> MotionGraph:
    """Build the motion graph of some clips: find the transitions, and cut the clips where they touch.

    In the paper: [KGP02, 3].

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, with different names.
    window : frames in a transition, about a third of a second.
    threshold : every transition has an RMS distance of the points below this, metres; or one threshold for
        each pair of labels, as for `matching.find_transitions`.
    **search : joint_weights, method, progress and executor, as for
        `matching.find_transitions`.

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
    found = find_transitions(clips, window=window, below=threshold, **search)
    return from_transitions(clips, found, window=window)


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
    clips = require_alike(clips)
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
        leave, enter = (t.source, t.leave), (t.target, t.enter + window)
        here = labels_between(clips[t.source], t.leave, t.leave + window)
        there = labels_between(clips[t.target], t.enter, t.enter + window)
        edge = {"kind": "transition", "frames": window, "labels": here | there}
        graph.add_edge(leave, enter, **edge, cost=t.cost, transform=t.transform)
    # Within a clip the nodes stand in the order of time, so each is joined to the one after it.
    for (clip, start), (same, end) in pairwise(sorted(graph)):
        if clip == same:
            labels = labels_between(clips[clip], start, end)
            graph.add_edge((clip, start), (clip, end), kind="clip", frames=end - start, labels=labels)
    return graph


def _require_names(clips: Sequence[Motion]) -> None:
    names = [clip.name for clip in clips]
    if not names:
        raise MocapError("A motion graph needs at least one clip.")
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise MocapError(f"Clips need different names; given twice: {', '.join(twice)}.")
