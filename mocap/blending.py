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

    Notebook: 04-blending
    """
    t = window_steps(window)
    return np.asarray(2 * t**3 - 3 * t**2 + 1)


def linear_weights(window: int) -> Array:
    """Give weights that fall evenly, α(p) = 1 - (p+1)/k: continuous, but with a kink at both ends.

    Examples
    --------
    >>> linear_weights(4)
    array([0.75, 0.5 , 0.25, 0.  ])

    Notebook: 04-blending
    """
    return 1 - window_steps(window)


def quintic_weights(window: int) -> Array:
    """Give weights that are C² at both ends, so that accelerations do not jump either.

    α(p) = 1 - 10 t³ + 15 t⁴ - 6 t⁵ with t = (p+1)/k, the lowest polynomial that is level and not curved
    where it reaches 1 and 0.

    Examples
    --------
    >>> quintic_weights(4).round(4)
    array([0.8965, 0.5   , 0.1035, 0.    ])

    Notebook: 04-blending
    """
    t = window_steps(window)
    return np.asarray(1 - t**3 * (10 - 15 * t + 6 * t**2))


def sine_weights(window: int) -> Array:
    """Give the homework's weights, α_i = 1 - (1 + sin(π i / (k-1) - π/2)) / 2, where k was 50.

    Unlike the others they hold 1 in the first frame of the window: a frame is spent at either end.

    Examples
    --------
    >>> sine_weights(5).round(4)
    array([1.    , 0.8536, 0.5   , 0.1464, 0.    ])

    Notebook: 04-blending
    """
    if window < 2:
        raise MocapError(f"Sine weights need a window of at least two frames, got {window}.")
    return np.asarray((1 - np.sin(np.linspace(-np.pi / 2, np.pi / 2, window))) / 2)


def window_steps(window: int) -> Array:
    """Count (p+1)/k over a window's frames: 0 would be the frame before it, and 1 is its last.

    Notebook: 04-blending
    """
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    return np.arange(1, window + 1) / window


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

    Notebook: 04-blending
    """
    require_alike([a, b])
    alpha = checked_weights(weights, len(a), len(b))
    of_a = alpha >= 0.5
    alpha = alpha[:, None]  # (F, 1)
    return replace(
        a,
        root_positions=alpha * a.root_positions + (1 - alpha) * b.root_positions,
        rotations=rotations.slerp(b.rotations, a.rotations, alpha),
        labels=chosen_marks(a.labels, b.labels, of_a),
        contacts=chosen_marks(a.contacts, b.contacts, of_a),
    )


def checked_weights(weights: ArrayLike, frames: int, others: int) -> Array:
    """Take blend weights as an array, one for each frame of two motions that are as long.

    Raises
    ------
    MocapError : for other lengths, and for weights outside [0, 1].

    Notebook: 04-blending
    """
    alpha = np.asarray(weights, float)
    if frames != others or alpha.shape != (frames,):
        raise MocapError(
            f"Blending needs as many frames of each motion as weights, got {frames}, {others}, {alpha.shape}."
        )
    if not ((alpha >= 0) & (alpha <= 1)).all():
        raise MocapError(f"Blend weights must lie in [0, 1], got {alpha.tolist()}.")
    return alpha


def chosen_marks(a: Marks, b: Marks, of_a: NDArray[np.bool_]) -> Mapping[str, NDArray[np.bool_]]:
    """Take each mark from the motion that a frame is `of`; one that a motion lacks is off there.

    Notebook: 04-blending
    """
    absent = np.zeros(len(of_a), bool)
    return {
        name: np.where(of_a, a.get(name, absent), b.get(name, absent)) for name in dict.fromkeys([*a, *b])
    }
