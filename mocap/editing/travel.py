"""Removal of the travel of a motion, for cycles on the spot, as game engines play them."""

from dataclasses import replace

import numpy as np

from mocap.body.motion import Motion, require_motion

GROUND = [0, 2]  # the axes x and z


def in_place(motion: Motion) -> Motion:
    """Remove the travel over the ground, for cycles that are played on the spot.

    The travel is the straight line from the first position of the root on the ground to the last, at constant
    velocity. Sway and surge about this line remain, as do heights and rotations, and the root ends above the
    point at which it starts. For a motion along a curve the distance from that line remains; cut a turning
    walk to one stride first.

    Parameters
    ----------
    motion : F frames.

    Returns
    -------
    F frames without contacts, because the feet slide. The first frame has its old position.

    Examples
    --------
    >>> from mocap.body import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> roots = [[0, 1, 3], [0.1, 1, 4], [0, 1, 5]]  # 2 m ahead, with a sway of 0.1 m
    >>> in_place(Motion(dot, roots, [[[1, 0, 0, 0]]] * 3, 30.0)).root_positions
    array([[0. , 1. , 3. ],
           [0.1, 1. , 3. ],
           [0. , 1. , 3. ]])
    """
    require_motion(motion)
    root_positions = motion.root_positions.copy()
    travel = root_positions[-1, GROUND] - root_positions[0, GROUND]
    root_positions[:, GROUND] -= np.linspace(0, 1, len(motion))[:, None] * travel
    return replace(motion, root_positions=root_positions, contacts={})
