"""Three slips of the homework that this package started from: what they do, and what fixes them.

Nothing else in the package uses them. Each function looks right but is wrong. Its docstring names the slip
and the fix.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion, concatenate
from mocap.body.planar import lay_on


def homework_heading(quaternions: ArrayLike) -> Array:
    """Compute the direction that a body faces from its root's rotation matrix: θ = atan2(-R₂₀, R₀₀).

    The slip: this angle is where the left side of the body points. It is undefined when the left side points
    straight up or down, as in a cartwheel. The fix: take the turn about the vertical from the quaternion,
    `body.heading`.

    Parameters
    ----------
    quaternions : root orientations, shape (..., 4).

    Returns
    -------
    Angles about +y, shape (...), radians in [-π, π]: 0 faces +z, π/2 faces +x.

    Examples
    --------
    >>> float(homework_heading(rotations.about_y(0.7)).round(6))
    0.7

    Notebook: 03b-angles
    """
    matrices = rotations.to_matrix(quaternions)
    return np.asarray(np.arctan2(-matrices[..., 2, 0], matrices[..., 0, 0]))


def euler_from_zero_to_pi(quaternions: ArrayLike) -> Array:
    """Compute Euler angles (z, y, x), R = Rz Ry Rx, with the first one in [0, π), as some libraries do.

    The slip: for a body that leans a little to either side, z often passes 0. Just below 0 the result is
    nearly π, and y and x jump by as much. Each frame's rotation is right, but the mean of the angles of two
    neighbouring frames is not a rotation between them. The fix: do not blend angles, use `rotations.slerp`.

    Parameters
    ----------
    quaternions : shape (..., 4).

    Returns
    -------
    Angles z, y, x, shape (..., 3), radians.

    Examples
    --------
    >>> euler_from_zero_to_pi(euler.from_euler("z", [[0.01], [-0.01]])).round(2) + 0.0
    array([[0.01, 0.  , 0.  ],
           [3.13, 3.14, 3.14]])

    Notebook: 03b-angles
    """
    x, y, z = np.moveaxis(euler.to_euler("xyz", quaternions), -1, 0)
    late = z < 0
    angles = np.stack([np.where(late, z + np.pi, z), np.where(late, np.pi - y, y), x + np.pi * late], axis=-1)
    return np.asarray(angles)


def chain_on_last(slices: Sequence[Motion]) -> Motion:
    """Play slices of clips in a row, each with its first frame laid on the *last* frame of the one before.

    The slip: two frames in a row show the root in one place. So the walker stops for one frame at each seam,
    which looks like a stutter, and ends one step of a frame short. The fix: a slice that follows in its own
    clip needs no move, `concatenate`; other slices overlap the one before and are blended, `blending.join`.

    Parameters
    ----------
    slices : motions of one skeleton and frame rate.

    Returns
    -------
    One motion.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> ball = Skeleton(["ball"], [-1], [[0, 0, 0]])
    >>> motion = Motion(ball, [[0, 0, 0.0], [0, 0, 0.1]], [[[1, 0, 0, 0]]] * 2, 30)
    >>> chain_on_last([motion, motion]).root_positions[:, 2]
    array([0. , 0.1, 0.1, 0.2])

    Notebook: 03b-angles
    """
    chain = [slices[0]]
    for following in slices[1:]:
        chain.append(lay_on(following, chain[-1], -1).apply_motion(following))
    return concatenate(chain)
