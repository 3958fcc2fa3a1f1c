"""The homework's graph: segments of clips, connected if the end of one is similar to the start of another.

A node is a segment. An edge leads to a segment that may follow it. The default is correct where the
homework's program has a mistake, and the mistake is an option: `weighting="distance"` makes the worse match
more likely. Notebook 03b shows two more mistakes: Euler angles that flip, and segments that repeat the last
frame of their predecessor. The homework also translates segments vertically, by which a walk drifts in
height.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.blending.joining import blend
from mocap.blending.weights import sine_weights
from mocap.body.concatenation import concatenate, require_compatible
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, align_frames
from mocap.errors import MocapError, NoWalk
from mocap.matching.other_metrics import Metric, euler_grid
from mocap.matching.prepared_clouds import check_window

LEAST_COST = 1e-9  # in the unit of the metric: avoids 1 / 0 for equal windows


class Segment(NamedTuple):
    """Frames [start, end) of the clip with this number."""

    clip: int
    start: int
    end: int


def segments(clips: Sequence[Motion], length: int) -> list[Segment]:
    """Cut clips into segments of one length. The last segment of a clip also takes the remaining frames.

    Raises
    ------
    MocapError : for a length below 1.

    Examples
    --------
    >>> from mocap import datasets
    >>> [(part.start, part.end) for part in segments([datasets.sample("walk_circle")[:700]], 200)]
    [(0, 200), (200, 400), (400, 700)]

    Notebook: 05b-choice-points
    """
    parts = []
    for number, clip in enumerate(clips):
        check_window(length, max(len(clip), length), "A clip")
        starts = range(0, max(len(clip) - length, 0) + 1, length)
        parts += [Segment(number, *ends) for ends in pairwise([*starts, len(clip)])]
    return parts


def segment_distances(
    clips: Sequence[Motion], *, segment: int = 200, window: int = 50, metric: Metric = euler_grid
) -> NDArray[np.floating]:
    """Compute the homework's distance matrix, from the end of each segment to the start of each segment.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate, which `segments` cuts into S segments.
    segment : frames in a segment. The last one of a clip can be longer.
    window : frames that are compared, at the end of one segment and at the start of the other.
    metric : `euler_grid`, `root_grid` or `distance_grid` of `matching`.

    Returns
    -------
    Shape (S, S), in the metric's unit: [i, j] compares the end of segment i with the start of segment j.

    Raises
    ------
    MocapError : for no clips, different skeletons, and segments that are shorter than the window.

    Notebook: 05b-choice-points
    """
    clips = require_compatible(clips)
    for clip in clips:
        check_window(window, min(segment, len(clip)), f"A segment of '{clip.name}'")
    pieces = [clips[clip][start:end] for clip, start, end in segments(clips, segment)]
    tails = concatenate([piece[-window:] for piece in pieces])
    heads = concatenate([piece[:window] for piece in pieces])
    if metric is euler_grid:  # a sum over the window, for which corresponding frames suffice
        sums = [metric(tails[k::window], heads[k::window], window=1) for k in range(window)]
        return np.asarray(np.sum(sums, axis=0))
    return metric(tails, heads, window=window)[::window, ::window]


def segment_graph(  # noqa: PLR0913 - the homework's own five knobs, and the metric
    clips: Sequence[Motion],
    segment: int = 200,
    window: int = 50,
    threshold: float = 185,
    weighting: str = "inverse",
    *,
    metric: Metric = euler_grid,
) -> nx.DiGraph:
    """Build the homework's graph, with edges to the next segment and to similar segments of other clips.

    Parameters
    ----------
    clips : motions of one skeleton and one rate.
    segment : frames in a segment.
    window : frames that are compared, and blended in a walk.
    threshold : the distance, in the unit of the metric, below which a segment of another clip may follow.
    weighting : the successor in the clip has probability 1/2, and the matches share the rest: "inverse" in
        proportion to 1 / D, "distance" in proportion to D as in the homework.
    metric : the homework's program has `euler_grid`, its report `root_grid`; both are in `matching`.

    Returns
    -------
    A graph of nodes 0 … n-1 with `clip`, `start` and `end`. Edges have `kind` ("clip" for the successor,
    else "transition"), `probability` and, for a transition, `cost`, which is D. `graph.graph` has `window`.

    Raises
    ------
    MocapError, SkeletonMismatch : for clips of different skeletons or rates, clips that are too short, and
        settings out of range.

    Notebook: 05b-choice-points
    """
    if weighting not in ("inverse", "distance"):
        raise MocapError(f"There are the weightings 'inverse' and 'distance', not '{weighting}'.")
    if not threshold > 0:
        raise MocapError(f"The threshold must be above 0, got {threshold}.")
    for clip in clips:  # a segment has a window at each end
        length = min(segment, len(clip))
        if length <= 2 * window:
            short = f"a segment of {length} frames is too short for windows of {window}"
            raise MocapError(f"'{clip.name}': {short} at both its ends.")
    distances = segment_distances(clips, segment=segment, window=window, metric=metric)
    graph = connect(segments(clips, segment), distances, threshold, weighting)
    graph.graph["window"] = window
    return graph


def connect(
    parts: Sequence[Segment], distances: NDArray[np.floating], threshold: float, weighting: str
) -> nx.DiGraph:
    """Connect each segment with its successor in the clip, and with similar segments of other clips.

    Parameters
    ----------
    parts : the segments of all clips, in order.
    distances : D, shape (S, S), from `segment_distances`.
    threshold, weighting : as for `segment_graph`.

    Examples
    --------
    >>> parts = [Segment(0, 0, 200), Segment(0, 200, 400), Segment(1, 0, 200)]
    >>> distances = np.array([[9.0, 9, 100], [9, 9, 300], [100, 300, 9]])
    >>> list(connect(parts, distances, 185, "inverse").edges(data="kind"))
    [(0, 1, 'clip'), (0, 2, 'transition'), (2, 0, 'transition')]

    Notebook: 05b-choice-points
    """
    graph = nx.DiGraph()
    graph.add_nodes_from((node, part._asdict()) for node, part in enumerate(parts))
    clip_of = np.array([part.clip for part in parts])
    for node, part in enumerate(parts):
        matches = np.flatnonzero((clip_of != part.clip) & (distances[node] < threshold)).tolist()
        probability = 1.0  # of all matches together
        if node + 1 < len(parts) and parts[node + 1].clip == part.clip:
            graph.add_edge(node, node + 1, kind="clip", probability=0.5 if matches else 1.0)
            probability = 0.5
        costs = distances[node, matches]
        fractions = probability * split_probability(costs, weighting)
        for match, cost, fraction in zip(matches, costs, fractions, strict=True):
            graph.add_edge(node, match, kind="transition", probability=float(fraction), cost=float(cost))
    return graph


def split_probability(costs: NDArray[np.floating], weighting: str) -> Array:
    """Divide the probability 1 among matches, in proportion to D or to 1 / D.

    Parameters
    ----------
    costs : D of each, shape (N,).
    weighting : "distance" or "inverse".

    Examples
    --------
    >>> split_probability(np.array([100.0, 300.0]), "inverse")
    array([0.75, 0.25])
    >>> split_probability(np.array([100.0, 300.0]), "distance")
    array([0.25, 0.75])

    Notebook: 05b-choice-points
    """
    exponent = 1.0 if weighting == "distance" else -1.0
    odds = np.maximum(costs, LEAST_COST) ** exponent
    return np.asarray(odds / odds.sum())


def segment_walk(graph: nx.DiGraph, count: int, *, seed: int = 0, start: int | None = None) -> list[int]:
    """Draw a random walk over segments, with the probabilities of the edges.

    Parameters
    ----------
    graph : from `segment_graph`.
    count : the number of segments.
    seed : seed of the random numbers. The same seed gives the same walk.
    start : the first segment, by default a random one.

    Raises
    ------
    NoWalk : for a start that is not in the graph, and if the walk reaches a segment without successor.

    Notebook: 05b-choice-points
    """
    if count < 1:
        raise MocapError(f"A walk needs at least one segment, got {count}.")
    random = np.random.default_rng(seed)
    walk = [int(random.integers(len(graph))) if start is None else start]
    if walk[0] not in graph:
        raise NoWalk(f"The graph has no segment {walk[0]}.")
    while len(walk) < count:
        successors = graph[walk[-1]]
        if not successors:
            raise NoWalk(
                f"Nothing follows segment {walk[-1]}, which the walk reaches after {len(walk)} segments."
            )
        probabilities = [edge["probability"] for edge in successors.values()]
        walk.append(int(random.choice(list(successors), p=probabilities)))
    return walk


def segment_motion(clips: Sequence[Motion], graph: nx.DiGraph, walk: Sequence[int]) -> Motion:
    """Convert a walk to motion: concatenate its segments, with blends at transitions.

    A segment that follows in the clip is not changed. A segment after a transition is aligned: its first
    frame gets the heading and the position of the frame `window` frames before the end of the motion so far.
    Over the window the poses are blended by `sine_weights`.

    Parameters
    ----------
    clips : the clips of the graph.
    graph : from `segment_graph`.
    walk : segments, each with an edge to the next.

    Returns
    -------
    The frames of all segments, minus one window per transition.

    Raises
    ------
    NoWalk : for an empty walk, or one that takes an edge that is not in the graph.

    Examples
    --------
    >>> from mocap import datasets
    >>> clip = datasets.sample("walk_circle")[:400]
    >>> graph = segment_graph([clip], segment=200)
    >>> len(segment_motion([clip], graph, segment_walk(graph, 2, start=0)))
    400

    Notebook: 05b-choice-points
    """
    if not walk or walk[0] not in graph:
        raise NoWalk(f"The walk starts at no segment of the graph: {list(walk[:1])}.")
    for source, target in pairwise(walk):
        if not graph.has_edge(source, target):
            raise NoWalk(f"The walk jumps from segment {source} to segment {target}.")
    window = graph.graph["window"]
    parts = [Segment(**graph.nodes[node]) for node in walk]
    segment, *successors = [clips[part.clip][part.start : part.end] for part in parts]
    pieces = [segment]
    transform = IDENTITY
    for edge, segment in zip(pairwise(walk), successors, strict=True):
        if graph.edges[edge]["kind"] == "clip":
            pieces.append(segment if transform is IDENTITY else transform.apply_motion(segment))
            continue
        tail = pieces[-1][-window:]
        transform = align_frames(segment, tail)
        aligned = transform.apply_motion(segment)
        mixed = blend(tail, aligned[:window], sine_weights(window))
        pieces[-1:] = [pieces[-1][:-window], mixed, aligned[window:]]
    return replace(concatenate(pieces), name="walk")
