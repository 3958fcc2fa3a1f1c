"""From one clip into another: by a blend over a window, or by a cut whose offset dies away.

Both ways take a pair of windows as `matching` counts them: frame i of one clip and frame j of another start
windows that look alike, and the second clip is laid on the first so that the windows agree best.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocap import rotations
from mocap.blending import blend, cubic_weights
from mocap.errors import MocapError
from mocap.matching import align, point_cloud
from mocap.motion import Motion, concatenate, require_alike

Array = NDArray[np.float64]


def join(  # noqa: PLR0913 (two moments, and how to pass from one to the other)
    a: Motion, i: int, b: Motion, j: int, window: int, *, weights: Callable[[int], Array] = cubic_weights
) -> Motion:
    """Pass from one motion into another by blending two windows [KGP02, 3.3].

    Frames a[:i] as they are; then a[i : i+k] mixed with b[j : j+k]; then b[j+k :]. b is first laid on a by
    the planar transform under which the two windows' points agree best. (The paper counts b's window
    by its last frame; here j is its first, as in `Transition.enter`.)

    Parameters
    ----------
    a, i : the motion to leave, and the first frame of the window in it.
    b, j : the motion to enter, and the first frame of the window in it.
    window : frames k of the transition.
    weights : gives for k the weights of `a`, shape (k,): one of `blending`'s, or your own.

    Returns
    -------
    i + len(b) - j frames; marks within the window come from the motion with the larger weight.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, windows that run off a clip, and
        weights outside [0, 1].

    Examples
    --------
    >>> from mocap.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [1, 0, 0]])
    >>> roots = [[x, 1, 0] for x in range(6)]
    >>> glide = Motion(bone, roots, np.tile([1.0, 0, 0, 0], (6, 2, 1)), 30.0)
    >>> join(glide, 3, glide, 0, 2).root_positions[:, 0].round(6) + 0.0
    array([0., 1., 2., 3., 4., 5., 6., 7., 8.])

    Notebook: 04-blending
    """
    b = lay_on(a, i, b, j, window)
    mixed = blend(a[i : i + window], b[j : j + window], weights(window))
    return _spliced(a, i, mixed, b, j + window)


def inertialize(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Cut from one motion to another, and let what differs at the cut die away [Bol18].

    The pose that a would have had is b's pose plus an offset. From the cut on, b plays alone, and the
    offset x, as it is at the cut with its velocity v, fades over T = k / fps by the quintic
    x(u) = (1 - u)⁴ (x + (4 x + v T) u), u = t / T, which ends at rest, unaccelerated and without jerk. Roots
    are offset by vectors, rotations by rotation vectors. Unlike a blend it needs no more frames of a, so
    games can cut at any moment; but it knows nothing of where a was going.

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
    >>> from mocap.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [1, 0, 0]])
    >>> roots = [[x, 1, 0] for x in range(6)]
    >>> glide = Motion(bone, roots, np.tile([1.0, 0, 0, 0], (6, 2, 1)), 30.0)
    >>> inertialize(glide, 3, glide, 0, 2).root_positions[:, 0].round(6) + 0.0
    array([0., 1., 2., 3., 4., 5., 6., 7., 8.])

    Notebook: 04-blending
    """
    b = lay_on(a, i, b, j, window)
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
    return _spliced(a, i, faded, b, j + window)


def lay_on(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Lay b on a so that the windows from j and from i agree best [KGP02, Eqs. 2-4].

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that run off a clip.

    Notebook: 04-blending
    """
    require_alike([a, b])
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    for clip, start in ((a, i), (b, j)):
        if start < 0 or start + window > len(clip):
            raise MocapError(
                f"The window of {window} frames from frame {start} runs off '{clip.name}', "
                f"which has {len(clip)}."
            )
    clouds = (point_cloud(clip[start : start + window]).reshape(-1, 3) for clip, start in ((a, i), (b, j)))
    return align(*clouds).motion(b)


def _steady(turns: Array, cut: int) -> Array:
    """Of the two rotation vectors that mean each turn, take the one nearer to the turn at index `cut`."""
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


def _spliced(a: Motion, i: int, middle: Motion, b: Motion, j: int) -> Motion:
    """Put the frames a[:i], the middle ones and b[j:] in a row."""
    parts = [a[:i]] if i > 0 else []
    parts += [middle] + ([b[j:]] if j < len(b) else [])
    return concatenate(parts, name=f"{a.name} to {b.name}")
