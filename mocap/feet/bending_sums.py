"""The sum that a curve which bends least makes least [KSG02, step 5], as a matrix of five diagonals."""

import numpy as np

from mocap._shared.arrays import Array


def bending_bands(weight: Array, near: float) -> Array:
    """Write Σ w_f |c_{f-1} - 2 c_f + c_{f+1}|² + near Σ |c_f|² as cᵀ B c.

    Parameters
    ----------
    weight : w, shape (F,); where the curve starts and ends no w counts.
    near : how much the curve's own size counts.

    Returns
    -------
    B's diagonal and the two below, which are those above, too: shape (3, F); what is beyond their ends is 0.

    Examples
    --------
    >>> bending_bands(np.ones(4), 0.5)
    array([[ 1.5,  5.5,  5.5,  1.5],
           [-2. , -4. , -2. ,  0. ],
           [ 1. ,  1. ,  0. ,  0. ]])
    """
    inner = np.concatenate([[0.0], weight[1:-1], [0.0]])[: len(weight)]
    before, after = np.roll(inner, 1), np.roll(inner, -1)
    return np.array([near + before + 4 * inner + after, 0 - 2 * (inner + after), after])


def band_product(bands: Array, curves: Array) -> Array:
    """Multiply matrices, by their bands (..., 3, F), and curves (..., F, C)."""
    product = bands[..., 0, :, None] * curves
    for later in (1, 2):
        below = bands[..., later, :-later, None]
        product[..., later:, :] += below * curves[..., :-later, :]
        product[..., :-later, :] += below * curves[..., later:, :]
    return product
