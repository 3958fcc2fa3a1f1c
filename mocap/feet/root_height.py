"""How far the root rises or falls so that planted feet cost the knees little: step 3 of [KSG02]."""

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap.body.kinematics import GlobalPoses
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.feet.ankle_targets import FADE, FootTarget
from mocap.feet.leg_ik import knee_hinge

MOST = 0.02  # metres: a plant is not worth moving the root further
STRAIGHT = np.radians(5.0)  # a knee less bent counts as bent by this: no leg rules the root alone
HEAVY = 3.0  # what a metre of rise costs, when a knee's turn by a radian of a leg a metre long costs 1


def root_rise(
    motion: Motion, legs: Sequence[Leg], poses: GlobalPoses, targets: Sequence[FootTarget]
) -> Array:
    """Raise or lower the root so that the knees change little and both legs reach their targets.

    A rise h makes the leg from a hip to its target d + g h long, g the upright share of its direction, and a
    knee bent by φ turns by as much as the length changes, over sin φ. Least squares over the legs
    and the rise itself, Σ ((d + g h - d_before) / sin φ)² + 3 h², has the solution below.

    Parameters
    ----------
    motion : F frames.
    legs, targets : the legs, and where each one's ankle shall be.
    poses : the motion's.

    Returns
    -------
    Metres, shape (F,).
    """
    above, below = np.zeros(len(motion)), np.full(len(motion), HEAVY)
    limit = np.full(len(motion), np.inf)
    for leg, target in zip(legs, targets, strict=True):
        hinge = knee_hinge(leg, poses, motion.skeleton.names[leg.knee])
        hip = poses.positions[:, leg.hip]
        before = np.linalg.norm(poses.positions[:, leg.ankle] - hip, axis=-1)
        apart = hip - target.ankle
        distance = np.linalg.norm(apart, axis=-1)
        upright = apart[:, 1] / distance
        stiffness = 1 / (np.sin(hinge.straight) ** 2 + np.sin(STRAIGHT) ** 2)
        above += stiffness * upright * (before - distance)
        below += stiffness * upright**2
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        highest = np.sqrt(np.maximum(hinge.limit(before) ** 2 - level, 0.0)) - apart[:, 1]
        limit = np.minimum(limit, highest)
    rise = above / below
    radius = max(1, round(FADE * motion.fps))
    # A maximum as wide as the bell that smooths it: what is taken off stays enough.
    excess = maximum_filter1d(np.maximum(rise - limit, 0.0), 2 * radius + 1)
    return np.asarray(rise - gaussian_filter1d(excess, radius / 2, radius=radius))
