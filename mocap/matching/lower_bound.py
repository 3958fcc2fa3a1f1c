"""A tight lower bound of the distance between two windows, by which few pairs remain to be measured.

A window is described by two vectors, multiplied by the square roots of the weights: its heights y, and its
points g on the ground, complex numbers relative to the centroid of the window. A rotation by θ multiplies g
by exp(iθ). With r = ‖g‖, the distance of `distance_grids` is

    D = ‖y - y'‖² + r² + r'² - 2 |⟨g, g'⟩|.

*Bound.* The matrix G = g gᴴ / r is invariant to rotations. Its norm is ‖G‖ = r, and the inner product of two
is ⟨G, G'⟩ = |⟨g, g'⟩|² / (r r'). Let c = |⟨g, g'⟩| / (r r'). Because 2c ≤ 1 + c²,

    ½ ‖G - G'‖² + ½ (r - r')² = r² + r'² - r r' (1 + c²) ≤ r² + r'² - 2 r r' c.

Each window is thus embedded as a point f = (y, G / √2, r / √2) of a Euclidean space, with ‖f - f'‖² ≤ D.

*Tightness.* The two sides differ by r r' (1 - c)². If D ≤ ε², then 2 r r' (1 - c) ≤ ε², and they differ by at
most ε⁴ / (4 r r'): half a percent of ε² if ε is 4 cm and r is 30 cm.

*Dimension.* An orthogonal projection makes no vector longer and therefore preserves a lower bound. With
orthonormal columns U, the matrix Uᴴ G U = (Uᴴ g)(Uᴴ g)ᴴ / r depends only on Uᴴ g. The principal directions of
a sample of windows keep the bound large: first those of g and of y, then those of f. The search in few
dimensions with a lower bound, followed by exact distances of the remaining pairs, is the GEMINI method
[FRM94]. This bound is ours.

*Rounding.* `squared_reach` is an upper bound of the squared distance of two projections if D is computed as
less than ε². Let u be the rounding unit of the cloud, v = 2⁻²⁴ that of the projections, S the largest size of
a window, and R the length of the longest of the d-dimensional projections. The error of a sum of n products
a b is at most n u Σ |a b|.

1. D is computed by sums of P products and of k frames, and fewer than 16 other steps: (P + k + 16) u · 2 S.
2. f and its projection are computed in 64 bits from vectors that were rounded twice (2 u √S), and are then
   rounded themselves (v · 2 √S, because their mean is subtracted). For two windows: at most 8 max(u, v) √S.
3. The squared distance is |p|² + |p'|² - 2 p p', in 32 bits: (d + 4) v · 4 R².
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.matching.prepared_clouds import Cloud, window_vectors
from mocap.matching.tuned import TUNED

Singles = NDArray[np.float32]
Number = TypeVar("Number", np.float64, np.complex128)

TOGETHER = 256  # windows whose vectors are in memory at a time
TINY = 1e-300  # metres: avoids a division by 0 for a window of one point, whose r is 0


class Directions(NamedTuple):
    """Orthonormal directions on which windows are projected.

    ground : (k (P + 1), m), complex: U.
    heights, height_mean : (k P, n) and (k P,), of y and their mean.
    points, point_mean : (m² + 1 + n, d) and (m² + 1 + n,), of f in those directions and their mean.
    """

    ground: NDArray[np.complex128]
    heights: Array
    height_mean: Array
    points: Array
    point_mean: Array


def sample_windows(cloud: Cloud, count: int) -> Indices:
    """Return the first frames of about `count` evenly spaced windows, of all windows if there are fewer."""
    starts = np.flatnonzero(np.isfinite(cloud.sizes))
    return starts[:: max(1, -(-len(starts) // count))]


def principal_directions(vectors: NDArray[Number], count: int) -> NDArray[Number]:
    """Compute the first principal directions of vectors, about the origin, from their Gram matrix.

    Parameters
    ----------
    vectors : shape (N, n), real or complex.
    count : the largest number of directions. There are at most N and at most n.

    Returns
    -------
    Shape (n, count), orthonormal columns, in descending order of the singular values.

    Examples
    --------
    >>> principal_directions(np.array([[3.0, 4], [-3, -4], [-4, 3], [6, 8]]), 1).round(6)[:, 0] ** 2
    array([0.36, 0.64])
    """
    _, eigenvectors = np.linalg.eigh(vectors @ vectors.conj().T)  # ascending
    longest = eigenvectors[:, ::-1][:, : min(count, vectors.shape[1])]
    orthonormal, _ = np.linalg.qr(vectors.conj().T @ longest)
    return orthonormal


def sample_directions(cloud: Cloud) -> Directions:
    """Compute principal directions from a sample of the windows of a cloud."""
    ground, heights = _vectors(cloud, sample_windows(cloud, TUNED.bound_sample))
    height_mean = heights.mean(axis=0)
    ground_directions = principal_directions(ground, TUNED.ground_directions)
    height_directions = principal_directions(heights - height_mean, TUNED.height_directions)
    points = _points(ground, heights - height_mean, ground_directions, height_directions)
    point_mean = points.mean(axis=0)
    point_directions = principal_directions(points - point_mean, TUNED.directions)
    return Directions(ground_directions, height_directions, height_mean, point_directions, point_mean)


def projections(cloud: Cloud, starts: Indices, directions: Directions) -> Singles:
    """Project windows such that the distance of two projections is at most √D, up to rounding.

    Parameters
    ----------
    cloud : of one clip or several.
    starts : shape (N,), the first frames of windows that lie within a clip.
    directions : from `sample_directions`, for any cloud of the same number of points and frames in a window.

    Returns
    -------
    Shape (N, d), metres.

    Examples
    --------
    Two frames of two points. The second frame is 1 m higher, a distance of √D = 1 m:

    >>> from mocap.matching.prepared_clouds import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 2]], [[0, 1, 0], [2, 2, 0]]])
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> low, high = projections(ready, np.arange(2), sample_directions(ready))
    >>> float(np.linalg.norm(low - high).round(6))
    1.0
    """
    result = np.empty((len(starts), directions.points.shape[1]), np.float32)
    for first in range(0, len(starts), TOGETHER):
        part = slice(first, first + TOGETHER)
        ground, heights = _vectors(cloud, starts[part])
        heights -= directions.height_mean
        points = _points(ground, heights, directions.ground, directions.heights)
        result[part] = (points - directions.point_mean) @ directions.points
    return result


def _vectors(cloud: Cloud, starts: Indices) -> tuple[NDArray[np.complex128], Array]:
    """Return g and y of windows in 64 bits, shapes (N, k (P + 1)) and (N, k P)."""
    ground, heights = window_vectors(cloud, starts)
    count = len(starts)
    return ground.reshape(count, -1).astype(np.complex128), heights.reshape(count, -1).astype(np.float64)


def _points(
    ground: NDArray[np.complex128],
    heights: Array,
    ground_directions: NDArray[np.complex128],
    height_directions: Array,
) -> Array:
    """Return f in the directions of g and y: diagonal and upper half of the matrix G, r, and the heights."""
    radius = np.sqrt(np.vecdot(ground, ground).real)
    scaled = (ground @ ground_directions) / np.sqrt(np.maximum(radius, TINY))[:, None]
    rows, columns = np.triu_indices(ground_directions.shape[1], 1)
    diagonal = np.abs(scaled) ** 2 / np.sqrt(2)
    # The entries above the diagonal represent both halves: their factor is √2 / √2.
    upper = scaled[:, rows] * scaled[:, columns].conj()
    parts = [diagonal, upper.real, upper.imag, radius[:, None] / np.sqrt(2), heights @ height_directions]
    return np.concatenate(parts, axis=1)


def squared_length(projected: Singles) -> float:
    """Return the square of the longest projection, m²."""
    return float(np.vecdot(projected, projected).max(initial=0))


def squared_reach(cloud: Cloud, below: float, longest: float) -> float:
    """Return the largest squared distance that the projections of a pair below a threshold can have.

    Parameters
    ----------
    cloud : all windows.
    below : the threshold, metres.
    longest : R² of the projections, from `squared_length`.

    Returns
    -------
    Square metres: `below` squared plus the margin for rounding that is derived at the head of this module.

    Examples
    --------
    >>> from mocap.matching.prepared_clouds import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 2]], [[0, 1, 0], [2, 2, 0]]])
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> round(squared_reach(ready, 0.04, 1.0) ** 0.5, 4)
    0.0402
    """
    rounding = float(np.finfo(cloud.heights.dtype).eps) / 2
    single_rounding = float(np.finfo(np.float32).eps) / 2
    size = float(cloud.sizes.max(where=np.isfinite(cloud.sizes), initial=0))
    steps = cloud.heights.shape[1] + cloud.window + 16
    measured = below**2 + steps * rounding * 2 * size
    projected = np.sqrt(measured) + 8 * single_rounding * np.sqrt(size)
    return float(projected**2 + (TUNED.directions + 4) * single_rounding * 4 * longest)
