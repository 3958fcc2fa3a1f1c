"""Which two windows are looked at, and what lies around them: of two clips, of a graph, of a walk."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from operator import index
from typing import Any, NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.blending.joining import join
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.course.lab.adopting import slots, whose
from mocap.course.lab.own import pages_of
from mocap.course.lab.program import module
from mocap.errors import MocapError
from mocap.graphs.edge_tables import Edge, edge_table
from mocap.graphs.motion_graph import MotionGraph
from mocap.matching.distance_grids import distance_grid
from mocap.matching.minima import local_minima
from mocap.matching.point_clouds import align, point_cloud
from mocap.plotting.graph_drawing import cheapest
from mocap.synthesis.walk_to_motion import seams

SECONDS = 0.7  # of clip that are shown before and after a window
CELLS = 20  # of a distance grid on each side of a transition, which a page measures itself
EACH = 4  # transitions of a graph that can be pointed at: the cheapest from each clip to each clip
MOST = 100  # transitions of a graph that can be pointed at
MINIMA = 40  # of a grid that are marked: the lowest
LONGEST = 6_000  # frames that a page holds; with more it would be slow to open


class Pick(NamedTuple):
    """Two windows: from frame `i` of clip `first`, and from frame `j` of clip `second`.

    margin_before, margin_after : frames of clip to show around the window.
    number : which transition of a graph; -1 for a cell of a grid.
    seam, frame : which seam of a walk, and the walk's frame at which its window starts; -1 without a walk.
    """

    first: int
    i: int
    second: int
    j: int
    margin_before: int
    margin_after: int
    number: int = -1
    seam: int = -1
    frame: int = -1


class Choices(NamedTuple):
    """All that can be pointed at, and what is looked at first."""

    clips: tuple[Motion, ...]
    window: int
    pick: Pick
    grid: Array | None = None  # D of all pairs, m²
    minima: tuple[tuple[int, int], ...] = ()  # the lowest first
    graph: MotionGraph | None = None
    transitions: tuple[Pick, ...] = ()
    costs: tuple[float, ...] = ()  # metres
    seams: tuple[Pick, ...] = ()
    by: str = ""  # whose functions made the grid, where some are the reader's

    @property
    def windows(self) -> tuple[Motion, Motion]:
        """The two windows that are looked at, where they are in their clips."""
        pick = self.pick
        first = self.clips[pick.first]
        second = self.clips[pick.second]
        first_window = first[pick.i : pick.i + self.window]
        return first_window, second[pick.j : pick.j + self.window]

    @property
    def fit(self) -> PlanarTransform:
        """Lays the second window on the first [KGP02, Eqs. 2-4]."""
        return align(*(point_cloud(motion).reshape(-1, 3) for motion in self.windows))

    @property
    def pair(self) -> tuple[Motion, Motion]:
        """The two windows, the second laid on the first."""
        first, second = self.windows
        return first, self.fit.apply_motion(second)

    @property
    def seam(self) -> tuple[Motion, int]:
        """Their blend by the paper's weights, with clip around it, and where in it the window begins."""
        pick = self.pick
        first = self.clips[pick.first]
        second = self.clips[pick.second]
        joined = join(first, pick.i, second, pick.j, self.window)
        begin = min(pick.margin_before, pick.i)
        return joined[pick.i - begin : pick.i + self.window + pick.margin_after], begin

    def needed(self, clip: int) -> Mask:
        """Mark the frames of a clip that a page may show: of a graph, those near its transitions."""
        frames = np.full(len(self.clips[clip]), self.grid is not None)
        fps = self.clips[clip].fps
        margin = CELLS * max(1, round(fps / 30)) + margin_frames(fps)
        for pick in self.transitions:
            for number, start in ((pick.first, pick.i), (pick.second, pick.j)):
                if number == clip:
                    frames[max(0, start - margin) : start + self.window + margin] = True
        return frames


def margin_frames(fps: float) -> int:
    """Count the frames to show before and after a window.

    Examples
    --------
    >>> margin_frames(30.0)
    21
    """
    return round(SECONDS * fps)


