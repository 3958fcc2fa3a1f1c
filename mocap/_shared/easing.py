"""The curve that eases from 0 to 1."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array


def quintic_step(amount: ArrayLike) -> Array:
    """Ease from 0 to 1 by 10u³ - 15u⁴ + 6u⁵, for u in [0, 1]; 0 below, 1 above.

    It is the polynomial of lowest degree whose speed and acceleration are 0 at both ends. Computer graphics
    calls it smootherstep.

    Examples
    --------
    >>> quintic_step([-1.0, 0.0, 0.5, 2.0])
    array([0. , 0. , 0.5, 1. ])
    """
    u = np.clip(amount, 0, 1)
    return np.asarray(u**3 * (10 - 15 * u + 6 * u**2))
