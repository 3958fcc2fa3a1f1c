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
from numpy.lib.stride_tricks import as_strided, sliding_window_view
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import one_blas_thread, run_in_order, thread_count
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud, require_near, unit_weights
from mocap.matching.tuned import TUNED

Floats = NDArray[np.floating[Any]]


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
    frame_weights : (k,), of the frames within a window; they add up to one.
    """

    heights: Floats
    ground: NDArray[np.complexfloating[Any, Any]]
    paths: NDArray[np.complexfloating[Any, Any]]
    sizes: Floats
    centres: NDArray[np.complex128]
    frame_weights: Array

    @property
    def window(self) -> int:
        """The frames k of a window."""
        return len(self.frame_weights)

    def part(self, windows: slice) -> "Cloud":
        """Take the windows that start at these frames, with all frames that they cover."""
        frames = slice(windows.start, windows.stop + self.window - 1)
        heights = self.heights[frames]
        ground = self.ground[frames]
        paths = self.paths[windows]
        return Cloud(heights, ground, paths, self.sizes[windows], self.centres[windows], self.frame_weights)


def cloud(  # noqa: PLR0913 (the points, what they are measured from, and what each counts)
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
    level : shape (P,), metres: heights to measure from, the same for all clips to be compared.
    weights : shape (P,), of the points; they add up to one.
    window : frames k of a window.
    dtype : the precision of the result; the work is done in 64 bits.
    taper : shape (k,), weights of the frames in a window, of any scale; equal ones by default.

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
        frame_weights,
    )


def join(clouds: Sequence[Cloud]) -> Cloud:
    """Put clouds of the same window one after the other."""
    heights = np.concatenate([part.heights for part in clouds])
    ground = np.concatenate([part.ground for part in clouds])
    paths = np.concatenate([part.paths for part in clouds])
    sizes = np.concatenate([part.sizes for part in clouds])
    centres = np.concatenate([part.centres for part in clouds])
    return Cloud(heights, ground, paths, sizes, centres, clouds[0].frame_weights)


def window_vectors(
    cloud: Cloud, starts: NDArray[np.intp]
) -> tuple[NDArray[np.complexfloating[Any, Any]], Floats]:
    """Return whole windows as vectors, multiplied by the roots of all weights.

    Parameters
    ----------
    cloud : the clip or clips.
    starts : shape (N,), the first frames of the windows.

    Returns
    -------
    The points on the ground and their frames' centroids, complex, shape (N, k, P + 1), and the heights,
    shape (N, k, P). Their squares add up to S.
    """
    frames = starts[:, None] + np.arange(cloud.window)
    root_weights = np.sqrt(cloud.frame_weights).astype(cloud.heights.dtype)[:, None]
    centroids = cloud.paths[starts][..., None]
    ground = np.concatenate([cloud.ground[frames] * root_weights, centroids], axis=2)
    return ground, cloud.heights[frames] * root_weights


def cloud_distances(a: Cloud, b: Cloud, *, zero_below: float = 0.0) -> Floats:
    """Measure D between all windows of two clouds, by the three steps at the head of this module.

    Parameters
    ----------
    a, b : `Cloud.part`s of n and m windows.
    zero_below : a D below this is 0, m².

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
    # Factors are applied before the products, to arrays that are smaller than the grid.
    ground = frame_sums(2 * a.ground, b.ground.conj(), a.frame_weights)
    ground += (2 * a.paths) @ b.paths.conj().T
    grid: Floats = frame_sums(-2 * a.heights, b.heights, a.frame_weights)
    grid += a.sizes[:, None]
    grid += b.sizes
    grid -= np.abs(ground)
    if grid.min(initial=np.inf) < zero_below:  # which is rare, and quicker to see than to mend
        grid[grid < zero_below] = 0.0
    return grid


