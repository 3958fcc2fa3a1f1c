"""Transitions between two clips: a blend over a window [KGP02, 3.3], or a cut whose offset fades [Bol18].

A pair of windows is given as in `matching`, by the first frame of each: i of one clip and j of another.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.motion import Motion, concatenate, gather_marks, require_compatible
from mocap.errors import MocapError
from mocap.matching.point_clouds import align, point_cloud


def blend(a: Motion, b: Motion, weights: ArrayLike) -> Motion:
    """Blend two motions frame by frame: roots linearly, rotations by slerp [KGP02, Eqs. 5 and 6].

    It does not align the motions: align b with a first.

    Parameters
    ----------
    a, b : motions of F frames each.
    weights : shape (F,), the weight of `a` in each frame, in [0, 1].

    Returns
    -------
    F frames; marks come from the motion with the larger weight, from `a` if the weights are equal.

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
    a, b = require_compatible([a, b])
    alpha = np.asarray(weights, float)
    if len(a) != len(b) or alpha.shape != (len(a),):
        got = f"{len(a)}, {len(b)}, {alpha.shape}"
        raise MocapError(f"Blending needs as many frames of each motion as weights, got {got}.")
    if not ((alpha >= 0) & (alpha <= 1)).all():
        raise MocapError(f"Blend weights must lie in [0, 1], got {alpha.tolist()}.")
    sources = np.stack(
        [alpha < 0.5, np.arange(len(a))], axis=1
    )  # of marks: 0 for a or 1 for b, and the frame
    labels = gather_marks([a.labels, b.labels], sources)
    contacts = gather_marks([a.contacts, b.contacts], sources)
    alpha = alpha[:, None]  # (F, 1)
    roots = alpha * a.root_positions + (1 - alpha) * b.root_positions
    quaternions = rotations.slerp(b.rotations, a.rotations, alpha)
    return replace(a, root_positions=roots, rotations=quaternions, labels=labels, contacts=contacts)


def align_window(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Align b with a so that the windows from frames j and i agree best [KGP02, Eqs. 2-4].

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that run off a clip.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> a, b = (Motion(dot, [[x, 1, 0]] * 2, [[[1, 0, 0, 0]]] * 2, 30.0) for x in (5, 0))
    >>> align_window(a, 0, b, 0, 2).root_positions
    array([[5., 1., 0.],
           [5., 1., 0.]])

    Notebook: 04b-feet
    """
    a, b = require_compatible([a, b])
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    for clip, start in ((a, i), (b, j)):
        if start < 0 or start + window > len(clip):
            span = f"The window of {window} frames from frame {start}"
            raise MocapError(f"{span} runs off '{clip.name}', which has {len(clip)}.")
    a_points = point_cloud(a[i : i + window]).reshape(-1, 3)
    b_points = point_cloud(b[j : j + window]).reshape(-1, 3)
    return align(a_points, b_points).apply_motion(b)


def splice(a: Motion, i: int, middle: Motion, b: Motion, j: int) -> Motion:
    """Concatenate the frames a[:i], the middle ones and b[j:].

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> a, b = (Motion(dot, [[x, 1, 0]] * 3, [[[1, 0, 0, 0]]] * 3, 30.0, n) for x, n in ((0, "a"), (9, "b")))
    >>> spliced = splice(a, 2, a[:1], b, 1)
    >>> spliced.name, spliced.root_positions[:, 0].tolist()
    ('a to b', [0.0, 0.0, 0.0, 9.0, 9.0])
    """
    parts = [middle]
    if i > 0:
        parts.insert(0, a[:i])
    if j < len(b):
        parts.append(b[j:])
    return concatenate(parts, name=f"{a.name} to {b.name}")


def join(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Join two motions by blending a window of each [KGP02, 3.3], [WP95, joining].

    Frames a[:i] as they are; then a[i : i+k] blended with b[j : j+k]; then b[j+k :]. b is first aligned with
    a by the planar transform under which the two windows' points agree best. (The paper counts b's window by
    its last frame; here j is its first, as in `matching.Transition.enter`.)

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
    b = align_window(a, i, b, j, window)
    mixed = blend(a[i : i + window], b[j : j + window], cubic_weights(window))
    return splice(a, i, mixed, b, j + window)


def inertialize(a: Motion, i: int, b: Motion, j: int, window: int) -> Motion:
    """Cut from one motion to another, and fade their difference at the cut to zero (inertialization) [Bol18].

    At the cut, a's pose is b's pose plus an offset x that changes with the velocity v. After the cut only b
    plays, plus this offset, which fades over T = k / fps by the quintic
    x(u) = (1 - u)⁴ (x + (4 x + v T) u), u = t / T. It ends at rest, without acceleration and without jerk.
    The talk's own quintic also starts with the offset's acceleration, and shortens T if it would overshoot.
    Roots are offset by vectors, rotations by rotation vectors. Unlike a blend it plays no frames of a after
    the cut. Therefore games can use it at any moment, but it does not know where a was going.

    Parameters
    ----------
    a, i, b, j, window : as for `join`; the cut is at frame i, and the offset fades over the window.

    Returns
    -------
    i + len(b) - j frames; the pose of frame i is a's, and from frame i marks are b's.

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
    b = align_window(a, i, b, j, window)
    first = -1 if min(i, j) > 0 else 0
    last = 1 if window > 1 else 0
    frames = np.arange(first, last + 1)  # relative to the cut
    cut = -first  # the index of the cut in these frames
    shifts = a.root_positions[i + frames] - b.root_positions[j + frames]
    vectors = rotations.difference(b.rotations[j + frames], a.rotations[i + frames])
    shift = _fade(shifts, cut, window)
    vector = _fade(_near_the_cut(vectors, cut), cut, window)
    played = b[j : j + window]
    turned = rotations.multiply(played.rotations, rotations.from_rotvec(vector))
    faded = replace(played, root_positions=played.root_positions + shift, rotations=turned)
    return splice(a, i, faded, b, j + window)


def _near_the_cut(vectors: Array, cut: int) -> Array:
    """Choose, of the two rotation vectors of a rotation, the one nearer to the vector at index `cut`.

    A rotation by θ about n is one by θ - 2π about n: its vectors are θ n and (θ - 2π) n.
    """
    angle = np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    twins = vectors * (1 - 2 * np.pi / angle)
    distance = np.linalg.norm(vectors - vectors[cut], axis=-1, keepdims=True)
    twin_distance = np.linalg.norm(twins - vectors[cut], axis=-1, keepdims=True)
    return np.where(distance < twin_distance, vectors, twins)


def _fade(offsets: Array, cut: int, window: int) -> Array:
    """Fade the offset at index `cut` of offsets (n, ...), with its velocity there, to zero over a window."""
    start = offsets[cut]
    drift = np.gradient(offsets, axis=0)[cut] * window if len(offsets) > 1 else 0 * start  # v T
    u = (np.arange(window) / window).reshape(-1, *np.ones(start.ndim, int))
    return np.asarray((1 - u) ** 4 * (start + (4 * start + drift) * u))
