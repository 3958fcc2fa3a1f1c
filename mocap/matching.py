"""How alike are two moments of motion? Metrics, and the alignment under which clouds of points agree best.

In every grid, entry [i, j] lays the `window` frames of b that start at j on those of a that start at i.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from mocap.errors import MocapError
from mocap.kinematics import joint_positions
from mocap.motion import Motion, require_alike
from mocap.skeleton import Skeleton
from mocap.transforms import PlanarTransform

Array = NDArray[np.float64]


def distinct_joints(skeleton: Skeleton) -> list[int]:
    """List the joints that are different points: of joints that always coincide, only the first.

    Examples
    --------
    >>> fork = Skeleton(["a", "b", "c"], [-1, 0, 0], [[0, 0, 0], [0, 1, 0], [0, 1, 0]])
    >>> distinct_joints(fork)
    [0, 1]
    """
    seen: set[tuple[int, ...]] = set()
    kept = []
    for joint, (parent, offset) in enumerate(zip(skeleton.parents, skeleton.offsets, strict=True)):
        place = (int(parent), *np.round(offset * 1e9).astype(int).tolist())
        if joint == 0 or (np.any(place[1:]) and place not in seen):
            kept.append(joint)
        seen.add(place)
    return kept


def point_cloud(motion: Motion) -> Array:
    """Give the points a motion drives: every distinct joint in every frame, shape (F, P, 3), metres.

    Notebook: 00-quickstart
    """
    return joint_positions(motion)[:, distinct_joints(motion.skeleton)]


def align(points: ArrayLike, others: ArrayLike, weights: ArrayLike | None = None) -> PlanarTransform:
    """Find the planar transform that lays `others` on `points` best, in closed form.

    It minimises Σ w ‖p - T p'‖² [KGP02, Eqs. 2-4]; with bars for sums Σ w ·, and Σ w = 1,
    θ = atan2(Σ w (x z' - x' z) - (x̄ z̄' - x̄' z̄), Σ w (x x' + z z') - (x̄ x̄' + z̄ z̄')),
    x₀ = x̄ - x̄' cos θ - z̄' sin θ and z₀ = z̄ + x̄' sin θ - z̄' cos θ.

    Parameters
    ----------
    points, others : shape (..., P, 3), metres; the n-th point of one belongs to the n-th of the other.
    weights : shape (P,), not negative; equal by default. Any scale: they are divided by their sum.

    Returns
    -------
    The transform; its fields have the leading shape (...).

    Examples
    --------
    >>> corner = np.array([[0.0, 1, 0], [1, 1, 0], [1, 1, 2]])
    >>> moved = PlanarTransform(0.5, 2.0, -1.0).points(corner)
    >>> [float(np.round(number, 6)) for number in align(moved, corner)]
    [0.5, 2.0, -1.0]

    Notebook: 00-quickstart
    """
    a, b = np.asarray(points, float), np.asarray(others, float)
    w = _unit_weights(weights, a.shape[-2])
    # Centred on their means, clouds far from the origin lose no digits.
    mean_a, mean_b = (np.einsum("p,...pc->...c", w, cloud) for cloud in (a, b))
    (xa, _, za), (xb, _, zb) = (
        np.moveaxis(cloud - mean[..., None, :], -1, 0) for cloud, mean in ((a, mean_a), (b, mean_b))
    )
    angle = np.arctan2((xa * zb - xb * za) @ w, (xa * xb + za * zb) @ w)
    turned = PlanarTransform(angle, 0.0, 0.0).points(mean_b)
    return PlanarTransform(angle, mean_a[..., 0] - turned[..., 0], mean_a[..., 2] - turned[..., 2])


def _unit_weights(weights: ArrayLike | None, count: int) -> Array:
    w = np.ones(count) if weights is None else np.asarray(weights, float)
    if w.shape != (count,) or not np.isfinite(w).all() or np.any(w < 0) or w.sum() == 0:
        raise MocapError(f"Weights must be {count} numbers, not negative and not all 0, got {w.tolist()}.")
    return np.asarray(w / w.sum())


def distance_grid(a: Motion | Array, b: Motion | Array, *, window: int) -> Array:
    """Measure the point cloud distance between all windows of two clips [KGP02, Eq. 1].

    D = min over T of Σ w ‖p - T p'‖². At the best T this is
    S_A + S_B - 2 Σ w y y' - 2 √((Σ w (x x' + z z'))² + (Σ w (x z' - x' z))²), with S = Σ w (x² + y² + z²)
    and x, z measured from the window's mean. The three cross sums are inner products of frames, a matrix
    product for all pairs at once, added along the diagonal over the window. The weights are equal and sum
    to one, so √D is the RMS distance of the points, in metres.

    Parameters
    ----------
    a, b : motions, or their points of shape (F, P, 3), metres.
    window : frames k in a window.

    Returns
    -------
    D, shape (F_a - k + 1, F_b - k + 1), m², never negative.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and for clips shorter than the window.

    Notebook: 00-quickstart
    """
    if isinstance(a, Motion) and isinstance(b, Motion):
        require_alike([a, b])
    clouds = [_ground_centred(point_cloud(m) if isinstance(m, Motion) else m) for m in (a, b)]
    for cloud, clip in zip(clouds, (a, b), strict=True):
        check_window(window, len(cloud), clip.name if isinstance(clip, Motion) else "the clip")
    if clouds[0].shape[1] != clouds[1].shape[1]:
        raise MocapError(f"Clouds of {clouds[0].shape[1]} and {clouds[1].shape[1]} points do not match.")
    scale = 1 / np.sqrt(clouds[0].shape[1])  # the square root of each point's weight
    (xa, ya, za), (xb, yb, zb) = (np.moveaxis(cloud * scale, -1, 0) for cloud in clouds)  # (F, P) each
    heights = _diagonal_mean(ya @ yb.T, window)
    along = _diagonal_mean(xa @ xb.T + za @ zb.T, window)
    across = _diagonal_mean(xa @ zb.T - za @ xb.T, window)
    (mxa, mza, size_a), (mxb, mzb, size_b) = (_window_means(cloud, window) for cloud in clouds)
    along -= np.outer(mxa, mxb) + np.outer(mza, mzb)
    across -= np.outer(mxa, mzb) - np.outer(mza, mxb)
    grid = size_a[:, None] + size_b - 2 * heights - 2 * np.hypot(along, across)
    return np.asarray(np.maximum(grid, 0.0))


def _ground_centred(cloud: Array) -> Array:
    """Move a clip over the origin, so that one captured far away loses no digits."""
    return np.asarray(cloud - cloud.mean(axis=(0, 1)) * [1.0, 0.0, 1.0])


def check_window(window: int, frames: int, name: str) -> None:
    """Raise unless a clip of so many frames holds at least one window."""
    if window < 1:
        raise MocapError(f"A window needs at least one frame, got {window}.")
    if frames < window:
        raise MocapError(f"'{name}' has {frames} frames, too few for a window of {window}.")


def _diagonal_mean(products: Array, window: int) -> Array:
    """Average over [i + f, j + f] for the frames f of a window."""
    rows, columns = products.shape[0] - window + 1, products.shape[1] - window + 1
    total = products[:rows, :columns].copy()
    for f in range(1, window):
        total += products[f : f + rows, f : f + columns]
    return total / window


def _window_means(cloud: Array, window: int) -> tuple[Array, Array, Array]:
    """For every window the mean x, the mean z, and the mean square S measured from these."""
    per_frame = np.stack([cloud[..., 0].mean(1), cloud[..., 2].mean(1), (cloud**2).sum(-1).mean(1)])
    x, z, square = sliding_window_view(per_frame, window, axis=1).mean(-1)
    return x, z, square - x**2 - z**2


def root_grid(a: Motion, b: Motion, *, window: int) -> Array:
    """Measure the homework report's distance: how far apart the roots are, and how differently turned.

    The mean over the window of ‖p - p'‖ + angle(q, q'), a metre counting as much as a radian. It knows
    neither limbs nor that a motion may be moved over the ground: 3.1 of [KGP02] says why that is wrong.

    Parameters
    ----------
    a, b : motions.
    window : frames in a window.

    Returns
    -------
    Shape (F_a - window + 1, F_b - window + 1), metres plus radians.

    Notebook: 00-quickstart
    """
    require_alike([a, b])
    for clip in (a, b):
        check_window(window, len(clip), clip.name)
    apart = np.linalg.norm(a.root_positions[:, None] - b.root_positions, axis=-1)
    cosines = np.abs(a.rotations[:, 0] @ b.rotations[:, 0].T)  # of half the angle, the short way round
    return _diagonal_mean(apart + 2 * np.arccos(np.minimum(cosines, 1.0)), window)
