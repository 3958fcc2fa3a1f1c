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

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.tasks import one_blas_thread, run_in_order, thread_count
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion
from mocap.matching.prepared_clouds import Cloud, Floats, prepared_windows
from mocap.matching.tuned import TUNED
from mocap.matching.window_sums import frame_sums

# m²: the tolerance for equal distances D. Rounding is about 1e-14 m² for a walking body, and similar windows
# have a D of 1e-4 to 1e-2 m². A smaller D is set to 0, because the root would amplify its rounding error.
EQUAL = 1e-12


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
    >>> from mocap.matching.prepared_clouds import cloud
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
    >>> from mocap.matching.prepared_clouds import cloud
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
