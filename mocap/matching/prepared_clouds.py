"""Point clouds prepared for matching: centred and weighted, with the sums of each window.

The symbols are those of `distance_grids`: y is a height, g = z + ix a point on the ground, w a weight, and S
the sum of the squares of a window.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud, require_near, unit_weights

Floats = NDArray[np.floating[Any]]


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
