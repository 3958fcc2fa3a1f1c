"""Where can one clip pass into another? The local minima of the distance grids of all pairs of clips."""

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
from mocap.matching.distance_grids import Cloud, cloud, join, require_windows
from mocap.matching.minima import find_minima
from mocap.matching.point_clouds import distinct_joints, point_cloud, require_near, unit_weights
from mocap.matching.tuned import TUNED

Integers = NDArray[np.integer[Any]]
Thresholds = float | Mapping[tuple[str, str], float]
"""One threshold in metres, or one for each pair of labels."""


class Transition(NamedTuple):
    """A way from one clip into another: two windows alike enough to be blended.

    The window of clip `source` starts at frame `leave`, that of clip `target` at frame `enter`; `transform`
    lays the second on the first, and `cost` is the RMS distance of the points that is left, in metres.
    """

    source: int
    leave: int
    target: int
    enter: int
    cost: float
    transform: PlanarTransform


@dataclass(frozen=True, eq=False, repr=False)
class Transitions(Sequence[Transition]):
    """Many transitions: a sequence of `Transition` records, kept as one array of shape (N,) per field.

    An index gives a record; a slice, a mask of booleans or an array of indices gives Transitions.

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


def find_transitions(  # noqa: PLR0913 (what to find, how exactly, and where to work)
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
    """Find where one clip can pass into another: local minima of the distance grids of all pairs.

    In the paper: [KGP02, thresholds].

    The grids are never held as a whole: memory grows with the number of frames and of transitions found. A
    pair of windows is measured once, for both ways between them.

    Of two searches the quicker is taken. Up to 5 000 windows, or if a sample of them says that more than one
    pair in twenty may be below the threshold, all pairs are measured: four times the time for twice the
    frames. Otherwise a lower bound of the distance rules out most pairs: of many kinds of motion, twice the
    frames take 3.4 times the time (exponent 1.75). The minima are the same.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window : frames in a window; about a third of a second.
    below : the largest RMS distance of the points, metres. Or one for each pair of labels, as {("walk",
        "run"): 0.05, ...}: from windows in which the first label is on to windows with the second, or back
        where that pair is not named itself. Where several pairs apply the strictest counts; where none
        applies there is no transition.
    joint_weights, taper : of the points and of the frames in a window, as for `distance_grid`.
    progress : wraps the pairs of blocks as they are worked through, to show a bar.
    executor : where to work: processes, or a cluster by `dask.distributed`'s `Client.get_executor()`; by
        default on threads of this process.
    jobs : threads without an executor; by default one for each core that the process may use. On machines of
        one kind the result is the same, bit for bit, for any number of threads and for any executor.

    Returns
    -------
    Transitions both ways between all pairs, within a clip too, ordered by clip and frame; costs are right
    to a micrometre. Windows of one clip that overlap are left out: they would lead from a moment to itself.
    Above 20 000 frames in all clips the work is done in 32 bits, up to twice as fast. Where a valley of the
    grid is flat, a minimum is then found a few frames further, or twice: of CMU subject 16's, 1 in 2000 at 30
    frames per second, and 7 in 1000 at 120. The two searches then differ in such minima, too: in 20 of 4 900,
    of 77 606 frames.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window, points
        out of reach, thresholds that are not above 0, labels that no clip has, weights that are negative, all
        0 or of the wrong shape, and jobs that are not at least 1.

    Examples
    --------
    One point that rises, and one that sinks: their middle frames are 1 cm apart.

    >>> from mocap.body.skeleton import Skeleton
    >>> dot, turns = Skeleton(["root"], [-1], [[0, 0, 0]]), np.tile([1.0, 0, 0, 0], (3, 1, 1))
    >>> rise = Motion(dot, [[0, 1.0, 0], [0, 1.3, 0], [0, 1.6, 0]], turns, 30.0)
    >>> sink = Motion(dot, [[0, 2.0, 0], [0, 1.31, 0], [0, 0.5, 0]], turns, 30.0)
    >>> found = find_transitions([rise, sink], window=1, below=0.05)
    >>> [(t.source, t.leave, t.target, t.enter, round(t.cost, 6)) for t in found]
    [(0, 1, 1, 1, 0.01), (1, 1, 0, 1, 0.01)]

    Notebook: 05b-choice-points
    """
    clips = require_windows(clips, window)
    check_threshold(below)
    thresholds = _thresholds(below, clips)
    gap = int(window == 1)  # longer windows that run off a clip keep the clips apart by themselves
    is_small = sum(map(len, clips)) <= TUNED.few_frames
    dtype = np.float64 if is_small else np.float32
    ready = join_clouds(clips, joint_weights, window, gap, dtype, taper=taper)
    loosest = max(thresholds.values())
    minima = find_minima(ready, loosest, progress=progress, executor=executor, jobs=jobs)
    transitions = _both_ways(minima, clips, gap)
    return transitions[transitions.cost < _limits(thresholds, clips, window, transitions)]


LabelPair = tuple[str, str]


def _thresholds(below: Thresholds, clips: Sequence[Motion]) -> dict[LabelPair | None, float]:
    """Return the threshold for each pair of labels, or one for None; raise unless they can be met."""
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


def join_clouds(  # noqa: PLR0913 (what to join, and what each point and frame counts)
    clips: Sequence[Motion],
    weights: ArrayLike | None,
    window: int,
    gap: int,
    dtype: type[np.floating[Any]],
    *,
    taper: ArrayLike | None = None,
) -> Cloud:
    """Put all clips one after the other; windows that would run from one into the next have infinite size.

    After each clip `gap` more frames are infinite, so that no window is a neighbour of one of another clip.
    """
    unit = unit_weights(weights, len(distinct_joints(clips[0].skeleton)))
    level = _checked_cloud(clips[0])[..., 1].mean(axis=0)
    clouds = []
    for clip in clips:
        points = np.pad(_checked_cloud(clip), ((0, gap), (0, 0), (0, 0)), mode="edge")
        prepared = cloud(points, level, unit, window, dtype, taper=taper)
        prepared.sizes[len(clip) - window + 1 :] = np.inf
        clouds.append(prepared)
    return join(clouds)


def _checked_cloud(clip: Motion) -> Array:
    """Return the points of a clip, shape (F, P, 3); raise if they are out of reach."""
    points = point_cloud(clip)
    require_near(points, f"'{clip.name}'")
    return points


def _both_ways(minima: Array, clips: Sequence[Motion], gap: int) -> Transitions:
    """Turn what `find_minima` found into transitions both ways; the way back is the inverse."""
    first, second = minima[:2].astype(np.int64)
    cost, *alignment = minima[2:]
    transform = PlanarTransform(*alignment)
    leave = np.concatenate([first, second])
    enter = np.concatenate([second, first])
    order = np.lexsort((enter, leave))  # by the first of the two, then by the second
    starts = np.cumsum([0, *(len(clip) + gap for clip in clips)])
    source, leave = _clip_and_frame(starts, leave[order])
    target, enter = _clip_and_frame(starts, enter[order])
    fields = zip(transform, transform.inverse(), strict=True)
    transforms = PlanarTransform(*(np.concatenate(there_and_back)[order] for there_and_back in fields))
    return Transitions(source, leave, target, enter, np.tile(cost, 2)[order], transforms)


def _clip_and_frame(starts: Integers, frames: Integers) -> tuple[Integers, Integers]:
    """Return which clips frames of all clips are in, and which of its frames they are."""
    clip = np.searchsorted(starts, frames, side="right") - 1
    return clip.astype(np.int32), (frames - starts[clip]).astype(np.int32)


def _limits(
    thresholds: Mapping[LabelPair | None, float],
    clips: Sequence[Motion],
    window: int,
    transitions: Transitions,
) -> Array:
    """Return the threshold of each transition: NaN, which no cost is below, if no pair of labels applies."""
    starts = np.cumsum([0, *map(len, clips)])
    leave = starts[transitions.source] + transitions.leave
    enter = starts[transitions.target] + transitions.enter

    def has_label(label: str, frame: Integers) -> NDArray[np.bool_]:
        """Mark the windows in which a label is on in any of their frames."""
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
