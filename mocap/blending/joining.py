"""Transitions between two clips: a blend over a window [KGP02, 3.3], or inertialization [Bol18].

As in `matching`, a pair of windows is given by their first frames: i of one clip and j of another.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.concatenation import concatenate, gather_marks, require_compatible
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.matching.point_clouds import align, point_cloud


def blend(a: Motion, b: Motion, weights: ArrayLike) -> Motion:
    """Blend two motions frame by frame: roots linearly, rotations by slerp [KGP02, Eqs. 5 and 6].

    The motions are not aligned: align b with a first.

    Parameters
    ----------
    a, b : motions of F frames each.
    weights : shape (F,), the weight of `a` in each frame, in [0, 1].

    Returns
    -------
    F frames. Labels and contacts are those of the motion with the larger weight, of `a` if they are equal.

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
    """Align b with a by the optimal transform of the windows from frames i and j [KGP02, Eqs. 2-4].

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that extend beyond a clip.

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
    """Concatenate a[:i], `middle` and b[j:].

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

    The result consists of a[:i], the blend of a[i : i+k] and b[j : j+k], and b[j+k :]. Motion b is first
    aligned with a by the planar transform that minimises the distance of the windows' points. (In the paper,
    j is the last frame of the window in b. Here it is the first, as in `matching.Transition.enter`.)

    Parameters
    ----------
    a, i : the motion to leave, and the first frame of the window in it.
    b, j : the motion to enter, and the first frame of the window in it.
    window : frames k of the transition.

    Returns
    -------
    i + len(b) - j frames. In the window, labels and contacts are those of the motion with the larger weight.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that extend beyond a clip.

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
    """Join two motions by inertialization: cut from a to b, and fade their difference to zero [Bol18].

    At the cut, the pose of a is that of b plus an offset x with velocity v. After the cut, b is played with
    this offset, which fades over T = k / fps by the quintic
    x(u) = (1 - u)⁴ (x + (4 x + v T) u), u = t / T. At its end, velocity, acceleration and jerk are zero. The
    quintic of the talk also matches the acceleration at the cut, and reduces T to avoid overshoot. Offsets of
    roots are vectors, those of rotations are rotation vectors. Unlike a blend, inertialization uses no frames
    of a after the cut. Games can therefore apply it at any moment, but the motion that would have followed in
    a is ignored.

    Parameters
    ----------
    a, i, b, j, window : as for `join`; the cut is at frame i, and the offset fades over the window.

    Returns
    -------
    i + len(b) - j frames. The pose of frame i is that of a. From frame i, labels and contacts are those of b.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and windows that extend beyond a clip.

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
    """Choose between the two rotation vectors of each rotation the one nearer to that at index `cut`.

    A rotation by θ about n is also a rotation by θ - 2π: its vectors are θ n and (θ - 2π) n.
    """
    angle = np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    twins = vectors * (1 - 2 * np.pi / angle)
    distance = np.linalg.norm(vectors - vectors[cut], axis=-1, keepdims=True)
    twin_distance = np.linalg.norm(twins - vectors[cut], axis=-1, keepdims=True)
    return np.where(distance < twin_distance, vectors, twins)


def _fade(offsets: Array, cut: int, window: int) -> Array:
    """Compute the offsets over a window that fade to zero from the value and velocity at index `cut`."""
    start = offsets[cut]
    drift = np.gradient(offsets, axis=0)[cut] * window if len(offsets) > 1 else 0 * start  # v T
    u = (np.arange(window) / window).reshape(-1, *np.ones(start.ndim, int))
    return np.asarray((1 - u) ** 4 * (start + (4 * start + drift) * u))
