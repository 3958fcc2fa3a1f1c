"""Two motions into one: weights over a window, and the pose between two poses."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap import rotations
from mocap.errors import MocapError
from mocap.motion import Marks, Motion, require_alike

Array = NDArray[np.float64]


def cubic_weights(window: int) -> Array:
    """Give the weights α of the first motion over a transition, C¹ at both ends [KGP02, Eq. 7].

    α(p) = 2 ((p+1)/k)³ - 3 ((p+1)/k)² + 1 for the frames p = 0 … k-1: it falls from nearly 1 to 0,
    and is level where it would reach 1 (at p = -1) and 0.

    Parameters
    ----------
    window : frames k of the transition.

    Returns
    -------
    Shape (k,).

    Examples
    --------
    >>> cubic_weights(4)
    array([0.84375, 0.5    , 0.15625, 0.     ])

    Notebook: 00-quickstart
    """
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    t = np.arange(1, window + 1) / window
    return np.asarray(2 * t**3 - 3 * t**2 + 1)


def blend(a: Motion, b: Motion, weights: ArrayLike) -> Motion:
    """Mix two motions frame by frame: roots on a line, rotations by slerp [KGP02, Eqs. 5 and 6].

    Nothing is aligned here: lay b on a first.

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
    >>> from mocap.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> here, there = (Motion(dot, [[x, 1, 0]], [[[1, 0, 0, 0]]], 30.0) for x in (0, 4))
    >>> blend(here, there, [0.25]).root_positions
    array([[3., 1., 0.]])

    Notebook: 00-quickstart
    """
    require_alike([a, b])
    alpha = np.asarray(weights, float)
    if len(a) != len(b) or alpha.shape != (len(a),):
        raise MocapError(
            f"Blending needs as many frames of each motion as weights, got {len(a)}, {len(b)}, {alpha.shape}."
        )
    if not ((alpha >= 0) & (alpha <= 1)).all():
        raise MocapError(f"Blend weights must lie in [0, 1], got {alpha.tolist()}.")
    of_a = alpha >= 0.5
    return replace(
        a,
        root_positions=alpha[:, None] * a.root_positions + (1 - alpha[:, None]) * b.root_positions,
        rotations=rotations.slerp(b.rotations, a.rotations, alpha[:, None]),
        labels=_chosen_marks(a.labels, b.labels, of_a),
        contacts=_chosen_marks(a.contacts, b.contacts, of_a),
    )


def _chosen_marks(a: Marks, b: Marks, of_a: NDArray[np.bool_]) -> Mapping[str, NDArray[np.bool_]]:
    absent = np.zeros(len(of_a), bool)
    return {
        name: np.where(of_a, a.get(name, absent), b.get(name, absent)) for name in dict.fromkeys([*a, *b])
    }
