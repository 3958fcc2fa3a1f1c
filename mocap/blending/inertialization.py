"""A cut whose offset dies away: inertialization [Bol18]."""

from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array
from mocap.blending.joining import lay_window_on, splice
from mocap.body import rotations
from mocap.body.motion import Motion


def inertialize(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Cut from one motion to another, and let their difference at the cut fade to zero [Bol18].

    At the cut a's pose is b's pose plus an offset x that changes with the velocity v. From there on only b
    plays, plus this offset, which fades over T = k / fps by the quintic
    x(u) = (1 - u)⁴ (x + (4 x + v T) u), u = t / T. It ends at rest, without acceleration and without jerk.
    The talk's own quintic also starts with the offset's acceleration, and T is cut where it would overshoot.
    Roots are offset by vectors, rotations by rotation vectors. Unlike a blend it plays no frames of a after
    the cut, so games can use it at any moment; but it does not know where a was going.

    Parameters
    ----------
    a, i, b, j, window : as for `join`; the cut is at frame i, and the offset fades over the window.

    Returns
    -------
    i + len(b) - j frames; frame i is a's own; marks are b's from there on.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that run off a clip.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [1, 0, 0]])
    >>> roots = [[x, 1, 0] for x in range(6)]
    >>> glide = Motion(bone, roots, np.tile([1.0, 0, 0, 0], (6, 2, 1)), 30.0)
    >>> inertialize(glide, 3, glide, 0, 2).root_positions[:, 0].round(6) + 0.0
    array([0., 1., 2., 3., 4., 5., 6., 7., 8.])

    Notebook: 04-blending
    """
    b = lay_window_on(a, i, b, j, window)
    before = 1 if min(i, j) > 0 else 0
    after = 1 if window > 1 else 0
    around = np.arange(-before, after + 1)
    shifts = a.root_positions[i + around] - b.root_positions[j + around]
    turns = rotations.to_rotvec(
        rotations.multiply(rotations.inverse(b.rotations[j + around]), a.rotations[i + around])
    )
    shift, turn = (_decay(offsets, before, window) for offsets in (shifts, _steady(turns, before)))
    onward = b[j : j + window]
    faded = replace(
        onward,
        root_positions=onward.root_positions + shift,
        rotations=rotations.multiply(onward.rotations, rotations.from_rotvec(turn)),
    )
    return splice(a, i, faded, b, j + window)


def _steady(turns: Array, cut: int) -> Array:
    """Two rotation vectors mean each turn: take the one that is nearer to the vector at index `cut`."""
    length = np.maximum(np.linalg.norm(turns, axis=-1, keepdims=True), 1e-12)
    others = turns * (1 - 2 * np.pi / length)
    gaps = (np.linalg.norm(way - turns[cut], axis=-1, keepdims=True) for way in (turns, others))
    return np.where(np.less(*gaps), turns, others)


def _decay(offsets: Array, cut: int, window: int) -> Array:
    """Fade the offset at index `cut` of offsets (n, ...), with its velocity there, over a window."""
    start = offsets[cut]
    drift = np.gradient(offsets, axis=0)[cut] * window if len(offsets) > 1 else 0 * start  # v T
    u = (np.arange(window) / window).reshape(-1, *np.ones(start.ndim, int))
    return np.asarray((1 - u) ** 4 * (start + (4 * start + drift) * u))
