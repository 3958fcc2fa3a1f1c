"""The size and the quality of a motion graph as a function of the threshold."""

from bisect import bisect_left
from collections.abc import Sequence

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
from mocap.graphs.tuned import TUNED
from mocap.matching.point_clouds import point_cloud
from mocap.matching.transitions import Transitions, find_transitions


def smallest_threshold(clips: Sequence[Motion], *, window: int) -> float:
    """Find the lowest threshold, in metres, at which the motion graph of clips has a cycle.

    Raises
    ------
    NoWalk : if no threshold gives a cycle.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> round(smallest_threshold([body.resample(datasets.sample("walk_curve_1"), 30)], window=10), 3)
    0.009
    """
    transitions = find_transitions(clips, window=window, below=float("inf"))
    transitions = transitions[np.argsort(transitions.cost, kind="stable")]

    def has_cycle(last: int) -> bool:
        graph = from_transitions(clips, transitions[: last + 1], window=window).graph
        return not nx.is_directed_acyclic_graph(graph)

    # Additional transitions never remove a cycle, therefore bisection finds the first that closes one.
    closing = bisect_left(range(len(transitions)), True, key=has_cycle)
    if closing == len(transitions):
        raise NoWalk(
            "No two windows of these clips join into a cycle: add clips with similar starts and ends."
        )
    return transitions[closing].cost


AT_ONCE = 4096  # transitions whose velocities are compared at a time, to limit the memory


class ThresholdCurve(NamedTuple):
    """Properties of the motion graph at T thresholds, shape (T,) each; `threshold_curve` shows an example.

    threshold : metres.
    transitions, nodes, edges : their numbers in the graph before pruning.
    frames : the number of frames of clips in the largest strongly connected component.
    cost : the mean cost of the transitions, metres; 0 without transitions.
    velocity_difference : the mean of their `velocity_differences`, metres per second, a measure of the
        visibility of the seams.
    """

    threshold: Array
    transitions: Indices
    nodes: Indices
    edges: Indices
    frames: Indices
    cost: Array
    velocity_difference: Array

    def suggest(self) -> float:
        """Return the lowest threshold at which the largest component has 90 % of its maximum of frames.

        Raises
        ------
        NoWalk : if the graph has no cycle at any threshold.
        """
        if self.frames.max(initial=0) == 0:
            raise NoWalk(
                "The graph has no cycle at any of these thresholds: allow transitions of higher cost."
            )
        return float(self.threshold[self.frames >= TUNED.largest_component * self.frames.max()].min())


def threshold_curve(
    clips: Sequence[Motion], transitions: Transitions, *, window: int, thresholds: ArrayLike
) -> ThresholdCurve:
    """Compute the size of the motion graph at many thresholds, before and after pruning.

    The transitions are found once and sorted by cost: all means are then cumulative sums. The remaining time
    is that of T prunings, linear in the number of edges.

    Parameters
    ----------
    clips : the motions.
    transitions : the transitions between them, found with the highest threshold of interest.
    window : frames in a transition.
    thresholds : shape (T,), metres.

    Returns
    -------
    The curve, whose method `suggest` chooses a threshold.

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
            raise MocapError("These transitions have windows outside the clips.")
    transitions = transitions[np.argsort(transitions.cost)]
    counts = np.searchsorted(transitions.cost, values)  # of the transitions below each threshold
    sizes = [_size(lengths, transitions[:count], window) for count in counts]
    nodes, frames = np.array(sizes, np.intp).reshape(-1, 2).T
    edges = counts + nodes - len(clips)  # a clip of n nodes has n - 1 stretches
    differences = velocity_differences(clips, transitions, window=window)
    sums = [np.cumsum([0.0, *column])[counts] for column in (transitions.cost, differences)]
    cost, velocity_difference = sums / np.maximum(counts, 1)
    return ThresholdCurve(values, counts, nodes, edges, frames, cost, velocity_difference)


def playable_fractions(clips: Sequence[Motion], *, window: int, thresholds: ArrayLike) -> Array:
    """Compute the fraction of the frames of clips that a pruned graph plays, at each of some thresholds.

    Parameters
    ----------
    clips : the motions.
    window : frames in a transition.
    thresholds : shape (T,), metres.

    Returns
    -------
    The frames in the largest strongly connected component, divided by all frames, shape (T,).

    Examples
    --------
    >>> from mocap import body, datasets
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> playable_fractions(clips, window=10, thresholds=[0.01, 0.04]).round(2)
    array([0.5 , 0.98])
    """
    values = np.asarray(thresholds, float)
    transitions = find_transitions(clips, window=window, below=float(values.max()))
    lengths = np.array([len(clip) for clip in clips])
    played = [_size(lengths, transitions[transitions.cost <= value], window)[1] for value in values]
    return np.asarray(np.array(played) / lengths.sum())


def _size(lengths: Indices, transitions: Transitions, window: int) -> tuple[int, int]:
    """Return the number of nodes of a graph, and of frames in its largest strongly connected component.

    A node is represented by a position in the concatenated clips.
    """
    clip_starts = np.cumsum(lengths + 1) - lengths - 1  # + 1 for the last node of a clip, after its frames
    clip_ends = clip_starts + lengths
    leave = clip_starts[transitions.source] + transitions.leave
    enter = clip_starts[transitions.target] + transitions.enter + window
    choice_points = np.concatenate([clip_ends, clip_starts, leave, enter])
    positions, number = np.unique(choice_points, return_inverse=True)
    # A stretch of clip leads from every node to the next one, except from the ends of clips.
    stretches = np.setdiff1d(np.arange(len(positions)), number[: len(lengths)])
    sources, targets = np.split(number[2 * len(lengths) :], 2)
    starts = np.concatenate([stretches, sources])
    ends = np.concatenate([stretches + 1, targets])
    frames = np.concatenate([np.diff(positions)[stretches], np.zeros_like(sources)])
    _, played = largest_component(np.stack([starts, ends], axis=1), frames, len(positions))
    return len(positions), played


def velocity_differences(clips: Sequence[Motion], transitions: Transitions, *, window: int) -> Array:
    """Compute the RMS difference between the point velocities of two clips, in the middle of each transition.

    Parameters
    ----------
    clips : the motions.
    transitions : N transitions between these clips.
    window : frames in a transition.

    Returns
    -------
    The RMS over the points of ‖v - T v'‖, shape (N,), metres per second.

    Examples
    --------
    The difference is 0 for a transition from a frame to itself:

    >>> from mocap import datasets
    >>> zero = np.zeros(1, int)
    >>> same = Transitions(zero, zero, zero, zero, np.zeros(1), PlanarTransform(zero, zero, zero))
    >>> velocity_differences([datasets.sample("walk_curve_1")], same, window=10)
    array([0.])

    Notebook: 05b-choice-points
    """
    point_velocities = np.concatenate(
        [velocities(point_cloud(clip), clip.fps) for clip in clips]
    )  # (F, P, 3)
    middles = np.cumsum([0, *(len(clip) for clip in clips)]) + window // 2
    differences = [np.zeros(0)]
    for first in range(0, len(transitions), AT_ONCE):
        batch = transitions[first : first + AT_ONCE]
        rotation = PlanarTransform(np.asarray(batch.transform.angle)[:, None], 0.0, 0.0)
        leaving = point_velocities[middles[batch.source] + batch.leave]
        entering = rotation.apply_points(point_velocities[middles[batch.target] + batch.enter])
        differences.append(np.sqrt(((leaving - entering) ** 2).sum(-1).mean(-1)))
    return np.concatenate(differences)
