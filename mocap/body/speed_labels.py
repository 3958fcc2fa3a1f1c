"""Labels from speed: where a clip walks and where it runs, when nobody wrote it down."""

from dataclasses import replace

import numpy as np

from mocap.body.kinematics import velocities
from mocap.body.motion import Motion


def label_by_speed(
    motion: Motion, *, above: float, span: int, names: tuple[str, str] = ("walk", "run")
) -> Motion:
    """Label each frame by the root's mean speed over the ground: the second name where it is above.

    A body speeds up and slows down within each step, so a single frame says little about its gait. The mean
    is over the `span` frames around each frame; at the ends of the clip there are fewer.

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
    speeds = np.linalg.norm(velocities(motion.root_positions, motion.fps)[:, [0, 2]], axis=-1)
    sums, frames = np.cumsum([0.0, *speeds]), np.arange(len(speeds))
    first, last = np.maximum(frames - span // 2, 0), np.minimum(frames + span // 2 + 1, len(speeds))
    quick = sums[last] - sums[first] > above * (last - first)
    return replace(motion, labels={**motion.labels, names[0]: ~quick, names[1]: quick})
