"""Labels from speed: where a clip walks and where it runs, when nobody wrote it down."""

from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import velocities
from mocap.body.motion import Motion


def smooth_speed(motion: Motion, *, span: int) -> Array:
    """Average the root's speed over the ground, over the `span` frames around each frame.

    A body speeds up and slows down within each step, so a single frame says little about its gait. At the
    ends of the clip there are fewer frames to average.

    Parameters
    ----------
    motion : at least two frames.
    span : an odd number of frames, about a stride.

    Returns
    -------
    Shape (F,), metres per second.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> places = [[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3]]
    >>> smooth_speed(Motion(dot, places, [[[1, 0, 0, 0]]] * 4, 10.0), span=3)
    array([10., 10., 10., 10.])
    """
    speeds = np.linalg.norm(velocities(motion.root_positions, motion.fps)[:, [0, 2]], axis=-1)
    half = span // 2
    sums = np.cumsum(np.concatenate([[0.0], speeds]))
    frames = np.arange(len(speeds))
    first, last = np.maximum(frames - half, 0), np.minimum(frames + half + 1, len(speeds))
    return np.asarray((sums[last] - sums[first]) / (last - first))


def label_by_speed(
    motion: Motion, *, above: float, span: int, names: tuple[str, str] = ("walk", "run")
) -> Motion:
    """Label each frame by its `smooth_speed`: the second name where it is above a speed, else the first.

    Parameters
    ----------
    motion : at least two frames.
    above : metres per second.
    span : an odd number of frames, about a stride.
    names : the labels of the slow and of the fast frames.

    Returns
    -------
    The motion with these labels; others stay.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> places = [[0, 0, 0], [0, 0, 0.1], [0, 0, 0.2], [0, 0, 0.6], [0, 0, 1.0]]
    >>> clip = Motion(dot, places, [[[1, 0, 0, 0]]] * 5, 10.0)
    >>> label_by_speed(clip, above=2.0, span=1).labels["run"]
    array([False, False,  True,  True,  True])

    Notebook: 10-real-data
    """
    slow, fast = names
    quick = smooth_speed(motion, span=span) > above
    return replace(motion, labels={**motion.labels, slow: ~quick, fast: quick})
