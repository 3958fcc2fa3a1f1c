"""Transitions between clips: the local minima of the distance grids of all pairs of clips."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap._shared.quantities import check_threshold
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError
from mocap.matching.minima import find_minima
from mocap.matching.point_clouds import distinct_joints, point_cloud, require_near, unit_weights
from mocap.matching.prepared_clouds import Cloud, cloud, join, require_windows
from mocap.matching.tuned import TUNED

Integers = NDArray[np.integer[Any]]
Thresholds = float | Mapping[tuple[str, str], float]
"""One threshold in metres, or one for each pair of labels."""


class Transition(NamedTuple):
    """A transition from one clip to another: two windows that are similar enough to be blended.

    The window of clip `source` starts at frame `leave`, that of clip `target` at frame `enter`. `transform`
    aligns the second with the first, and `cost` is the remaining RMS distance of the points, in metres.
    """

    source: int
    leave: int
    target: int
    enter: int
    cost: float
    transform: PlanarTransform


@dataclass(frozen=True, eq=False, repr=False)
class Transitions(Sequence[Transition]):
    """A sequence of `Transition` records, stored as one array of shape (N,) per field.

    An index returns a record. A slice, a mask or an array of indices returns Transitions.

    Examples
    --------
    >>> count, zeros = np.arange(3), np.zeros(3)
    >>> three = Transitions(count, count, count, count, count / 100, PlanarTransform(zeros, zeros, zeros))
    >>> three[three.cost < 0.015]
    Transitions(2, from 0.0 to 1.0 cm)
    >>> [t.leave for t in three], three[2].cost
    ([0, 1, 2], 0.02)
    """

    source: Integers
    leave: Integers
    target: Integers
    enter: Integers
    cost: Array
    transform: PlanarTransform

    def __len__(self) -> int:
        return len(self.cost)

    def __repr__(self) -> str:
        costs = f", from {100 * self.cost.min():.1f} to {100 * self.cost.max():.1f} cm" if len(self) else ""
        return f"Transitions({len(self)}{costs})"

    @property
    def columns(self) -> tuple[NDArray[Any], ...]:
        """The eight arrays: source, leave, target, enter, cost, and the transform's angle, x and z."""
        angle, x, z = (np.asarray(field) for field in self.transform)
        return (self.source, self.leave, self.target, self.enter, self.cost, angle, x, z)

    @overload
    def __getitem__(self, index: int) -> Transition: ...
    @overload
    def __getitem__(self, index: slice | NDArray[Any]) -> Transitions: ...
    def __getitem__(self, index: int | slice | NDArray[Any]) -> Transition | Transitions:
        if isinstance(index, int | np.integer):
            return next(iter(self[np.array([index])]))
        source, leave, target, enter, cost, *transform = (column[index] for column in self.columns)
        return Transitions(source, leave, target, enter, cost, PlanarTransform(*transform))

    def __iter__(self) -> Iterator[Transition]:
        rows = zip(*(column.tolist() for column in self.columns), strict=True)
        for source, leave, target, enter, cost, *transform in rows:
            yield Transition(source, leave, target, enter, cost, PlanarTransform(*transform))