def frame_sums(a: NDArray[Any], b: NDArray[Any], weights: Array) -> NDArray[Any]:
    """Add up weights[f] · (a[i + f] · b[j + f]) over the frames f, for all pairs of windows i and j.

    Equal weights take about log₂ k additions for each pair, others k.

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
    """Add up products[i + f, j + f] over the frames f < window, from sums over half as many frames.

    Examples
    --------
    >>> diagonal_sum(np.array([[1, 2, 0], [0, 3, 4], [0, 0, 5]]), 2)
    array([[4, 6],
           [0, 8]])
    """
    rows, columns = products.shape
    row_by_row = products.ravel()
    next_on_diagonal = columns + 1  # entries further: one row down and one column to the right
    sums = _strided_sum(row_by_row, window, next_on_diagonal)
    # The sums at the end of a row, which run on into the next row, are left out.
    shape = (rows - window + 1, columns - window + 1)
    return np.asarray(as_strided(sums, shape, (columns * sums.itemsize, sums.itemsize)))


def _strided_sum(values: NDArray[Any], count: int, step: int) -> NDArray[Any]:
    """Add up values[n], values[n + step], ... `count` of them, for all n; in a new array if count > 1."""
    if count == 1:
        return values
    half = count // 2
    sums = _strided_sum(values, half, step)
    sums = sums[: -half * step] + sums[half * step :]  # of 2 · half values
    if count % 2:
        sums = sums[:-step]
        sums += values[(count - 1) * step :]
    return np.asarray(sums)


def distance_grid(  # noqa: PLR0913 (what to compare, what each point and frame counts, and where to work)
    a: Motion | ArrayLike,
    b: Motion | ArrayLike,
    *,
    window: int,
    joint_weights: ArrayLike | None = None,
    taper: ArrayLike | None = None,
    jobs: int | None = None,
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
        by default.
    taper : shape (k,), not negative, weights of the frames in a window, as the w_i of the paper, which may
        taper off towards its ends; equal ones by default. Others take longer for long windows.
    jobs : threads; by default one for each core that the process may use. The result is the same, bit for
        bit. A grid of few tiles needs no threads.

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
        a, b = require_alike([a, b])
    points_a = _checked_points(a, window)
    points_b = _checked_points(b, window)
    thread_count(jobs)
    count = points_a.shape[1]
    if count != points_b.shape[1]:
        raise MocapError(f"Clouds of {count} and {points_b.shape[1]} points do not match.")
    weights = unit_weights(joint_weights, count)
    dtype = np.result_type(points_a, points_b).type
    level = (points_a[..., 1].mean(0, float) + points_b[..., 1].mean(0, float)) / 2

    def whole_windows(points: Floats) -> Cloud:
        prepared = cloud(points.astype(float), level, weights, window, dtype, taper=taper)
        return prepared.part(slice(len(points) - window + 1))

    is_symmetric = np.array_equal(points_a, points_b)
    zero_below = EQUAL if dtype == np.float64 else 0.0
    windows_a = whole_windows(points_a)
    windows_b = windows_a if is_symmetric else whole_windows(points_b)
    return tiled_distances(windows_a, windows_b, mirror=is_symmetric, zero_below=zero_below, jobs=jobs)


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


def tiled_distances(  # noqa: PLR0913 (what to measure, what to leave out, and where to work)
    a: Cloud,
    b: Cloud,
    *,
    upper: bool = False,
    mirror: bool = False,
    zero_below: float = 0.0,
    jobs: int | None = 1,
) -> Floats:
    """Measure D between all windows of two clouds, by tiles.

    Parameters
    ----------
    a, b : `Cloud.part`s of n and m windows.
    upper : leave out tiles that are below the diagonal; they are infinite.
    mirror : measure what is above the diagonal, and write it below, too; for two clouds of the same points.
    zero_below : a D below this is 0, m².
    jobs : threads, as for `distance_grid`.

    Examples
    --------
    >>> stick = np.array([[[0.0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 2, 0]]])  # two frames of two points
    >>> ready = cloud(stick, np.zeros(2), np.full(2, 1 / 2), 1, np.float64)
    >>> np.array_equal(tiled_distances(ready, ready), cloud_distances(ready, ready))
    True
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
    """Write what a block of rows holds above the diagonal below it."""
    later = slice(block.stop, None)
    grid[later, block] = grid[block, later].T
    corner = grid[block, block]
    below_diagonal = np.tril_indices(len(corner), -1)
    corner[below_diagonal] = corner.T[below_diagonal]


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
