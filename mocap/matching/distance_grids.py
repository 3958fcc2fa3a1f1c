"""The point cloud distance between all windows of two clips, at the speed of matrix products.

A point on the ground is the complex number g = z + ix: to turn it about +y by θ is to multiply it by
exp(iθ). When g is measured from the centroid of its window, and the weights add up to one, the best turn
of Eq. 1 of [KGP02] brings Σ w g ḡ' to the real axis, and leaves the distance

    D = S + S' - 2 Σ w y y' - 2 |Σ w g ḡ'|,    S = Σ w (y² + |g|²).

Both sums run over the k frames of a window and the P points of a frame. For all pairs of windows at once:

1. The sums over points, for all pairs of *frames*, are two matrix products.
2. The sums over frames run along the diagonals of these products: [i, j] + [i + 1, j + 1] + ... Sums over
   k/2 frames make sums over k, so it takes not k additions but about log₂ k.
3. Step 1 works on frames and cannot know a window's centroid, so it measures g from the *frame's* centroid
   c. This leaves out how c moves within the window, Σ (c - mean of c) · (the same of b)‾: a third matrix
   product, this time of windows.

No step adds up numbers larger than a body and its path within a window. So the errors do not depend on where
a clip is or how far it goes, and 32 bits are enough.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud, require_near, unit_weights

Floats = NDArray[np.floating[Any]]

TILE = 256, 640  # rows and columns worked on at a time: few enough to stay in a core's cache

# m²: distances D that differ by less are equal, but for rounding, which is some 1e-14 m² for a body that
# walks. Windows that are alike have a D of 1e-4 to 1e-2 m². A D below this one is 0: its root, less than a
# micrometre, would be rounding alone, made larger.
EQUAL = 1e-12


class Cloud(NamedTuple):
    """A clip ready for matching; its arrays are already multiplied by square roots of the weights.

    heights : (F, P), each above the mean height of the same point.
    ground : (F, P), complex; z + ix from the frame's centroid.
    paths : (F, k), complex; the frames' centroids in the window that starts at a frame, from their mean.
    sizes : (F,), S of that window; infinite where it would run off the clip's end.
    centres : (F,), complex, 128 bits; the centroid of that window.
    """

    heights: Floats
    ground: NDArray[np.complexfloating[Any, Any]]
    paths: NDArray[np.complexfloating[Any, Any]]
    sizes: Floats
    centres: NDArray[np.complex128]

    @property
    def window(self) -> int:
        """The frames k of a window."""
        return int(self.paths.shape[1])

    def part(self, windows: slice) -> "Cloud":
        """Take the windows that start at these frames, with all frames that they cover."""
        frames = slice(windows.start, windows.stop + self.window - 1)
        heights = self.heights[frames]
        ground = self.ground[frames]
        return Cloud(heights, ground, self.paths[windows], self.sizes[windows], self.centres[windows])


def cloud(points: Array, level: Array, weights: Array, window: int, dtype: type[np.floating[Any]]) -> Cloud:
    """Prepare a clip for matching.

    Parameters
    ----------
    points : shape (F, P, 3), metres.
    level : shape (P,), metres: heights to measure from, the same for all clips to be compared.
    weights : shape (P,), of the points; they add up to one.
    window : frames of a window, which count alike.
    dtype : the precision of the result; the work is done in 64 bits.
    """
    root_weights = np.sqrt(weights)
    frame_weights = np.full(window, 1 / window)
    heights = (points[..., 1] - level) * root_weights
    ground = on_ground(points)
    centroids = ground @ weights  # (F,)
    ground = (ground - centroids[:, None]) * root_weights
    frame_sizes = (heights**2).sum(1) + (np.abs(ground) ** 2).sum(1)

    paths = sliding_window_view(centroids, window)  # (F - k + 1, k)
    centres = paths @ frame_weights
    paths = (paths - centres[:, None]) * np.sqrt(frame_weights)
    path_sizes = (np.abs(paths) ** 2).sum(1)
    sizes = sliding_window_view(frame_sizes, window) @ frame_weights + path_sizes

    cut_off = (0, window - 1)  # windows that would run off the clip's end
    paths = np.pad(paths, (cut_off, (0, 0)))
    sizes = np.pad(sizes, cut_off, constant_values=np.inf)
    centres = np.pad(centres, cut_off)
    complex_dtype = np.result_type(dtype, np.complex64)
    return Cloud(
        heights.astype(dtype),
        ground.astype(complex_dtype),
        paths.astype(complex_dtype),
        sizes.astype(dtype),
        centres,
    )


def cloud_distances(a: Cloud, b: Cloud) -> Floats:
    """Measure D between all windows of two clouds, by the three steps at the head of this module.

    Parameters
    ----------
    a, b : `Cloud.part`s of n and m windows.

    Returns
    -------
    Shape (n, m), m², never negative; infinite where a window runs off its clip.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> cloud_distances(ready, ready).round(6)
    array([[0. , 0.5],
           [0.5, 0. ]])
    """
    frame_weight = a.heights.dtype.type(1 / a.window)
    ground = diagonal_sum(a.ground @ b.ground.conj().T, a.window) * frame_weight
    ground += a.paths @ b.paths.conj().T
    grid: Floats = np.abs(ground)
    grid += diagonal_sum(a.heights @ b.heights.T, a.window) * frame_weight
    grid *= -2
    grid += a.sizes[:, None]
    grid += b.sizes
    return np.asarray(np.maximum(grid, 0, out=grid))


def diagonal_sum(products: NDArray[Any], window: int) -> NDArray[Any]:
    """Add up products[i + f, j + f] over the frames f < window, from sums over half as many frames.

    Examples
    --------
    >>> diagonal_sum(np.array([[1, 2, 0], [0, 3, 4], [0, 0, 5]]), 2)
    array([[4, 6],
           [0, 8]])
    """
    if window == 1:
        return products
    half = window // 2
    sums = diagonal_sum(products, half)
    sums = sums[:-half, :-half] + sums[half:, half:]  # over 2 · half frames
    if window % 2:
        sums = sums[:-1, :-1] + products[window - 1 :, window - 1 :]
    return np.asarray(sums)


def distance_grid(
    a: Motion | ArrayLike, b: Motion | ArrayLike, *, window: int, joint_weights: ArrayLike | None = None
) -> Floats:
    """Measure the point cloud distance between all windows of two clips [KGP02, Eq. 1], [KGP02, 3.1].

    D = min over T of Σ w ‖p - T p'‖², by the closed form at the head of this module. Entry [i, j] lays
    the frames j ... j + k - 1 of b on the frames i ... i + k - 1 of a: it is the paper's
    D(A_i, B_{j + k - 1}). The weights add up to one, so √D is the RMS distance of the points, in metres.

    Parameters
    ----------
    a, b : motions, or their points of shape (F, P, 3), metres. Two arrays of 32-bit points are compared in
        32 bits, twice as fast; everything else in 64.
    window : frames k in a window.
    joint_weights : shape (P,), not negative, one for each point in the order of `distinct_joints`; equal ones
        by default. The frames of a window count alike; the paper lets them taper off as well.

    Returns
    -------
    D, shape (F_a - k + 1, F_b - k + 1), m². Never negative, 0 in 64 bits where it is below 1e-12 m², and
    exactly symmetric where a and b are the same points. Otherwise the error is below 4e-6 · (S + S') in 32
    bits and 1e-14 · (S + S') in 64, with S as at the head of this module and y from the ground. Far from the
    origin the points themselves have fewer digits: this adds 1e-15 · √(S + S') times that distance. On real
    walks the error in 32 bits is at most 4e-7 m²: 7 µm where √D is 3 cm.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window, points
        that are not finite or do not match, and weights that are negative, all 0 or of the wrong shape.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> distance_grid(stick, stick + [5, 0, 3], window=1)
    array([[0. , 0.5],
           [0.5, 0. ]])

    Notebook: 02-matching
    """
    if isinstance(a, Motion) and isinstance(b, Motion):
        a, b = require_alike([a, b])
    points_a = _checked_points(a, window)
    points_b = _checked_points(b, window)
    count = points_a.shape[1]
    if count != points_b.shape[1]:
        raise MocapError(f"Clouds of {count} and {points_b.shape[1]} points do not match.")
    weights = unit_weights(joint_weights, count)
    dtype = np.result_type(points_a, points_b).type
    level = (points_a[..., 1].mean(0, float) + points_b[..., 1].mean(0, float)) / 2

    def whole_windows(points: Floats) -> Cloud:
        prepared = cloud(points.astype(float), level, weights, window, dtype)
        return prepared.part(slice(len(points) - window + 1))

    is_symmetric = np.array_equal(points_a, points_b)
    grid = tiled_distances(whole_windows(points_a), whole_windows(points_b), upper=is_symmetric)
    if dtype == np.float64:
        grid[grid < EQUAL] = 0.0
    if is_symmetric:
        return np.triu(grid) + np.triu(grid, 1).T
    return grid


def _checked_points(clip: Motion | ArrayLike, window: int) -> Floats:
    """Return the points of a clip, shape (F, P, 3), in 32 or 64 bits; raise unless they can be compared."""
    if isinstance(clip, Motion):
        name = f"'{clip.name}'"
        points: NDArray[Any] = point_cloud(clip)
    else:
        name = "the clip"
        points = np.asarray(clip)
    if points.dtype not in (np.float32, np.float64):
        points = points.astype(float)
    if points.ndim != 3 or points.shape[1] == 0 or points.shape[2] != 3:
        raise MocapError(f"Points need the shape (F, P, 3), got {points.shape}.")
    check_window(window, len(points), name)
    require_near(points, name)
    return points


def tiled_distances(a: Cloud, b: Cloud, *, upper: bool = False) -> Floats:
    """Measure D between all windows of two clouds, by tiles; with `upper`, those below the diagonal are inf.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> np.array_equal(tiled_distances(ready, ready), cloud_distances(ready, ready))
    True
    """
    rows = len(a.sizes)
    columns = len(b.sizes)
    tile_rows, tile_columns = TILE
    grid = np.full((rows, columns), np.inf, a.heights.dtype)
    for row in range(0, rows, tile_rows):
        part_of_a = slice(row, min(row + tile_rows, rows))
        for column in range(row if upper else 0, columns, tile_columns):
            part_of_b = slice(column, min(column + tile_columns, columns))
            grid[part_of_a, part_of_b] = cloud_distances(a.part(part_of_a), b.part(part_of_b))
    return grid


def check_window(window: int, frames: int, name: str) -> None:
    """Raise unless a clip of this many frames holds at least one window."""
    if not isinstance(window, int | np.integer) or window < 1:
        raise MocapError(f"A window needs a whole number of frames, at least one frame, got {window}.")
    if frames < window:
        raise MocapError(f"{name} has {frames} frames, too few for a window of {window}.")


def require_windows(clips: Sequence[Motion], window: int) -> tuple[Motion, ...]:
    """Raise unless clips go together, as by `require_alike`, and each holds at least one window."""
    alike = require_alike(clips)
    for clip in alike:
        check_window(window, len(clip), f"'{clip.name}'")
    return alike