def find_transitions(  # noqa: PLR0913 (clips, a window, thresholds, weights, and workers)
    clips: Sequence[Motion],
    *,
    window: int,
    below: Thresholds,
    joint_weights: ArrayLike | None = None,
    taper: ArrayLike | None = None,
    progress: Progress = iter,
    executor: Executor | None = None,
    jobs: int | None = None,
) -> Transitions:
    """Find the transitions between clips: the local minima of the distance grids of all pairs of clips.

    In the paper: [KGP02, thresholds].

    The grids are never stored as a whole: memory grows linearly with the number of frames and of transitions.
    The distance of two windows is computed once, for the transitions in both directions.

    The faster of two searches is chosen. For up to 5 000 windows, or if a sample indicates that more than one
    pair in twenty may be below the threshold, all distances are computed, in quadratic time. Otherwise a
    lower bound of the distance rules out most pairs: for clips with different kinds of motion, twice the
    number of frames takes 3.4 times the time (exponent 1.75). Both searches find the same minima.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window : frames in a window, about a third of a second.
    below : the largest RMS distance of the points, metres. Or one for each pair of labels, as {("walk",
        "run"): 0.05, ...}, for transitions from windows with the first label to windows with the second, and
        for the opposite direction unless that pair is named itself. If several pairs apply, the lowest
        threshold is used. If none applies, there is no transition.
    joint_weights, taper : weights of the points and of the frames in a window, as for `distance_grid`.
    progress : wraps the iterable of pairs of blocks, to show a progress bar.
    executor : a pool of processes, or a cluster by `dask.distributed`'s `Client.get_executor()`; by default,
        threads of this process are used.
    jobs : the number of threads without an executor, by default one for each core that the process may use.
        On machines of one kind, the result is bit-identical for any number of threads and any executor.

    Returns
    -------
    Transitions in both directions between all pairs of clips, also within a clip, ordered by clip and frame.
    Costs are accurate to a micrometre. Overlapping windows of one clip are excluded, because they would lead
    from a moment to itself. For more than 20 000 frames in all clips, distances are computed in 32 bits, up
    to twice as fast. In a flat valley of the grid, a minimum may then be displaced by a few frames, or found
    twice: for CMU subject 16, 1 in 2000 minima at 30 frames per second, and 7 in 1000 at 120. The two
    searches may also differ in such minima: in 20 of 4 900 minima for 77 606 frames.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window,
        coordinates above 1000 km, thresholds that are not above 0, labels that no clip has, weights that are
        negative, all 0 or of the wrong shape, and jobs that are not at least 1.

    Examples
    --------
    One point rises and another one sinks. Their middle frames are 1 cm apart:

    >>> from mocap.body.skeleton import Skeleton
    >>> dot, rotations = Skeleton(["root"], [-1], [[0, 0, 0]]), np.tile([1.0, 0, 0, 0], (3, 1, 1))
    >>> rise = Motion(dot, [[0, 1.0, 0], [0, 1.3, 0], [0, 1.6, 0]], rotations, 30.0)
    >>> sink = Motion(dot, [[0, 2.0, 0], [0, 1.31, 0], [0, 0.5, 0]], rotations, 30.0)
    >>> transitions = find_transitions([rise, sink], window=1, below=0.05)
    >>> [(t.source, t.leave, t.target, t.enter, round(t.cost, 6)) for t in transitions]
    [(0, 1, 1, 1, 0.01), (1, 1, 0, 1, 0.01)]

    Notebook: 05b-choice-points
    """
    clips = require_windows(clips, window)
    check_threshold(below)
    thresholds = _thresholds(below, clips)
    gap = int(window == 1)  # longer windows need no gap: those that extend beyond a clip separate the clips
    is_small = sum(map(len, clips)) <= TUNED.few_frames
    dtype = np.float64 if is_small else np.float32
    ready = join_clouds(clips, joint_weights, window, gap, dtype, taper=taper)
    loosest = max(thresholds.values())
    minima = find_minima(ready, loosest, progress=progress, executor=executor, jobs=jobs)
    transitions = _both_ways(minima, clips, gap)
    return transitions[transitions.cost < _limits(thresholds, clips, window, transitions)]


LabelPair = tuple[str, str]


def _thresholds(below: Thresholds, clips: Sequence[Motion]) -> dict[LabelPair | None, float]:
    """Return the threshold for each pair of labels, or one for None. Raise for invalid ones."""
    by_labels = below if isinstance(below, Mapping) else {None: below}
    thresholds: dict[LabelPair | None, float] = dict(by_labels.items())
    if not thresholds:
        raise MocapError("There is no threshold: name one for at least one pair of labels.")
    labels = sorted({label for clip in clips for label in clip.labels})
    for pair, metres in thresholds.items():
        if not metres > 0:
            raise MocapError(f"A threshold is above 0 m, got {metres} m{f' for {pair}' if pair else ''}.")
        for label in set(pair or ()) - set(labels):
            raise MocapError(f"No clip has the label '{label}'; there are: {', '.join(labels) or 'none'}.")
    return thresholds


