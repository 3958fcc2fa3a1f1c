"""Where the joints of a clip are: each climbs to the root, frame by frame, as in notebook 01."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.course.lab.own.tools import Tools
from mocap.matching import distinct_joints


def joint_cloud(clip: Motion, by: Tools) -> Array:
    """Give the joints that are different points, shape (F, P, 3), metres.

    Examples
    --------
    >>> from mocap import datasets
    >>> from mocap.course.lab.own.tools import packages
    >>> joint_cloud(datasets.sample()[:2], packages()).shape
    (2, 31, 3)
    """
    joints = distinct_joints(clip.skeleton)
    frames = zip(clip.root_positions, clip.rotations, strict=True)
    return np.array(
        [[root + by.climb(clip.skeleton, turns, joint) for joint in joints] for root, turns in frames]
    )
