"""What a motion does, in a number or a few: any such function of a `Motion` can be the measure of a space.

Here are three: how far it turns, how fast it goes, and where the hand reaches.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, on_ground

Measure = Callable[[Motion], ArrayLike]
"""Reads one number or a few off a motion."""


def turn(motion: Motion) -> float:
    """Measure how far the body turns from the first frame to the last, radians, to the left.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> round(np.degrees(turn(sample("walk_5m_0.8_120"))) / 10)
    11

    Notebook: 16-match-webs
    """
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    return float(headings[-1] - headings[0])


def mean_speed(motion: Motion) -> float:
    """Measure how fast the root goes over the ground on average, metres per second.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> round(mean_speed(sample("walk_5m_1.4_0")), 1)
    1.4

    Notebook: 16-match-webs
    """
    way = np.abs(np.diff(on_ground(motion.root_positions))).sum()
    return float(way / max(motion.duration, 1 / motion.fps))


def hand_target(
    motion: Motion, hand: str = "rhand", shoulder: str = "rhumerus", *, at: float | None = None
) -> Array:
    """Measure where a hand is at one moment, from where the body stands and faces at the start.

    Parameters
    ----------
    motion : such as a punch.
    hand, shoulder : names of joints; by default those of the right arm in Acclaim files.
    at : the moment, as a share of the frames; by default that in which the arm is longest.

    Returns
    -------
    Metres to the left, above the ground, and ahead, shape (3,).

    Raises
    ------
    MocapError : for a joint that is not there.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> hand_target(sample("walk_straight")[:120]).shape
    (3,)

    Notebook: 16-match-webs
    """
    tip, root = (motion.skeleton.index(name) for name in (hand, shoulder))
    points = joint_positions(motion)
    arms = np.linalg.norm(points[:, tip] - points[:, root], axis=-1)
    moment = arms.argmax() if at is None else round(at * (len(motion) - 1))
    x, _, z = motion.root_positions[0]
    away = points[moment, tip] - [x, 0, z]
    return PlanarTransform(-float(heading(motion.rotations[0, 0])), 0.0, 0.0).apply_points(away)
