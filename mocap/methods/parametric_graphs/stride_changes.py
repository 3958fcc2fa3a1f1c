"""Strides that begin as one kind and end as another: what joins walk and jog, which no threshold joins."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from mocap._shared.arrays import Array, Indices
from mocap._shared.easing import quintic_step
from mocap.errors import MocapError
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes
from mocap.methods.parametric_graphs.strides import Strides

FROM, TO = 0.2, 0.8  # phases between which a change takes place
NEAR = np.radians(5)  # a turn that the other kind nearly has
MOST = 60  # examples of a change


def changing_strides(first: Strides, second: Strides) -> Strides:
    """Fade strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the one of the second that turns most like it. Between the
    phases 0.2 and 0.8 all rates and poses go from the one to the other, with level ends; so its start fits
    what follows the first kind, and its end what comes before the second.

    Parameters
    ----------
    first, second : examples over the same strikes, of one skeleton and rate.

    Returns
    -------
    At most 60 examples, of turns that both kinds have.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over other strikes, and of other skeletons or rates.

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
        raise MocapError("A change goes between examples over the same strikes.")
    if first.fps != second.fps or first.contact_names != second.contact_names:
        raise MocapError("A change goes between examples of one rate and with the same marks.")
    first.skeleton.require_same(second.skeleton)
    one, other = _pairs(first, second)
    share = quintic_step((first.grid - FROM) / (TO - FROM))
    poses = first.poses[one], _same_sign(second.poses[other], first.poses[one])
    mixed = _fade(poses[0], poses[1], share)
    made = replace(
        first,
        seconds=_clock(first.seconds[one], second.seconds[other], share, first),
        speeds=_fade(first.speeds[one], second.speeds[other], share),
        turning=_fade(first.turning[one], second.turning[other], share),
        heights=_fade(first.heights[one], second.heights[other], share),
        poses=mixed / np.linalg.norm(mixed, axis=-1, keepdims=True),
        contacts=np.where((share < 0.5)[:, None], first.contacts[one], second.contacts[other]),
        values=np.zeros((len(one), 2)),
        sway=(first.sway + second.sway) / 2,
        offset=(first.offset + second.offset) / 2,
        dropped=0,
    )
    return replace(made, values=measure_mixes(made, np.eye(len(made))))


def _pairs(first: Strides, second: Strides) -> tuple[Indices, Indices]:
    """Pair each stride of the first kind with the one of the second that turns most like it."""
    turns, others = first.values[:, 0], second.values[:, 0]
    shared = np.flatnonzero((turns >= others.min() - NEAR) & (turns <= others.max() + NEAR))
    if not len(shared):
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    ordered = shared[np.argsort(turns[shared])]
    one = ordered[np.unique(np.linspace(0, len(ordered) - 1, MOST).round().astype(int))]
    return one, np.abs(turns[one][:, None] - others).argmin(axis=1)


def _same_sign(poses: Array, like: Array) -> Array:
    return np.where((poses * like).sum(axis=-1, keepdims=True) < 0, -poses, poses)


def _fade(before: NDArray[Any], after: NDArray[Any], share: Array) -> NDArray[Any]:
    """Go from (N, G, ...) to another, by a share for each phase."""
    amount = share.reshape(-1, *[1] * (before.ndim - 2))
    return np.asarray((1 - amount) * before + amount * after)


def _clock(before: Array, after: Array, share: Array, strides: Strides) -> Array:
    """Fade how long a phase lasts, and integrate: seconds since the first strike."""
    step, zero = strides.grid[1] - strides.grid[0], strides.ends[0]
    rates = [np.gradient(seconds, step, axis=1) for seconds in (before, after)]
    rate = _fade(rates[0], rates[1], share)
    total = cumulative_trapezoid(rate, dx=step, axis=1, initial=0.0)
    return np.asarray(total - total[:, zero : zero + 1])
