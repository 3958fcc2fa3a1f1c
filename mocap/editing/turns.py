"""How a joint is turned, as a position for which pins have a box.

A pin is a box for a position. A rotation fits into it as a rotation vector times a length: then one formula
gives the residual of both, in metres. The length is ours.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.editing.tuned import TUNED


class Turn(NamedTuple):
    """How one joint is turned, q, as a position for which `Pins` have a box: `TUNED.arm` log(r⁻¹ q).

    Parameters
    ----------
    joint : its index.
    reference : r, quaternions (F, 4).
    world : whether q is the joint's rotation in the world, or against its parent.

    Examples
    --------
    >>> from mocap.body.kinematics import forward_kinematics
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:2]
    >>> matrices = forward_kinematics(walk).matrices
    >>> arm = Turn(0, walk.rotations[:, 0], world=True).arm(walk, matrices)
    >>> float(abs(arm).max()) < 1e-12
    True
    """

    joint: int
    reference: Array
    world: bool

    def arm(self, motion: Motion, matrices: Array) -> Array:
        """Compute `TUNED.arm` log(r⁻¹ q), (F, 3), metres, by the world `matrices` (F, J, 3, 3)."""
        if self.world:
            turned = rotations.from_matrix(matrices[:, self.joint])
        else:
            turned = motion.rotations[:, self.joint]
        return np.asarray(TUNED.arm * rotations.difference(self.reference, turned))
