"""A smooth step from 0 to 1."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array


def quintic_step(amount: ArrayLike) -> Array:
    """Smooth step from 0 to 1, 10u³ - 15u⁴ + 6u⁵ for u in [0, 1]; 0 below, 1 above.

    It is the polynomial of lowest degree whose first and second derivatives are 0 at both ends, known as
    smootherstep in computer graphics.

    Examples
    --------
    >>> quintic_step([-1.0, 0.0, 0.5, 2.0])
    array([0. , 0. , 0.5, 1. ])
    """
    u = np.clip(amount, 0, 1)
    return np.asarray(u**3 * (10 - 15 * u + 6 * u**2))
