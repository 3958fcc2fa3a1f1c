"""Two motions into one: weights over a window, and the pose between two poses."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.motion import Marks, Motion, require_alike
from mocap.errors import MocapError


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
    >>> from mocap.body.skeleton import Skeleton
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
