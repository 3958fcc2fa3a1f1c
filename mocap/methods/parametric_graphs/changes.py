"""Changes from one kind of motion to another: of a walk into a jog, or into a stand and out of it [ours]."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.easing import quintic_step
from mocap.errors import MocapError
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes

FROM, TO = 0.2, 0.8  # phases between which a change takes place
NEAR = np.radians(5)  # a turn that the other kind nearly has
EXAMPLES = 60  # of a change, at most


def changing_strides(first: Examples, second: Examples, *, stands: str = "") -> Examples:
    """Fade strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the one of the second that turns most like it. Between the
    phases 0.2 and 0.8 all rates and poses go from the one to the other, with level ends; so its start fits
    what follows the first kind, and its end what comes before the second.

    Parameters
    ----------
    first, second : examples over the same phases, of one skeleton and rate.
    stands : "first" or "second" for examples that do not walk, such as punches: of them only the beginning
        or the end is in the change, each foot of the walker takes its step from there or to there, and pairs
        need not turn alike.

    Returns
    -------
    At most 60 examples, of turns that both kinds have.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over other phases, and of other skeletons or rates.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.body import resample
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> kinds = [cut_strides([resample(sample(f"walk_6m_{speed}_0"), 30)]) for speed in (0.7, 1.65)]
    >>> speeds = [kind.values[:, 1].mean() for kind in (kinds[0], changing_strides(*kinds), kinds[1])]
    >>> bool(speeds[0] < speeds[1] < speeds[2])
    True
    """
    if len(first.grid) != len(second.grid) or not np.allclose(first.grid, second.grid):
        raise MocapError("A change goes between examples over the same phases.")
    first.require_joinable(second)
    one, other = _pairs(first, second, any_turn=bool(stands))
    first, second = first.take(one), second.take(other)
    first = _held(first, -1, FROM) if stands == "first" else first
    second = _held(second, TO, 2) if stands == "second" else second
    made = _faded(first, second, quintic_step((first.grid - FROM) / (TO - FROM)), bool(stands))
    return replace(made, values=measure_mixes(made, np.eye(len(made))))


def _faded(first: Examples, second: Examples, share: Array, stands: bool) -> Examples:
    """Fade all rates and poses by a share (G,); marks change when half is faded, or come from both sides."""
    grid = first.grid
    apart = (first.poses * second.poses).sum(axis=-1, keepdims=True) < 0  # q and -q are one rotation
    poses = (first.poses, np.where(apart, -second.poses, second.poses))
    paces = [np.gradient(some.seconds, grid[1] - grid[0], axis=1) for some in (first, second)]

    def faded(before: NDArray[Any], after: NDArray[Any]) -> NDArray[Any]:
        amount = share.reshape(-1, *[1] * (before.ndim - 2))
        return np.asarray((1 - amount) * before + amount * after)

    turns = faded(*poses)
    until, since = (grid < 1, grid > 0) if stands else (share < 0.5, share >= 0.5)
    before, after = np.where(until[:, None], first.contacts, 1), np.where(since[:, None], second.contacts, 1)
    return replace(
        first,
        speeds=faded(first.speeds, second.speeds),
        turning=faded(first.turning, second.turning),
        heights=faded(first.heights, second.heights),
        seconds=first.integrated(faded(*paces)),  # how long a phase lasts is what fades
        poses=turns / np.linalg.norm(turns, axis=-1, keepdims=True),
        contacts=before * after,
        sway=(first.sway + second.sway) / 2,
        offset=(first.offset + second.offset) / 2,
        dropped=0,
    )


def _held(examples: Examples, low: float, high: float) -> Examples:
    """Let examples stand still before one phase and after another."""
    rows = np.searchsorted(examples.grid, np.clip(examples.grid, low, high) - 1e-9)
    goes = rows == np.arange(len(rows))
    moved = {part: getattr(examples, part) * goes for part in ("speeds", "turning")}
    stood = {part: getattr(examples, part)[:, rows] for part in ("heights", "poses")}
    return replace(examples, **moved, **stood, contacts=np.maximum(examples.contacts, ~goes[:, None]))


def _pairs(first: Examples, second: Examples, any_turn: bool) -> tuple[Indices, Indices]:
    """Pair examples of two kinds, spread over their turns: any two, or those that turn most alike."""
    turns, others = first.values[:, 0], second.values[:, 0]
    if any_turn:
        count = max(len(turns), len(others))
        return np.resize(_spread(turns), count)[:EXAMPLES], np.resize(_spread(others), count)[:EXAMPLES]
    shared = np.flatnonzero((turns >= others.min() - NEAR) & (turns <= others.max() + NEAR))
    if not len(shared):
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    one = shared[_spread(turns[shared])]
    return one, np.abs(turns[one][:, None] - others).argmin(axis=1)


def _spread(turns: Array) -> Indices:
    """Choose examples that are spread evenly in the order of their turns."""
    places = np.unique(np.linspace(0, len(turns) - 1, EXAMPLES).round().astype(int))
    return np.asarray(np.argsort(turns)[places])
