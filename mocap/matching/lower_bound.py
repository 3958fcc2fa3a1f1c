"""A lower bound of the distance between two windows: most pairs need no closer look.

Measure the points of a window from its centroid on the ground: a point has the height y and the horizontal
vector h. The best planar transform lays the centroids on each other and turns by R, so

    D = min over R of Σ w (y - y')² + Σ w ‖h - R h'‖².

A turn keeps lengths, and two sides of a triangle differ by at most the third: ‖h - R h'‖ ≥ |‖h‖ - ‖h'‖|,
for each point and each R, so also for the best R. With r = ‖h‖ this gives

    D ≥ Σ w (y - y')² + Σ w (r - r')² = ‖f - f'‖²,    f = (√w y, √w r): 2kP numbers a window.

Neither y nor r changes when the window is turned or moved, so f is computed once for each window. An
orthonormal projection V makes no vector longer: ‖Vf - Vf'‖ ≤ ‖f - f'‖ ≤ √D. So windows whose projections are
farther apart than a threshold have √D above it, however few directions V has. The directions in which f
varies most (its principal components) leave the fewest pairs. This is the scheme of GEMINI [FRM94]: search
in few dimensions with a distance that is never too large, then measure what is left. Lower bounds by
envelopes do the same for time series that are stretched in time [Keo02].

Computers round, so `reach` is a little more than the threshold. Let u be the rounding of the cloud's numbers,
2⁻²⁴ in 32 bits and 2⁻⁵³ in 64, and S the largest size of a window (see `distance_grids`).

1. D is measured as S + S' - 2 (...). A sum of n products a b is off by at most
   n u Σ |a b| ≤ n u Σ (a² + b²)/2.
   There are P products and k frames one after the other, and fewer than 16 other steps, so D is off by at
   most (P + k + 16) u (S + S'), and so is the square of the bound that belongs to the measured D.
2. f and its projection are computed in 64 bits from the same rounded numbers. A sum of 2kP products, with
   ‖f‖ ≤ √S and the mean of f not longer, is off by at most 4kP · 2⁻⁵³ · √S in each of d directions, so
   by √d times that. Then it is rounded: u · 2 √S. Two windows have both errors twice.
3. The sum of d squares is off by (d + 4) u, relative to itself.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from mocap._shared.arrays import Array
from mocap.matching.distance_grids import Cloud, Floats

MOST = 96  # directions; more leave hardly fewer pairs
SAMPLE = 2000  # windows that decide on the directions: any orthonormal ones are right, these are good
AT_ONCE = 256  # windows whose f is held at a time


def window_numbers(cloud: Cloud, starts: NDArray[np.intp], weights: Array) -> Array:
    """Give f = (√w y, √w r) of windows: numbers that no planar transform changes.

    Parameters
    ----------
    cloud : of one clip or several.
    starts : shape (N,), the first frames of windows that do not run off a clip.
    weights : shape (P,), those of the cloud's points.

    Returns
    -------
    Shape (N, 2kP), metres: the distance of two rows is at most √D of their windows.

    Examples
    --------
    Two frames of one point at the height 1, 2 m apart: each is 1 m from the middle of the window.

    >>> from mocap.matching.distance_grids import cloud
    >>> walk = cloud(np.array([[[0.0, 1, 0]], [[0, 1, 2]]]), np.zeros(1), np.ones(1), 2, np.float64)
    >>> window_numbers(walk, np.array([0]), np.ones(1)) * np.sqrt(2)
    array([[1., 1., 1., 1.]])
    """
    frames, root = starts[:, None] + np.arange(cloud.window), np.sqrt(1 / cloud.window)
    heights = cloud.heights[frames] * root
    ground = cloud.ground[frames] * root + cloud.paths[starts][..., None] * np.sqrt(weights)
    return np.concatenate([heights, np.abs(ground)], axis=2).reshape(len(starts), -1).astype(float)


def principal_directions(numbers: Array, count: int = MOST) -> tuple[Array, Array]:
    """Find the directions in which rows of numbers vary most (principal component analysis).

    Parameters
    ----------
    numbers : shape (N, n), such as those of `window_numbers`.
    count : directions at most.

    Returns
    -------
    The mean of the rows, shape (n,), and d orthonormal directions, shape (n, d), of most variance first.

    Examples
    --------
    >>> principal_directions(np.array([[0.0, 0], [3, 4]]), 1)[1].round(6)[:, 0] ** 2
    array([0.36, 0.64])

    Notebook: 02c-most-pairs
    """
    mean = numbers.mean(0)
    size = numbers.shape[1]
    count = min(count, size)
    _, axes = eigh((numbers - mean).T @ (numbers - mean), subset_by_index=(size - count, size - 1))
    return mean, np.ascontiguousarray(axes[:, ::-1])


def sample_directions(cloud: Cloud, weights: Array) -> tuple[Array, Array]:
    """Find the principal directions of a sample of a cloud's windows, evenly spaced."""
    return principal_directions(window_numbers(cloud, evenly(whole_windows(cloud), SAMPLE), weights))


def projections(
    cloud: Cloud, starts: NDArray[np.intp], weights: Array, directions: tuple[Array, Array]
) -> Floats:
    """Project the f of windows, some at a time; in the cloud's precision, shape (N, d)."""
    mean, axes = directions
    parts = (starts[start : start + AT_ONCE] for start in range(0, len(starts), AT_ONCE))
    each = [(window_numbers(cloud, part, weights) - mean) @ axes for part in parts]
    return np.concatenate(each).astype(cloud.heights.dtype)


def whole_windows(cloud: Cloud) -> NDArray[np.intp]:
    """List the first frames of all windows that do not run off their clip."""
    return np.flatnonzero(np.isfinite(cloud.sizes))


def evenly(items: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Take at most so many items, evenly spaced.

    Examples
    --------
    >>> evenly(np.arange(10), 4)
    array([0, 3, 6, 9])
    """
    return items[:: max(1, -(-len(items) // count))]


def reach(cloud: Cloud, below: float) -> float:
    """Give the distance of projections up to which a pair of windows may be measured below a threshold.

    Parameters
    ----------
    cloud : all windows.
    below : metres.

    Returns
    -------
    Metres: `below` and the margin for rounding that is derived at the head of this module.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])
    >>> single, double = (cloud(stick, np.zeros(2), np.full(2, 0.5), 1, t) for t in ("f4", "f8"))
    >>> 0.04 < reach(double, 0.04) < 0.04 + 1e-12 < reach(single, 0.04) < 0.04 + 1e-4
    True
    """
    points, window = cloud.heights.shape[1], cloud.window
    unit = float(np.finfo(cloud.heights.dtype).eps) / 2
    size = float(cloud.sizes.max(where=np.isfinite(cloud.sizes), initial=0))
    measured = (points + window + 16) * unit * 2 * size  # 1., m²
    projected = 2 * (2 * unit + 4 * window * points * np.sqrt(MOST) * 2.0**-53) * np.sqrt(size)  # 2., m
    return float((np.sqrt(below**2 + measured) + projected) * (1 + (MOST + 4) * unit))  # 3.
