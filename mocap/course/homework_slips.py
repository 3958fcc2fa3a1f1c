"""Five slips of the homework that this package grew out of, to see what they do, and what mends them.

Nothing else here uses them. Each function does a sensible thing in a way that looks right and is not; its
docstring names the slip and the mend.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion, concatenate
from mocap.body.planar import PlanarTransform, lay_on


def lay_in_full(motion: Motion, target: Motion, frame: int) -> Motion:
    """Lay a motion's first frame on a frame of another by turning it, and moving it in x, y *and* z.

    The slip: heights are no matter of choice. Each time the clip is laid on a frame that is a little
    higher or lower in its stride, the difference stays for good, and the body drifts up or down.
    The mend: move over the ground only, `body.lay_on`.

    Parameters
    ----------
    motion : what is moved.
    target, frame : where its first frame comes to lie.

    Notebook: 03-transforms
    """
    planar = lay_on(motion, target, frame).apply_motion(motion)
    roots = planar.root_positions
    lifted = roots + (target.root_positions[frame] - roots[0])
    return replace(planar, root_positions=lifted)


def homework_heading(quaternions: ArrayLike) -> Array:
    """Read the direction a body faces off its root's rotation matrix: θ = atan2(-R₂₀, R₀₀).

    The slip: this is where the body's left points, and that is lost when the left points straight up or down,
    as in a cartwheel. The fix: read the turn about the vertical off the quaternion, `body.heading`.

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

    Notebook: 03-transforms
    """
    matrices = rotations.to_matrix(quaternions)
    return np.asarray(np.arctan2(-matrices[..., 2, 0], matrices[..., 0, 0]))


def euler_from_zero_to_pi(quaternions: ArrayLike) -> Array:
    """Read Euler angles (z, y, x), R = Rz Ry Rx, with the first one in [0, π), as some libraries do.

    The slip: for a body that leans a little to either side, z passes 0 all the time; just below, it is told
    as nearly π, and y and x jump by as much. The rotations are right, frame for frame, and any
    mean of two neighbours' angles is nonsense. The mend: never blend angles; `rotations.slerp`.

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

    Notebook: 03-transforms
    """
    x, y, z = np.moveaxis(euler.to_euler("xyz", quaternions), -1, 0)
    late = z < 0
    angles = np.stack([np.where(late, z + np.pi, z), np.where(late, np.pi - y, y), x + np.pi * late], axis=-1)
    return np.asarray(angles)


def chain_on_last(slices: Sequence[Motion]) -> Motion:
    """Play slices of clips in a row, each laid with its first frame on the *last* frame of the one before.

    The slip: two frames in a row show the root in one place, so that the walker stops for a frame at every
    joint, a stutter, and arrives a frame's way too early. The mend: a slice that follows in its clip
    follows as it is, `concatenate`; others overlap the one before and are blended, `blending.join`.

    Parameters
    ----------
    slices : motions of one skeleton and rate.

    Notebook: 03-transforms
    """
    chain = [slices[0]]
    for following in slices[1:]:
        chain.append(lay_on(following, chain[-1], -1).apply_motion(following))
    return concatenate(chain)


def turn_in_place(root_positions: Array, angle: float) -> Array:
    """Turn root positions, shape (F, 3), about the first one's vertical, writing over the array it was given.

    The slip: it is the stored clip that is turned, so the second visit to a clip finds it where the first
    one left it, and the result hangs on the order of the visits. The mend: `PlanarTransform`
    gives a new motion, and a `Motion`'s arrays refuse to be written to.

    Parameters
    ----------
    root_positions : metres; changed.
    angle : radians about +y.

    Notebook: 03-transforms
    """
    first = root_positions[0].copy()
    root_positions[:] = PlanarTransform(angle, first[0], first[2]).apply_points(
        root_positions - first * [1, 0, 1]
    )
    return root_positions