def join_clouds(  # noqa: PLR0913 (clips, a window, and weights)
    clips: Sequence[Motion],
    weights: ArrayLike | None,
    window: int,
    padding: int,
    dtype: type[np.floating[Any]],
    *,
    taper: ArrayLike | None = None,
) -> Cloud:
    """Prepare and concatenate the clouds of all clips. Windows across two clips have infinite size.

    After each clip, `padding` more frames are infinite, so that windows of two clips are never neighbours.
    """
    unit = unit_weights(weights, len(distinct_joints(clips[0].skeleton)))
    level = _checked_cloud(clips[0])[..., 1].mean(axis=0)
    clouds = []
    for clip in clips:
        points = np.pad(_checked_cloud(clip), ((0, padding), (0, 0), (0, 0)), mode="edge")
        prepared = cloud(points, level, unit, window, dtype, taper=taper)
        prepared.sizes[len(clip) - window + 1 :] = np.inf
        clouds.append(prepared)
    return join(clouds)


def _checked_cloud(clip: Motion) -> Array:
    """Return the points of a clip, shape (F, P, 3); raise if they are too far from the origin."""
    points = point_cloud(clip)
    require_near(points, f"'{clip.name}'")
    return points


def _both_ways(minima: Array, clips: Sequence[Motion], gap: int) -> Transitions:
    """Convert minima to transitions in both directions. The opposite one has the inverse transform."""
    first, second = minima[:2].astype(np.int64)
    cost, *alignment = minima[2:]
    transform = PlanarTransform(*alignment)
    leave = np.concatenate([first, second])
    enter = np.concatenate([second, first])
    order = np.lexsort((enter, leave))  # by `leave`, then by `enter`
    starts = np.cumsum([0, *(len(clip) + gap for clip in clips)])
    source, leave = _clip_and_frame(starts, leave[order])
    target, enter = _clip_and_frame(starts, enter[order])
    fields = zip(transform, transform.inverse(), strict=True)
    transforms = PlanarTransform(*(np.concatenate(there_and_back)[order] for there_and_back in fields))
    return Transitions(source, leave, target, enter, np.tile(cost, 2)[order], transforms)


def _clip_and_frame(starts: Integers, frames: Integers) -> tuple[Integers, Integers]:
    """Convert frames of the concatenated clips to numbers of clips and frames within them."""
    clip = np.searchsorted(starts, frames, side="right") - 1
    return clip.astype(np.int32), (frames - starts[clip]).astype(np.int32)


def _limits(
    thresholds: Mapping[LabelPair | None, float],
    clips: Sequence[Motion],
    window: int,
    transitions: Transitions,
) -> Array:
    """Return the threshold of each transition; NaN, which no cost is below, if no pair of labels applies."""
    starts = np.cumsum([0, *map(len, clips)])
    leave = starts[transitions.source] + transitions.leave
    enter = starts[transitions.target] + transitions.enter

    def has_label(label: str, frame: Integers) -> NDArray[np.bool_]:
        """Return which windows have a label in any of their frames."""
        marks = [np.broadcast_to(motion.labels.get(label, False), len(motion)) for motion in clips]
        marked_frames = np.append(0, np.cumsum(np.concatenate(marks)))
        return np.asarray(marked_frames[frame + window] > marked_frames[frame])

    reverse = {pair and pair[::-1]: metres for pair, metres in thresholds.items()}
    limits = np.full(len(transitions), np.nan)
    for pair, metres in (reverse | dict(thresholds)).items():
        applies = np.ones(len(transitions), bool)
        if pair:
            source_label, target_label = pair
            applies = has_label(source_label, leave) & has_label(target_label, enter)
        limits[applies] = np.fmin(limits[applies], metres)
    return limits
