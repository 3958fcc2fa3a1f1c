"""A lower bound of the distance between two windows, so tight that few pairs need to be measured.

A window is two vectors, multiplied by the roots of the weights: its heights y, and its points g on the
ground, complex numbers from the window's centroid. A rotation by θ multiplies g by exp(iθ). With r = ‖g‖, the
distance of `distance_grids` is

    D = ‖y - y'‖² + r² + r'² - 2 |⟨g, g'⟩|.

*The bound.* No rotation changes the matrix G = g gᴴ / r. Its norm is ‖G‖ = r, and the product of two is
⟨G, G'⟩ = |⟨g, g'⟩|² / (r r'). Let c = |⟨g, g'⟩| / (r r'). Because 2c ≤ 1 + c²,

    ½ ‖G - G'‖² + ½ (r - r')² = r² + r'² - r r' (1 + c²) ≤ r² + r'² - 2 r r' c.

Each window thus becomes one point f = (y, G / √2, r / √2) of a Euclidean space, with ‖f - f'‖² ≤ D.

*It is tight.* The two sides differ by r r' (1 - c)². If D ≤ ε², then 2 r r' (1 - c) ≤ ε², and they differ by
at most ε⁴ / (4 r r'): half a percent of ε² if ε is 4 cm and r is 30 cm.

*Few numbers.* An orthonormal projection makes no vector longer, so it leaves a lower bound. With orthonormal
columns U, the matrix Uᴴ G U = (Uᴴ g)(Uᴴ g)ᴴ / r needs only Uᴴ g. Principal directions of a sample of windows
make the bound large: first those of g and of y, then of f. To search in few dimensions with a distance that
is never too large, and to measure what remains, is the scheme of GEMINI [FRM94]. This bound is ours.

*Rounding.* `squared_reach` is what the squared distance of two projections can be if D is measured below ε².
Let u be the rounding of the cloud's numbers, v = 2⁻²⁴ that of the projections, S the largest size of a
window, R the length of the longest of the d-dimensional projections. A sum of n products a b is off by at
most n u Σ |a b|.

1. D is measured by sums of P products and of k frames, and fewer than 16 other steps: (P + k + 16) u · 2 S.
2. f and its projection are computed in 64 bits from vectors that are rounded twice (2 u √S), and then rounded
   themselves (v · 2 √S, because their mean is subtracted). Two windows: at most 8 max(u, v) √S.
3. The squared distance is |p|² + |p'|² - 2 p p', in 32 bits: (d + 4) v · 4 R².
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.matching.distance_grids import Cloud, window_vectors
from mocap.matching.tuned import TUNED

Singles = NDArray[np.float32]
Number = TypeVar("Number", np.float64, np.complex128)

TOGETHER = 256  # windows whose vectors are held at a time
TINY = 1e-300  # metres: keeps a window of one point, with r = 0, from a division by 0


class Directions(NamedTuple):
    """Orthonormal directions that windows are projected on.

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
    """Return the first frames of about this many windows, evenly spaced, and of all if there are fewer."""
    starts = np.flatnonzero(np.isfinite(cloud.sizes))
    return starts[:: max(1, -(-len(starts) // count))]


def principal_directions(vectors: NDArray[Number], count: int) -> NDArray[Number]:
    """Return the orthonormal directions in which vectors are longest, from their products with each other.

    Parameters
    ----------
    vectors : shape (N, n), real or complex.
    count : directions at most; there are no more than vectors or their numbers.

    Returns
    -------
    Shape (n, count), orthonormal columns, the longest first.

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
    """Choose good directions by a sample of the cloud's windows."""
    ground, heights = _vectors(cloud, sample_windows(cloud, TUNED.bound_sample))
    height_mean = heights.mean(axis=0)
    ground_directions = principal_directions(ground, TUNED.ground_directions)
    height_directions = principal_directions(heights - height_mean, TUNED.height_directions)
    points = _points(ground, heights - height_mean, ground_directions, height_directions)
    point_mean = points.mean(axis=0)
    point_directions = principal_directions(points - point_mean, TUNED.directions)
    return Directions(ground_directions, height_directions, height_mean, point_directions, point_mean)


def projections(cloud: Cloud, starts: Indices, directions: Directions) -> Singles:
    """Project windows: the distance of two projections is at most √D, but for rounding.

    Parameters
    ----------
    cloud : of one clip or several.
    starts : shape (N,), the first frames of windows that do not run off a clip.
    directions : as by `sample_directions`, of any cloud with as many points and frames in a window.

    Returns
    -------
    Shape (N, d), metres.

    Examples
    --------
    Two frames of two points; the second frame stands 1 m higher, which is a distance of √D = 1 m.

    >>> from mocap.matching.distance_grids import cloud
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
    # Each entry above the diagonal stands for two, so its square counts twice: √2 / √2.
    upper = scaled[:, rows] * scaled[:, columns].conj()
    parts = [diagonal, upper.real, upper.imag, radius[:, None] / np.sqrt(2), heights @ height_directions]
    return np.concatenate(parts, axis=1)


def squared_length(places: Singles) -> float:
    """Return the square of the longest projection, m²."""
    return float(np.vecdot(places, places).max(initial=0))


def squared_reach(cloud: Cloud, below: float, longest: float) -> float:
    """Return the squared distance of two projections up to which a pair may be measured below a threshold.

    Parameters
    ----------
    cloud : all windows.
    below : metres.
    longest : R² of the projections, as by `squared_length`.

    Returns
    -------
    Square metres: `below` squared, and the margin for rounding that is derived at the head of this module.

    Examples
    --------
    >>> from mocap.matching.distance_grids import cloud
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 2]], [[0, 1, 0], [2, 2, 0]]])
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> 0.04**2 < squared_reach(ready, 0.04, 1.0) < 0.041**2
    True
    """
    rounding = float(np.finfo(cloud.heights.dtype).eps) / 2
    single_rounding = float(np.finfo(np.float32).eps) / 2
    size = float(cloud.sizes.max(where=np.isfinite(cloud.sizes), initial=0))
    steps = cloud.heights.shape[1] + cloud.window + 16
    measured = below**2 + steps * rounding * 2 * size
    projected = np.sqrt(measured) + 8 * single_rounding * np.sqrt(size)
    return float(projected**2 + (TUNED.directions + 4) * single_rounding * 4 * longest)
