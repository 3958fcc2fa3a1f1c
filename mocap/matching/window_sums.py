"""Sums over the frames of all pairs of windows, along the diagonals of a product of matrices."""

from typing import Any

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from mocap._shared.arrays import Array


def frame_sums(a: NDArray[Any], b: NDArray[Any], weights: Array) -> NDArray[Any]:
    """Sum weights[f] · (a[i + f] · b[j + f]) over the frames f, for all pairs of windows i and j.

    Equal weights take about log₂ k additions for each pair, other weights k.

    Parameters
    ----------
    a, b : shapes (n + k - 1, P) and (m + k - 1, P), frames.
    weights : shape (k,).

    Returns
    -------
    Shape (n, m).

    Examples
    --------
    >>> frame_sums(np.array([[1.0], [2], [3]]), np.array([[1.0], [10]]), np.array([0.25, 0.75]))
    array([[15.25],
           [23. ]])
    """
    exact_weights = weights.astype(a.real.dtype)
    window = len(weights)
    if np.ptp(weights) == 0:
        return diagonal_sum((exact_weights[0] * a) @ b.T, window)
    products = a @ b.T
    rows = len(a) - window + 1
    columns = len(b) - window + 1
    sums = np.zeros((rows, columns), products.dtype)
    for frame, weight in enumerate(exact_weights):
        sums += weight * products[frame : frame + rows, frame : frame + columns]
    return sums


def diagonal_sum(products: NDArray[Any], window: int) -> NDArray[Any]:
    """Sum products[i + f, j + f] over the frames f < window, by recursive doubling.

    Examples
    --------
    >>> diagonal_sum(np.array([[1, 2, 0], [0, 3, 4], [0, 0, 5]]), 2)
    array([[4, 6],
           [0, 8]])
    """
    rows, columns = products.shape
    row_by_row = products.ravel()
    next_on_diagonal = columns + 1  # stride: one row down and one column to the right
    sums = _strided_sum(row_by_row, window, next_on_diagonal)
    # The shape leaves out the last sums of each row, which extend into the next row.
    shape = (rows - window + 1, columns - window + 1)
    return np.asarray(as_strided(sums, shape, (columns * sums.itemsize, sums.itemsize)))


def _strided_sum(values: NDArray[Any], count: int, step: int) -> NDArray[Any]:
    """Sum `count` values at stride `step` from each n, by recursive doubling (a new array if count > 1)."""
    if count == 1:
        return values
    half = count // 2
    sums = _strided_sum(values, half, step)
    sums = sums[: -half * step] + sums[half * step :]  # of 2 · half values
    if count % 2:
        sums = sums[:-step]
        sums += values[(count - 1) * step :]
    return np.asarray(sums)
