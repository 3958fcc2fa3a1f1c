"""Where can one clip pass into another? The local minima of the distance grids of all pairs of clips."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError
from mocap.matching.distance_grids import Cloud, cloud, require_windows
from mocap.matching.minima import find_minima
from mocap.matching.point_clouds import distinct_joints, point_cloud, require_near, unit_weights

Integers = NDArray[np.integer[Any]]
Thresholds = float | Mapping[tuple[str, str], float]
"""One threshold in metres, or one for each pair of labels."""


FEW = 20_000  # frames up to which the work is done in 64 bits


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
        ways = (np.asarray(field) for field in self.transform)
        return (self.source, self.leave, self.target, self.enter, self.cost, *ways)

    @overload
    def __getitem__(self, index: int) -> Transition: ...
    @overload
    def __getitem__(self, index: slice | NDArray[Any]) -> Transitions: ...
    def __getitem__(self, index: int | slice | NDArray[Any]) -> Transition | Transitions:
        if isinstance(index, int | np.integer):
            return next(iter(self[np.array([index])]))
        source, leave, target, enter, cost, *laid = (column[index] for column in self.columns)
        return Transitions(source, leave, target, enter, cost, PlanarTransform(*laid))

    def __iter__(self) -> Iterator[Transition]:
        rows = zip(*(column.tolist() for column in self.columns), strict=True)
        for source, leave, target, enter, cost, *laid in rows:
            yield Transition(source, leave, target, enter, cost, PlanarTransform(*laid))


def find_transitions(  # noqa: PLR0913 (what to find, how exactly, and where to work)
    clips: Sequence[Motion],
    *,
    window: int,
    below: Thresholds,
    joint_weights: ArrayLike | None = None,
    progress: Progress = iter,
    executor: Executor | None = None,
) -> Transitions:
    """Find where one clip can pass into another: local minima of the distance grids of all pairs.

    In the paper: [KGP02, thresholds].

    The grids are never held as a whole: memory grows with the number of frames and of transitions found. A
    pair of windows is measured once, for both ways between them.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window : frames in a window; about a third of a second.
    below : the largest RMS distance of the points, metres. Or one for each pair of labels, as {("walk",
        "run"): 0.05, ...}: from windows in which the first label is on to windows with the second, or back
        where that pair is not named itself. Where several pairs apply the strictest counts; where none
        applies there is no transition.
    joint_weights : of the points, as for `distance_grid`.
    progress : wraps the pairs of blocks as they are worked through, to show a bar.
    executor : where to work: threads, processes, or a cluster by `dask.distributed`'s
        `Client.get_executor()`; by default here, one block after the other. On machines of one kind the
        result is the same, bit for bit. Set OMP_NUM_THREADS=1 first, or each worker's matrix products ask
        for all cores as well.

    Returns
    -------
    Transitions both ways between all pairs, within a clip too, ordered by clip and frame; costs are right
    to a micrometre. Windows of one clip that overlap are left out: they would lead from a moment to itself.
    Above 20 000 frames in all clips the work is done in 32 bits, up to twice as fast. Where a valley of the
    grid is flat, a minimum is then found a few frames further, or twice: of CMU subject 16's, 1 in 2000 at 30
    frames per second, and 7 in 1000 at 120.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window, points
        out of reach, thresholds that are not above 0, labels that no clip has, and weights that are negative,
        all 0 or of the wrong shape.

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
    each: Mapping[Any, float] = below if isinstance(below, Mapping) else {None: below}
    if not each:
        raise MocapError("There is no threshold: name one for at least one pair of labels.")
    known = sorted({label for clip in clips for label in clip.labels})
    for pair, metres in each.items():
        if not metres > 0:
            raise MocapError(f"A threshold is above 0 m, got {metres} m{f' for {pair}' if pair else ''}.")
        for label in set(pair or ()) - set(known):
            raise MocapError(f"No clip has the label '{label}'; there are: {', '.join(known) or 'none'}.")
    gap = int(window == 1)  # longer windows that run off a clip keep the clips apart by themselves
    double = sum(map(len, clips)) <= FEW
    ready = join_clouds(clips, joint_weights, window, gap, np.float64 if double else np.float32)
    found = find_minima(ready, max(each.values()), progress=progress, executor=executor)
    transitions = _both_ways(found, clips, gap)
    return transitions[transitions.cost < _limits(each, clips, window, transitions)]


def join_clouds(
    clips: Sequence[Motion], weights: ArrayLike | None, window: int, gap: int, dtype: type[np.floating[Any]]
) -> Cloud:
    """Put all clips one after the other; windows that would run from one into the next have infinite size.

    After each clip `gap` more frames are infinite, so that no window is a neighbour of one of another clip.
    """
    share = unit_weights(weights, len(distinct_joints(clips[0].skeleton)))
    clouds, level = [], None
    for clip in clips:
        points = point_cloud(clip)
        require_near(points, f"'{clip.name}'")
        level = points[..., 1].mean(0) if level is None else level
        points = np.pad(points, ((0, gap), (0, 0), (0, 0)), mode="edge")
        clouds.append(cloud(points, level, share, window, dtype))
        clouds[-1].sizes[len(clip) - window + 1 :] = np.inf
    return Cloud(*(np.concatenate(arrays) for arrays in zip(*clouds, strict=True)))


def _both_ways(found: Array, clips: Sequence[Motion], gap: int) -> Transitions:
    """Turn what `find_minima` found into transitions both ways; the way back is the inverse."""
    first, second = found[:2].astype(np.int64)
    there = PlanarTransform(*found[3:])
    i, j = np.concatenate([first, second]), np.concatenate([second, first])
    order = np.lexsort((j, i))  # by i, then by j
    i, j = i[order], j[order]
    starts = np.cumsum([0, *(len(clip) + gap for clip in clips)])
    first, second = (np.searchsorted(starts, frame, side="right") - 1 for frame in (i, j))  # clips
    numbers = (first, i - starts[first], second, j - starts[second])
    source, leave, target, enter = (column.astype(np.int32) for column in numbers)
    ways = (np.concatenate(both)[order] for both in zip(there, there.inverse(), strict=True))
    return Transitions(source, leave, target, enter, np.tile(found[2], 2)[order], PlanarTransform(*ways))


def _limits(below: Mapping[Any, float], clips: Sequence[Motion], window: int, found: Transitions) -> Array:
    """Give each transition its threshold: NaN, which no cost is below, where no pair of labels applies."""
    starts, limits = np.cumsum([0, *map(len, clips)]), np.full(len(found), np.nan)

    def bears(label: str, clip: Integers, frame: Integers) -> NDArray[np.bool_]:
        """Mark the windows in which a label is on in any of their frames."""
        marks = [np.broadcast_to(motion.labels.get(label, False), len(motion)) for motion in clips]
        on, first = np.append(0, np.cumsum(np.concatenate(marks))), starts[clip] + frame
        return np.asarray(on[first + window] > on[first])

    for pair, metres in ({pair and pair[::-1]: m for pair, m in below.items()} | dict(below)).items():
        applies = np.ones(len(found), bool)
        if pair:
            applies = bears(pair[0], found.source, found.leave) & bears(pair[1], found.target, found.enter)
        limits[applies] = np.fmin(limits[applies], metres)
    return limits
