"""From one clip into another: by a blend over a window [KGP02, 3.3], or a cut whose offset dies away [Bol18].

A pair of windows is given as `matching` counts them: frame i of one clip and frame j of another start windows
that look alike.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.motion import Motion, concatenate, gather_marks, require_alike
from mocap.errors import MocapError
from mocap.matching.point_clouds import align, point_cloud


def blend(a: Motion, b: Motion, weights: ArrayLike) -> Motion:
    """Mix two motions frame by frame: roots on a line, rotations by slerp [KGP02, Eqs. 5 and 6].

    It does not align the motions: lay b on a first.

    Parameters
    ----------
    a, b : motions of F frames each.
    weights : shape (F,), how much of `a` each frame holds, in [0, 1].

    Returns
    -------
    F frames; marks come from the motion with the larger weight, from `a` where they are equal.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons, rates or lengths, and for weights outside [0, 1].

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> here, there = (Motion(dot, [[x, 1, 0]], [[[1, 0, 0, 0]]], 30.0) for x in (0, 4))
    >>> blend(here, there, [0.25]).root_positions
    array([[3., 1., 0.]])

    Notebook: 04-blending
    """
    a, b = require_alike([a, b])
    alpha = np.asarray(weights, float)
    if len(a) != len(b) or alpha.shape != (len(a),):
        got = f"{len(a)}, {len(b)}, {alpha.shape}"
        raise MocapError(f"Blending needs as many frames of each motion as weights, got {got}.")
    if not ((alpha >= 0) & (alpha <= 1)).all():
        raise MocapError(f"Blend weights must lie in [0, 1], got {alpha.tolist()}.")
    owner = np.stack([alpha < 0.5, np.arange(len(a))], axis=1)  # a or b, and which frame
    alpha = alpha[:, None]  # (F, 1)
    return replace(
        a,
        root_positions=alpha * a.root_positions + (1 - alpha) * b.root_positions,
        rotations=rotations.slerp(b.rotations, a.rotations, alpha),
        labels=gather_marks([a.labels, b.labels], owner),
        contacts=gather_marks([a.contacts, b.contacts], owner),
    )


def lay_window_on(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Lay b on a so that the windows from j and from i agree best [KGP02, Eqs. 2-4].

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that run off a clip.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> a, b = (Motion(dot, [[x, 1, 0]] * 2, [[[1, 0, 0, 0]]] * 2, 30.0) for x in (5, 0))
    >>> lay_window_on(a, 0, b, 0, 2).root_positions
    array([[5., 1., 0.],
           [5., 1., 0.]])

    Notebook: 04b-feet
    """
    a, b = require_alike([a, b])
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    for clip, start in ((a, i), (b, j)):
        if start < 0 or start + window > len(clip):
            span = f"The window of {window} frames from frame {start}"
            raise MocapError(f"{span} runs off '{clip.name}', which has {len(clip)}.")
    clouds = (point_cloud(clip[start : start + window]).reshape(-1, 3) for clip, start in ((a, i), (b, j)))
    return align(*clouds).apply_motion(b)


def splice(a: Motion, i: int, middle: Motion, b: Motion, j: int) -> Motion:
    """Put the frames a[:i], the middle ones and b[j:] in a row.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> a, b = (Motion(dot, [[x, 1, 0]] * 3, [[[1, 0, 0, 0]]] * 3, 30.0, n) for x, n in ((0, "a"), (9, "b")))
    >>> spliced = splice(a, 2, a[:1], b, 1)
    >>> spliced.name, spliced.root_positions[:, 0].tolist()
    ('a to b', [0.0, 0.0, 0.0, 9.0, 9.0])
    """
    parts = [a[:i]] if i > 0 else []
    parts += [middle] + ([b[j:]] if j < len(b) else [])
    return concatenate(parts, name=f"{a.name} to {b.name}")


def join(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Pass from one motion into another by blending two windows [KGP02, 3.3], [WP95, joining].

    Frames a[:i] as they are; then a[i : i+k] mixed with b[j : j+k]; then b[j+k :]. b is first laid on a by
    the planar transform under which the two windows' points agree best. (The paper counts b's window
    by its last frame; here j is its first, as in `matching.Transition.enter`.)

    Parameters
    ----------
    a, i : the motion to leave, and the first frame of the window in it.
    b, j : the motion to enter, and the first frame of the window in it.
    window : frames k of the transition.

    Returns
    -------
    i + len(b) - j frames; marks within the window come from the motion with the larger weight.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that run off a clip.

    Examples
    --------
    >>> import numpy as np
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [1, 0, 0]])
    >>> roots = [[x, 1, 0] for x in range(6)]
    >>> glide = Motion(bone, roots, np.tile([1.0, 0, 0, 0], (6, 2, 1)), 30.0)
    >>> join(glide, 3, glide, 0, 2).root_positions[:, 0].round(6) + 0.0
    array([0., 1., 2., 3., 4., 5., 6., 7., 8.])

    Notebook: 04-blending
    """
    b = lay_window_on(a, i, b, j, window)
    mixed = blend(a[i : i + window], b[j : j + window], cubic_weights(window))
    return splice(a, i, mixed, b, j + window)


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

    Notebook: 09b-blend-window
    """
    b = lay_window_on(a, i, b, j, window)
    before = 1 if min(i, j) > 0 else 0
    after = 1 if window > 1 else 0
    around = np.arange(-before, after + 1)
    shifts = a.root_positions[i + around] - b.root_positions[j + around]
    turns = rotations.difference(b.rotations[j + around], a.rotations[i + around])
    shift, turn = (_decay(offsets, before, window) for offsets in (shifts, _steady(turns, before)))
    onward = b[j : j + window]
    turned = rotations.multiply(onward.rotations, rotations.from_rotvec(turn))
    faded = replace(onward, root_positions=onward.root_positions + shift, rotations=turned)
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
