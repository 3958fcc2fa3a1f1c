"""Two motions into one: weights over a window, and the pose between two poses."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap.body import rotations
from mocap.body.motion import Motion, gather_marks, require_alike
from mocap.errors import MocapError


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
    require_alike([a, b])
    alpha = np.asarray(weights, float)
    if len(a) != len(b) or alpha.shape != (len(a),):
        raise MocapError(
            f"Blending needs as many frames of each motion as weights, got {len(a)}, {len(b)}, {alpha.shape}."
        )
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
