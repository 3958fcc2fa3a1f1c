"""Where did feet stand? Footprints are read from a motion's contacts."""

from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion


class Footprint(NamedTuple):
    """A `joint` on a body's `side` stood in frames [start, end), on average at (x, z), metres.

    Examples
    --------
    >>> step = Footprint("lfoot", "left", start=10, end=40, x=0.1, z=1.5)
    >>> step.end - step.start
    30
    """

    joint: str
    side: str
    start: int
    end: int
    x: float
    z: float


def find_footprints(motion: Motion) -> list[Footprint]:
    """List where joints stood: one print for each run of frames in which a joint of `motion.contacts` stands.

    Parameters
    ----------
    motion : the motion; one without contacts leaves no prints.

    Returns
    -------
    The prints, joint by joint, and in time order for each joint.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> foot = Skeleton(["lfoot"], [-1], [[0, 0, 0]])
    >>> import numpy as np
    >>> still = np.tile([1.0, 0, 0, 0], (4, 1, 1))
    >>> find_footprints(Motion(foot, np.ones((4, 3)), still, 30.0, contacts={"lfoot": [1, 1, 0, 1]}))
    [Footprint(joint='lfoot', side='middle', start=0, end=2, x=1.0, z=1.0), ...start=3, end=4, x=1.0, z=1.0)]

    Notebook: 01b-motion-files
    """
    if not motion.contacts:
        return []
    points = joint_positions(motion)
    prints = []
    for name, down in motion.contacts.items():
        joint = motion.skeleton.index(name)
        for start, end in runs(down).tolist():
            x, _, z = points[start:end, joint].mean(axis=0).tolist()
            prints.append(Footprint(name, motion.skeleton.side(joint), start, end, x, z))
    return prints


def standing_tracks(motion: Motion) -> Array:
    """Give where joints are over the ground while they stand, as one line with gaps: a slide is a smear.

    Parameters
    ----------
    motion : the motion, with contacts.

    Returns
    -------
    Points (x, z), metres, shape (N, 2), joint by joint; nan where a joint does not stand, and between joints.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> tracks = standing_tracks(walk)
    >>> tracks.shape, bool(np.isnan(tracks).any())
    ((484, 2), True)

    Notebook: 12-path-editing
    """
    points = joint_positions(motion)[..., [0, 2]]
    lines = [np.zeros((0, 2))]
    for name, down in motion.contacts.items():
        line = np.where(down[:, None], points[:, motion.skeleton.index(name)], np.nan)
        lines.append(np.append(line, [[np.nan, np.nan]], axis=0))
    return np.concatenate(lines)
