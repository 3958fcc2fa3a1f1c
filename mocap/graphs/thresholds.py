"""Which threshold? The size and quality of the motion graph at many of them, from one list of transitions."""

from bisect import bisect_left
from collections.abc import Sequence
from functools import partial

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import velocities
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.graphs.components import largest_component
from mocap.graphs.motion_graph import from_transitions
from mocap.matching.point_clouds import point_cloud
from mocap.matching.transitions import Transitions, find_transitions


def smallest_threshold(clips: Sequence[Motion], *, window: int) -> float:
    """Find the lowest threshold, in metres, at which the motion graph of some clips has a cycle.

    Raises
    ------
    NoWalk : where no threshold gives a cycle.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> bool(smallest_threshold([body.resample(datasets.sample("walk_curve_1"), 30)], window=10) < 0.04)
    True
    """
    found = find_transitions(clips, window=window, below=float("inf"))
    found = found[np.argsort(found.cost, kind="stable")]
    made = partial(from_transitions, clips, window=window)
    first = bisect_left(  # a cycle stays one with more transitions
        range(len(found)), True, key=lambda n: not nx.is_directed_acyclic_graph(made(found[: n + 1]).graph)
    )
    if first == len(found):
        raise NoWalk("No two windows of these clips join into a cycle: add clips that start and end alike.")
    return found[first].cost


AT_ONCE = 4096  # transitions measured together, to limit the memory


class ThresholdCurve(NamedTuple):
    """The motion graph at each of T thresholds, shape (T,) each; `threshold_curve` shows an example.

    threshold : metres.
    transitions, nodes, edges : the numbers of these in the whole graph.
    frames : frames of the clips that the largest strongly connected component can play.
    cost : the mean cost of the transitions, metres; 0 without transitions.
    gap : the mean of their `velocity_gaps`, metres per second: how visible the seams are.
    """

    threshold: Array
    transitions: Indices
    nodes: Indices
    edges: Indices
    frames: Indices
    cost: Array
    gap: Array

    def suggest(self) -> float:
        """Give the lowest threshold at which the largest component plays 90 % of the most that it plays.

        Raises
        ------
        NoWalk : where the graph has no cycle at any threshold.
        """
        if self.frames.max(initial=0) == 0:
            raise NoWalk("At none of these thresholds has the graph a cycle: allow costlier transitions.")
        return float(self.threshold[self.frames >= 0.9 * self.frames.max()].min())


def threshold_curve(
    clips: Sequence[Motion], transitions: Transitions, *, window: int, thresholds: ArrayLike
) -> ThresholdCurve:
    """Compute for many thresholds how large the motion graph is, and how much of it pruning keeps.

    The transitions are sorted by cost once. Those below a threshold come first, so all means are running
    sums. Components take time linear in the edges. So a curve takes as long as T prunings, without a search.

    Parameters
    ----------
    clips : the motions.
    transitions : found between them with the loosest threshold of interest.
    window : frames in a transition.
    thresholds : shape (T,), metres.

    Returns
    -------
    The curve, which can suggest a threshold.

    Raises
    ------
    MocapError : for transitions outside the clips, and thresholds that are not numbers.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> from mocap.body.planar import PlanarTransform
    >>> still = Motion(Skeleton(["root"], [-1], [[0, 0, 0]]), np.zeros((90, 3)), [[[1, 0, 0, 0]]] * 90, 30.0)
    >>> there, back, zero = np.array([20, 60]), np.array([60, 20]), np.zeros(2, int)
    >>> two = Transitions(zero, there, zero, back, np.array([0.01, 0.03]), PlanarTransform(zero, zero, zero))
    >>> curve = threshold_curve([still], two, window=10, thresholds=[0.02, 0.04])
    >>> curve.transitions.tolist(), curve.nodes.tolist(), curve.frames.tolist()
    ([1, 2], [4, 6], [0, 30])

    Notebook: 05b-choice-points
    """
    values = np.array(thresholds, float).ravel()
    if np.isnan(values).any():
        raise MocapError(f"Thresholds must be numbers, got {values.tolist()}.")
    lengths = np.array([len(clip) for clip in clips])
    for clip, frame in ((transitions.source, transitions.leave), (transitions.target, transitions.enter)):
        if np.any(clip >= len(clips)) or np.any(frame + window > lengths[clip]):
            raise MocapError("These transitions have windows that lie outside the clips.")
    transitions = transitions[np.argsort(transitions.cost)]
    counts = np.searchsorted(transitions.cost, values)  # how many are below each
    sizes = [_size(lengths, transitions[:count], window) for count in counts]
    nodes, frames = np.array(sizes, np.intp).reshape(-1, 2).T
    edges = counts + nodes - len(clips)  # a clip of n nodes has n - 1 stretches
    gaps = velocity_gaps(clips, transitions, window=window)
    sums = [np.cumsum([0.0, *column])[counts] for column in (transitions.cost, gaps)]
    cost, gap = sums / np.maximum(counts, 1)
    return ThresholdCurve(values, counts, nodes, edges, frames, cost, gap)


def _size(lengths: Indices, transitions: Transitions, window: int) -> tuple[int, int]:
    """Count the nodes of a graph, and the frames that its largest strongly connected component plays."""
    starts = np.cumsum(lengths + 1) - lengths - 1  # one more each: a clip's last node comes after its frames
    leave = starts[transitions.source] + transitions.leave
    enter = starts[transitions.target] + transitions.enter + window
    places, number = np.unique(np.concatenate([starts + lengths, starts, leave, enter]), return_inverse=True)
    # A stretch of clip leaves every node but the ends of clips.
    before = np.setdiff1d(np.arange(len(places)), number[: len(lengths)])
    left, entered = np.split(number[2 * len(lengths) :], 2)
    ways = np.stack([np.concatenate([before, left]), np.concatenate([before + 1, entered])], axis=1)
    frames = np.concatenate([np.diff(places)[before], np.zeros_like(left)])
    return len(places), largest_component(ways, frames, len(places))[1]


def velocity_gaps(clips: Sequence[Motion], transitions: Transitions, *, window: int) -> Array:
    """Measure the difference of the points' velocities in the two clips, in the middle of each transition.

    Parameters
    ----------
    clips : the motions.
    transitions : N of them, between these clips.
    window : frames in a transition.

    Returns
    -------
    The RMS over the points of ‖v - T v'‖, shape (N,), metres per second.

    Examples
    --------
    A transition from a frame to itself has no gap:

    >>> from mocap import datasets
    >>> zero = np.zeros(1, int)
    >>> same = Transitions(zero, zero, zero, zero, np.zeros(1), PlanarTransform(zero, zero, zero))
    >>> velocity_gaps([datasets.sample("walk_curve_1")], same, window=10)
    array([0.])

    Notebook: 05b-choice-points
    """
    moving = np.concatenate([velocities(point_cloud(clip), clip.fps) for clip in clips])  # (frames, P, 3)
    middles = np.cumsum([0, *(len(clip) for clip in clips)]) + window // 2
    gaps = [np.zeros(0)]
    for first in range(0, len(transitions), AT_ONCE):
        some = transitions[first : first + AT_ONCE]
        turn = PlanarTransform(np.asarray(some.transform.angle)[:, None], 0.0, 0.0)
        here, there = moving[middles[some.source] + some.leave], moving[middles[some.target] + some.enter]
        gaps.append(np.sqrt(((here - turn.apply_points(there)) ** 2).sum(-1).mean(-1)))
    return np.concatenate(gaps)
