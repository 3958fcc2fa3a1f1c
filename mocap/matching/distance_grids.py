"""The point cloud distance between all windows of two clips, by matrix products.

A point on the ground is the complex number g = z + ix, and a rotation about +y by θ multiplies it by exp(iθ).
If g is measured from the centroid of its window, and the weights sum to one, the optimal rotation of Eq. 1 of
[KGP02] makes Σ w g ḡ' real and positive. The remaining distance is

    D = S + S' - 2 Σ w y y' - 2 |Σ w g ḡ'|,    S = Σ w (y² + |g|²).

The sums run over the k frames of a window and the P points of a frame. For all pairs of windows at once:

1. Two matrix products compute the sums over points, for all pairs of *frames*.
2. The sums over frames run along the diagonals of these products: [i, j] + [i + 1, j + 1] + ... A sum over k
   frames consists of two sums over k/2 frames, which takes about log₂ k additions instead of k.
3. Step 1 works on frames, and therefore measures g from the centroid c of the *frame*, not of the window. A
   third matrix product, of windows, adds the variation of c: Σ (c - mean of c) · (the same of b)‾.

No summand is larger than a body and its path within a window. Rounding errors therefore do not depend on the
position of a clip or the length of its path, and 32 bits are sufficient.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import as_strided, sliding_window_view
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import one_blas_thread, run_in_order, thread_count
from mocap.body.motion import Motion, require_compatible
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud, require_near, unit_weights
from mocap.matching.tuned import TUNED

Floats = NDArray[np.floating[Any]]


# m²: the tolerance for equal distances D. Rounding is about 1e-14 m² for a walking body, and similar windows
# have a D of 1e-4 to 1e-2 m². A smaller D is set to 0, because the root would amplify its rounding error.
EQUAL = 1e-12


class Cloud(NamedTuple):
    """The point clouds of a clip, prepared for matching: multiplied by the square roots of the weights.

    The last four fields describe the window that starts at a frame.

    heights : (F, P), relative to the mean height of each point.
    ground : (F, P), complex, z + ix relative to the centroid of the frame.
    paths : (F, k), complex, the centroids of the frames of a window, relative to their mean.
    sizes : (F,), S of a window, infinite if it extends beyond the end of the clip.
    centres : (F,), complex, 128 bits, the centroid of a window.
    frame_weights : (k,), weights of the frames in a window, with sum one.
    """

    heights: Floats
    ground: NDArray[np.complexfloating[Any, Any]]
    paths: NDArray[np.complexfloating[Any, Any]]
    sizes: Floats
    centres: NDArray[np.complex128]
    frame_weights: Array

    @property
    def window(self) -> int:
        """The number k of frames in a window."""
        return len(self.frame_weights)

    def part(self, windows: slice) -> "Cloud":
        """Select the windows that start at these frames, with all frames that they cover."""
        frames = slice(windows.start, windows.stop + self.window - 1)
        heights = self.heights[frames]
        ground = self.ground[frames]
        paths = self.paths[windows]
        return Cloud(heights, ground, paths, self.sizes[windows], self.centres[windows], self.frame_weights)


def cloud(  # noqa: PLR0913 (the points, their level, and their weights)
    points: Array,
    level: Array,
    weights: Array,
    window: int,
    dtype: type[np.floating[Any]],
    *,
    taper: ArrayLike | None = None,
) -> Cloud:
    """Prepare a clip for matching.

    Parameters
    ----------
    points : shape (F, P, 3), metres.
    level : shape (P,), metres: reference heights, the same for all clips to be compared.
    weights : shape (P,), of the points, with sum one.
    window : the number k of frames in a window.
    dtype : the precision of the result. The computation is in 64 bits.
    taper : shape (k,), weights of the frames in a window, of any scale, by default equal ones.

    Raises
    ------
    MocapError : for a taper that is not of the window's length, negative, or all 0.
    """
    root_weights = np.sqrt(weights)
    frame_weights = unit_weights(taper, window)
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

    cut_off = (0, window - 1)  # windows that extend beyond the end of the clip
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
        frame_weights,
    )


def join(clouds: Sequence[Cloud]) -> Cloud:
    """Concatenate clouds of the same window."""
    heights = np.concatenate([part.heights for part in clouds])
    ground = np.concatenate([part.ground for part in clouds])
    paths = np.concatenate([part.paths for part in clouds])
    sizes = np.concatenate([part.sizes for part in clouds])
    centres = np.concatenate([part.centres for part in clouds])
    return Cloud(heights, ground, paths, sizes, centres, clouds[0].frame_weights)


def window_vectors(
    cloud: Cloud, starts: NDArray[np.intp]
) -> tuple[NDArray[np.complexfloating[Any, Any]], Floats]:
    """Return whole windows as vectors, multiplied by the square roots of all weights.

    Parameters
    ----------
    cloud : the clip or clips.
    starts : shape (N,), the first frames of the windows.

    Returns
    -------
    The points on the ground and the centroids of the frames, complex, shape (N, k, P + 1), and the heights,
    shape (N, k, P). The sum of their squares is S.
    """
    frames = starts[:, None] + np.arange(cloud.window)
    root_weights = np.sqrt(cloud.frame_weights).astype(cloud.heights.dtype)[:, None]
    centroids = cloud.paths[starts][..., None]
    ground = np.concatenate([cloud.ground[frames] * root_weights, centroids], axis=2)
    return ground, cloud.heights[frames] * root_weights


def cloud_distances(a: Cloud, b: Cloud, *, zero_below: float = 0.0) -> Floats:
    """Compute D between all windows of two clouds, by the three steps at the head of this module.

    Parameters
    ----------
    a, b : `Cloud.part`s of n and m windows.
    zero_below : a D below this is 0, m².

    Returns
    -------
    Shape (n, m), m²; infinite if a window extends beyond its clip.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> cloud_distances(ready, ready).round(6)
    array([[0. , 0.5],
           [0.5, 0. ]])
    """
    # Constant factors are applied before the products, because these arrays are smaller than the grid.
    ground = frame_sums(2 * a.ground, b.ground.conj(), a.frame_weights)
    ground += (2 * a.paths) @ b.paths.conj().T
    grid: Floats = frame_sums(-2 * a.heights, b.heights, a.frame_weights)
    grid += a.sizes[:, None]
    grid += b.sizes
    grid -= np.abs(ground)
    if grid.min(initial=np.inf) < zero_below:  # rare, and the test is faster than the assignment
        grid[grid < zero_below] = 0.0
    return grid


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


def distance_grid(  # noqa: PLR0913 (two clips, a window, weights, and threads)
    a: Motion | ArrayLike,
    b: Motion | ArrayLike,
    *,
    window: int,
    joint_weights: ArrayLike | None = None,
    taper: ArrayLike | None = None,
    jobs: int | None = None,
) -> Floats:
    """Compute the point cloud distances between all windows of two clips [KGP02, Eq. 1], [KGP02, 3.1].

    D = min over T of Σ w ‖p - T p'‖², by the closed form at the head of this module. Entry [i, j] compares
    the frames i ... i + k - 1 of a with the frames j ... j + k - 1 of b: it is the paper's
    D(A_i, B_{j + k - 1}). The weights sum to one, therefore √D is the RMS distance of the points in metres.

    Parameters
    ----------
    a, b : motions, or their points of shape (F, P, 3), metres. Two arrays of 32-bit points are compared in
        32 bits, twice as fast, and all others in 64 bits.
    window : the number k of frames in a window.
    joint_weights : shape (P,), not negative, one for each point in the order of `distinct_joints`, by default
        equal ones.
    taper : shape (k,), not negative: the weights w_i of the frames in a window, which may taper off towards
        its ends, by default equal ones. Unequal weights take longer for long windows.
    jobs : the number of threads, by default one for each core that the process may use. The result does not
        depend on it. Small grids are computed without threads.

    Returns
    -------
    D, shape (F_a - k + 1, F_b - k + 1), m². It is not negative, and exactly symmetric if a and b are the same
    points. In 64 bits, values below 1e-12 m² are 0. The error is below 4e-6 · (S + S') in 32 bits and
    1e-14 · (S + S') in 64, with S as at the head of this module and y from the ground. At a distance from the
    origin the points themselves are less precise, which adds 1e-15 · √(S + S') times that distance. On real
    walks the error in 32 bits is at most 4e-7 m², which is 7 µm if √D is 3 cm.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window, points
        that are not finite or do not match, weights that are negative, all 0 or of the wrong shape, and jobs
        that are not at least 1.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> distance_grid(stick, stick + [5, 0, 3], window=1)
    array([[0. , 0.5],
           [0.5, 0. ]])

    Notebook: 02-matching
    """
    if isinstance(a, Motion) and isinstance(b, Motion):
        a, b = require_compatible([a, b])
    thread_count(jobs)
    windows_a, windows_b = prepared_windows(a, b, window=window, joint_weights=joint_weights, taper=taper)
    zero_below = EQUAL if windows_a.heights.dtype == np.float64 else 0.0
    mirror = windows_b is windows_a
    return tiled_distances(windows_a, windows_b, mirror=mirror, zero_below=zero_below, jobs=jobs)


def prepared_windows(
    a: Motion | ArrayLike,
    b: Motion | ArrayLike,
    *,
    window: int,
    joint_weights: ArrayLike | None = None,
    taper: ArrayLike | None = None,
) -> tuple[Cloud, Cloud]:
    """Prepare all whole windows of two clips for `cloud_distances`; see `distance_grid` for the arguments.

    Clips of the same points are prepared once: the second cloud then *is* the first.
    """
    points_a = _checked_points(a, window)
    points_b = _checked_points(b, window)
    count = points_a.shape[1]
    if count != points_b.shape[1]:
        raise MocapError(f"Clouds of {count} and {points_b.shape[1]} points do not match.")
    weights = unit_weights(joint_weights, count)
    dtype = np.result_type(points_a, points_b).type
    level = (points_a[..., 1].mean(0, float) + points_b[..., 1].mean(0, float)) / 2

    def whole_windows(points: Floats) -> Cloud:
        prepared = cloud(points.astype(float), level, weights, window, dtype, taper=taper)
        return prepared.part(slice(len(points) - window + 1))

    windows_a = whole_windows(points_a)
    return windows_a, windows_a if np.array_equal(points_a, points_b) else whole_windows(points_b)


def _checked_points(clip: Motion | ArrayLike, window: int) -> Floats:
    """Return the points of a clip, shape (F, P, 3), in 32 or 64 bits. Raise unless they can be compared."""
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


def tiled_distances(  # noqa: PLR0913 (two clouds, the parts to compute, and threads)
    a: Cloud,
    b: Cloud,
    *,
    upper: bool = False,
    mirror: bool = False,
    zero_below: float = 0.0,
    jobs: int | None = 1,
) -> Floats:
    """Compute D between all windows of two clouds, tile by tile.

    Parameters
    ----------
    a, b : `Cloud.part`s of n and m windows.
    upper : skip the tiles below the diagonal, and fill them with infinity.
    mirror : compute the entries above the diagonal, and mirror them, for two clouds of the same points.
    zero_below : a D below this is 0, m².
    jobs : threads, as for `distance_grid`.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> tiled_distances(ready, ready).round(6)
    array([[0. , 0.5],
           [0.5, 0. ]])
    """
    rows = len(a.sizes)
    columns = len(b.sizes)
    tile_rows, tile_columns = TUNED.tile
    grid = np.empty((rows, columns), a.heights.dtype)

    def measure_row_of_tiles(row: int) -> None:
        part_of_a = slice(row, min(row + tile_rows, rows))
        for column in range(row if upper or mirror else 0, columns, tile_columns):
            part_of_b = slice(column, min(column + tile_columns, columns))
            distances = cloud_distances(a.part(part_of_a), b.part(part_of_b), zero_below=zero_below)
            grid[part_of_a, part_of_b] = distances
        if upper:
            grid[part_of_a, :row] = np.inf
        if mirror:
            _mirror(grid, part_of_a)

    tasks = [(row,) for row in range(0, rows, tile_rows)]
    threads = thread_count(jobs) if rows * columns > TUNED.small_grid else 1
    with one_blas_thread():
        for _ in run_in_order(measure_row_of_tiles, tasks, None, threads):
            pass
    return grid


def _mirror(grid: Floats, block: slice) -> None:
    """Copy the entries above the diagonal in a block of rows to their places below it."""
    later = slice(block.stop, None)
    grid[later, block] = grid[block, later].T
    corner = grid[block, block]
    below_diagonal = np.tril_indices(len(corner), -1)
    corner[below_diagonal] = corner.T[below_diagonal]


def check_window(window: int, frames: int, name: str) -> None:
    """Raise unless a clip with this number of frames has at least one window."""
    if not isinstance(window, int | np.integer) or window < 1:
        raise MocapError(f"A window needs a whole number of frames, at least one frame, got {window}.")
    if frames < window:
        raise MocapError(f"{name} has {frames} frames, too few for a window of {window}.")


def require_windows(clips: Sequence[Motion], window: int) -> tuple[Motion, ...]:
    """Return clips on one skeleton, as by `require_compatible`; raise if one is shorter than a window."""
    alike = require_compatible(clips)
    for clip in alike:
        check_window(window, len(clip), f"'{clip.name}'")
    return alike
