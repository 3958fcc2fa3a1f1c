"""Weights of the first motion over the frames of a transition."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import MocapError


def cubic_weights(window: int) -> Array:
    """Return the cubic weights α of the first motion over a transition, C¹ at both ends [KGP02, Eq. 7].

    α(p) = 2 ((p+1)/k)³ - 3 ((p+1)/k)² + 1 for the frames p = 0 … k-1. At p = -1, the frame before the window,
    α would be 1, and in the last frame it is 0. Its slope is 0 at both.

    Parameters
    ----------
    window : frames k of the transition.

    Returns
    -------
    Shape (k,).

    Examples
    --------
    >>> cubic_weights(4)
    array([0.84375, 0.5    , 0.15625, 0.     ])

    Notebook: 04-blending
    """
    t = window_steps(window)
    return np.asarray(2 * t**3 - 3 * t**2 + 1)


def linear_weights(window: int) -> Array:
    """Return linear weights, α(p) = 1 - (p+1)/k: continuous, but with a kink at both ends.

    Examples
    --------
    >>> linear_weights(4)
    array([0.75, 0.5 , 0.25, 0.  ])

    Notebook: 09b-blend-window
    """
    return 1 - window_steps(window)


def sine_weights(window: int) -> Array:
    """Return the sine weights of the homework, α_i = 1 - (1 + sin(π i / (k-1) - π/2)) / 2, with k = 50 there.

    Unlike the other weights, they are 1 in the first frame of the window.

    Examples
    --------
    >>> sine_weights(5).round(4)
    array([1.    , 0.8536, 0.5   , 0.1464, 0.    ])

    Notebook: 09b-blend-window
    """
    if window < 2:
        raise MocapError(f"Sine weights need a window of at least two frames, got {window}.")
    return np.asarray((1 - np.sin(np.linspace(-np.pi / 2, np.pi / 2, window))) / 2)


def window_steps(window: int) -> Array:
    """Return (p+1)/k for the frames p of a window: 1 in its last frame, and 0 would be the frame before it.

    Examples
    --------
    >>> window_steps(4)
    array([0.25, 0.5 , 0.75, 1.  ])
    """
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    return np.arange(1, window + 1) / window
