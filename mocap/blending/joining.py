"""Join two clips by a blend over a window [KGP02, 3.3]."""

from collections.abc import Callable

from mocap._shared.arrays import Array
from mocap.blending.interpolation import blend
from mocap.blending.splicing import lay_window_on, splice
from mocap.blending.weights import cubic_weights
from mocap.body.motion import Motion


def join(  # noqa: PLR0913 (two moments, and how to pass from one to the other)
    a: Motion, i: int, b: Motion, j: int, window: int, *, weights: Callable[[int], Array] = cubic_weights
) -> Motion:
    """Pass from one motion into another by blending two windows [KGP02, 3.3], [WP95, joining].

    Frames a[:i] as they are; then a[i : i+k] mixed with b[j : j+k]; then b[j+k :]. b is first laid on a by
    the planar transform under which the two windows' points agree best. (The paper counts b's window
    by its last frame; here j is its first, as in `Transition.enter`.)

    Parameters
    ----------
    a, i : the motion to leave, and the first frame of the window in it.
    b, j : the motion to enter, and the first frame of the window in it.
    window : frames k of the transition.
    weights : a function that gives for k the weights of `a`, shape (k,): one of this room's, or your own.

    Returns
    -------
    i + len(b) - j frames; marks within the window come from the motion with the larger weight.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, windows that run off a clip, and
        weights outside [0, 1].

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
    mixed = blend(a[i : i + window], b[j : j + window], weights(window))
    return splice(a, i, mixed, b, j + window)
