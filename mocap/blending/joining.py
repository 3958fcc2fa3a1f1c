"""Join two clips by a blend over a window [KGP02, 3.3]: lay one on the other, then put both in a row.

A pair of windows is given as `matching` counts them: frame i of one clip and frame j of another start windows
that look alike.
"""

from collections.abc import Callable

from mocap._shared.arrays import Array
from mocap.blending.interpolation import blend
from mocap.blending.weights import cubic_weights
from mocap.body.motion import Motion, concatenate, require_alike
from mocap.errors import MocapError
from mocap.matching.point_clouds import align, point_cloud


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
