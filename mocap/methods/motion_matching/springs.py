"""Critically damped springs: how a wish, and the offset after a cut, come and go without swinging.

With half-life h and y = 2 ln 2 / h a spring from x, at velocity v, to a goal g is after t seconds at

    x(t) = g + (j₀ + j₁ t) e^(-y t),   j₀ = x - g,   j₁ = v + j₀ y

[Hol20]. At t = h there is left (1 + 2 ln 2) / 4 = 0.597 of a gap at rest, not one half; half is left after
1.211 h.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array


def _pull(halflife: float) -> float:
    return float(2 * np.log(2) / halflife)


Value = complex | NDArray[Any]  # complex numbers are points on the ground


def spring(start: Value, speed: Value, goal: Value, halflife: float, seconds: ArrayLike) -> NDArray[Any]:
    """Follow a critically damped spring for some seconds [Hol20].

    Parameters
    ----------
    start, speed, goal : where it starts, how fast it moves there, where it is drawn to; any unit.
    halflife : seconds, above 0.
    seconds : when to look; broadcasts with the others.

    Examples
    --------
    >>> spring(1.0, 0.0, 0.0, 0.27, 0.27).round(3)
    np.float64(0.597)

    Notebook: 18-motion-matching
    """
    pull = _pull(halflife)
    gap, t = start - goal, np.asarray(seconds)
    drift = speed + gap * pull
    return np.asarray(goal + (gap + drift * t) * np.exp(-pull * t))


def spring_way(speed: Value, goal: Value, halflife: float, seconds: ArrayLike) -> NDArray[Any]:
    """Integrate a velocity that a spring draws to a goal: how far one comes [ours: the integral of `spring`].

    Parameters
    ----------
    speed, goal : the velocity now, which does not accelerate yet, and the velocity that is wished for.
    halflife, seconds : as for `spring`.

    Examples
    --------
    From rest to 1 m/s; the spring costs 2 / y = 0.39 m of the two:

    >>> spring_way(0.0, 1.0, 0.27, 2.0).round(2)
    np.float64(1.61)

    Notebook: 18-motion-matching
    """
    pull, t = _pull(halflife), np.asarray(seconds)
    gap = speed - goal
    return np.asarray(2 * gap / pull - np.exp(-pull * t) * (2 * gap / pull + gap * t) + goal * t)


def fade(offset: Array, speed: Array, halflife: float, seconds: float) -> tuple[Array, Array]:
    """Let an offset and its velocity die away by a spring towards 0: both as they are after some seconds.

    Examples
    --------
    >>> offset, speed = fade(np.ones(1), np.zeros(1), 0.1, 0.1)
    >>> offset.round(3), speed.round(2)
    (array([0.597]), array([-4.8]))
    """
    pull = _pull(halflife)
    drift = speed + offset * pull
    left = np.exp(-pull * seconds)
    return left * (offset + drift * seconds), left * (speed - drift * pull * seconds)
