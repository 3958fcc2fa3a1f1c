"""What a join and a cut have in common: lay one clip on another, then put the frames of both in a row.

A pair of windows is given as `matching` counts them: frame i of one clip and frame j of another start windows
that look alike.
"""

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
