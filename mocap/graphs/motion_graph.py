"""Motion graphs: every way through the clips that looks like one motion, as a `networkx` graph [KGP02].

A node is a choice point (clip, frame): "the next frame is this one". An edge from it is either a stretch of
that clip up to its next choice point, or a transition: `window` blended frames into another place. So each
edge gives the frames [start, end) of a motion, and the frames of a walk are those of its edges in order.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx

from mocap._shared.collector import uncollected
from mocap._shared.progress import Progress
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.graphs.components import Labels
from mocap.matching.transitions import Precision, Thresholds, Transition, find_transitions

Node = tuple[int, int]


@dataclass(frozen=True, eq=False)
class MotionGraph:
    """A graph over clips; it holds records, the frames stay in the clips.

    Parameters
    ----------
    clips : the motions, which the nodes' first numbers count.
    window : frames in a transition.
    graph : the `networkx.MultiDiGraph`. Nodes are pairs (clip, frame). Edges have `kind` ("clip" or
        "transition"), `frames`, and `labels`, a frozenset of all labels that some frame bears which they
        play or blend; transitions also `cost` (RMS distance, metres) and `transform`, which lays the clip
        they lead to on the one they come from.
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
        """Frames a second, of all clips."""
        return self.clips[0].fps

    def count(self, kind: str) -> int:
        """Count the edges of a kind, "clip" or "transition"."""
        return sum(edge_kind == kind for _, _, edge_kind in self.graph.edges(data="kind"))

    @property
    def frames(self) -> int:
        """Frames of the clips that the graph can play."""
        return sum(e["frames"] for _, _, e in self.graph.edges(data=True) if e["kind"] == "clip")


def build(  # noqa: PLR0913 (what to find, how exactly, and where to work)
    clips: Sequence[Motion],
    *,
    window: int,
    threshold: Thresholds,
    precision: Precision = "auto",
    progress: Progress = iter,
    executor: Executor | None = None,
) -> MotionGraph:
    """Build the motion graph of some clips: find the transitions, and cut the clips where they touch.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, with different names.
    window : frames in a transition, about a third of a second.
    threshold : the largest RMS distance of the points that a transition may bridge, metres; or one for each
        pair of labels, as for `find_transitions`.
    precision, progress, executor : how exactly the clips are compared, how that is shown, and where it is
        done, as for `find_transitions`.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips that do not go together, or are shorter than the window. Clips
        at different rates are not resampled unasked: `build([resample(clip, 30) for clip in clips], ...)`.

    Notebook: 00-quickstart
    """
    _require_names(clips)
    found = find_transitions(
        clips, window=window, below=threshold, precision=precision, progress=progress, executor=executor
    )
    return from_transitions(clips, found, window=window)


def labels_between(motion: Motion, start: int, end: int) -> Labels:
    """Collect the labels that the frames [start, end) bear.

    Notebook: 05-motion-graph
    """
    return frozenset(label for label, mark in motion.labels.items() if mark[start:end].any())


@uncollected()
def from_transitions(
    clips: Sequence[Motion], transitions: Sequence[Transition], *, window: int
) -> MotionGraph:
    """Build the motion graph with just these transitions.

    A transition leaves its first clip at the frame where its window starts, and enters the second at
    the frame after the window ends [KGP02, 3.3].

    Raises
    ------
    SkeletonMismatch, MocapError : for clips that do not go together, and transitions outside them.

    Notebook: 05-motion-graph
    """
    _require_names(clips)
    require_alike(clips)
    for transition in transitions:
        _require_inside(clips, transition, window)
    return MotionGraph(tuple(clips), window, cut_and_join(clips, transitions, window))


def cut_and_join(clips: Sequence[Motion], transitions: Sequence[Transition], window: int) -> nx.MultiDiGraph:
    """Cut clips where transitions leave and enter, and join the pieces: the heart of `from_transitions`.

    Parameters
    ----------
    clips, transitions : alike, and within the clips; nothing is checked here.
    window : frames in a transition.

    Returns
    -------
    The graph of a `MotionGraph`.

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


def _require_inside(clips: Sequence[Motion], t: Transition, window: int) -> None:
    for clip, start in ((t.source, t.leave), (t.target, t.enter)):
        if not (0 <= clip < len(clips) and 0 <= start <= len(clips[clip]) - window):
            raise MocapError(
                f"A transition of {window} frames from frame {start} of clip {clip} lies outside the clips."
            )


def _require_names(clips: Sequence[Motion]) -> None:
    names = [clip.name for clip in clips]
    if not names:
        raise MocapError("A motion graph needs at least one clip.")
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise MocapError(f"Clips need different names; given twice: {', '.join(twice)}.")