# reads: name: `inspector` and its notebooks use `at`
def of_clips(clips: Sequence[Motion], window: int, at: Any) -> Choices:  # noqa: ANN401 (a reader's value)
    """Choose two windows of two clips, by default those of the lowest local minimum.

    The reader's `window_sums` and `inner_minima` make the grid and its minima, if they passed their checks.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips that do not go together, have more than 6000 frames together or
        fewer than a window, and windows that run off them.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")[:90]
    >>> of_clips([walk, walk], 40, (10, 20)).pick[:4]
    (0, 10, 1, 20)
    """
    clips = require_compatible(clips)
    first = clips[0]
    second = clips[-1]
    _require_short(len(first) + len(second))
    names = ("window_sums", "inner_minima")
    sums, inner = slots(*names)
    if sums.yours and window <= min(map(len, clips)):
        a, b = map(pages_of(None, window).windows, (first, second))
        grid = module({"window_sums": sums}, {"K": window}).distance_grid(a, b) ** 2
    else:
        grid = np.asarray(distance_grid(first, second, window=window), float)
    places = np.array(list(inner(grid, np.inf)) if inner.yours else [], int).reshape(-1, 2)
    places = places if len(places) else local_minima(grid)
    lowest = places[np.argsort(grid[*places.T], kind="stable")][:MINIMA]
    minima = tuple((int(i), int(j)) for i, j in lowest)
    try:
        i, j = minima[0] if at is None else map(index, at)
    except (TypeError, ValueError):
        raise MocapError(f"Windows are chosen by their first frames, at=(i, j), not by {at!r:.80}.") from None
    rows, columns = grid.shape
    if not (0 <= i < rows and 0 <= j < columns):
        raise MocapError(f"Windows start at frames 0 to {rows - 1} and 0 to {columns - 1}, not {i} and {j}.")
    frames = margin_frames(first.fps)
    by = whose(*names) if sums.yours or inner.yours else ""
    return Choices((first, second), window, Pick(0, i, 1, j, frames, frames), grid, minima, by=by)


def _require_short(frames: int) -> None:
    """Raise for more frames than a page holds."""
    if frames > LONGEST:
        raise MocapError(f"The inspector holds {LONGEST} frames of clips, not {frames}: give shorter pieces.")


def of_graph(graph: MotionGraph) -> Choices:
    """Choose the transition of a graph that costs least.

    Raises
    ------
    MocapError : for a graph without transitions.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> of_graph(graphs.from_transitions([clip], [back], window=10)).pick[:4]
    (0, 60, 0, 10)
    """
    edges = [edge for edge in graph.graph.edges(keys=True) if graph.graph.edges[edge]["kind"] == "transition"]
    if not edges:
        raise MocapError("This graph has no transitions to inspect.")
    pairs = np.array([(start[0], end[0]) for start, end, _ in edges])
    costs = np.array([graph.graph.edges[edge]["cost"] for edge in edges])
    offered = [edges[number] for number in islice(cheapest(pairs, costs, EACH), MOST)]
    return _offered(graph, offered, offered[0])


def _offered(graph: MotionGraph, shown: Sequence[Edge], chosen: Edge) -> Choices:
    """Offer these transitions of a graph; one enters its clip at the frame after its window."""
    frames = margin_frames(graph.fps)
    picks: tuple[Pick, ...] = ()
    for number, ((source, leave), (target, enter), _) in enumerate(shown):
        picks += (Pick(source, leave, target, enter - graph.window, frames, frames, number),)
    costs = tuple(float(graph.graph.edges[edge]["cost"]) for edge in shown)
    pick = picks[shown.index(chosen)]
    choices = Choices(graph.clips, graph.window, pick, graph=graph, transitions=picks, costs=costs)
    _require_short(sum(int(choices.needed(clip).sum()) for clip in range(len(graph.clips))))
    return choices


def of_walk(graph: MotionGraph, walk: Sequence[Edge]) -> Choices:
    """Choose the seam of a walk that costs most.

    Raises
    ------
    NoWalk, MocapError : for a walk that the graph does not have, and one without seams.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> of_walk(graph, [((0, 20), (0, 60), 0), ((0, 60), (0, 20), 0)]).pick
    Pick(first=0, i=60, second=0, j=10, margin_before=21, margin_after=0, number=0, seam=0, frame=40)
    """
    seams_of_walk = seams(graph, walk)
    if not seams_of_walk:
        raise MocapError("This walk takes no transition, so it has no seam to inspect.")
    transitions = [edge for edge in walk if graph.graph.edges[edge]["kind"] == "transition"]
    edges = list(dict.fromkeys(transitions))
    costliest = int(np.argmax([seam.cost for seam in seams_of_walk]))
    whole = _offered(graph, edges, transitions[costliest])
    starts = [seam.frame for seam in seams_of_walk]
    bounds = [-graph.window, *starts, int(edge_table(graph, walk).frames.sum())]
    longest = margin_frames(graph.fps)
    gaps = [min(longest, int(gap)) for gap in np.diff(bounds) - graph.window]  # of clip around the seams
    picks = []
    for n, (edge, start) in enumerate(zip(transitions, starts, strict=True)):
        pick = whole.transitions[edges.index(edge)]
        picks.append(pick._replace(seam=n, frame=start, margin_before=gaps[n], margin_after=gaps[n + 1]))
    return whole._replace(pick=picks[costliest], seams=tuple(picks))
