"""The points that a motion drives, and the planar transform that lays one cloud of points on another best."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion, require_compatible
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

FARTHEST = 1e6  # metres: farther than any motion goes; squares of such numbers are still finite in 32 bits


def distinct_joints(skeleton: Skeleton) -> list[int]:
    """List the joints that are different points: of joints that always coincide, only the first one.

    Examples
    --------
    >>> fork = Skeleton(["a", "b", "c"], [-1, 0, 0], [[0, 0, 0], [0, 1, 0], [0, 1, 0]])
    >>> distinct_joints(fork)
    [0, 1]

    Notebook: 02b-distance-grids
    """
    places = np.column_stack([skeleton.parents, np.round(skeleton.offsets * 1e9)])  # in whole nanometres
    first = {tuple(place): joint for joint, place in reversed([*enumerate(places.tolist())])}
    return sorted(joint for place, joint in first.items() if joint == 0 or any(place[1:]))


def point_cloud(motion: Motion) -> Array:
    """Give the points a motion drives: its distinct joints.

    Parameters
    ----------
    motion : F frames.

    Returns
    -------
    Shape (F, P, 3), metres: joints in the order of `distinct_joints`.

    Examples
    --------
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> still = Motion(bone, [[0, 0, 0]], [[[1, 0, 0, 0], [1, 0, 0, 0]]], 30.0)
    >>> point_cloud(still).shape
    (1, 2, 3)

    Notebook: 02-matching
    """
    return forward_kinematics(motion).positions[:, distinct_joints(motion.skeleton)]


def align(points: ArrayLike, others: ArrayLike, weights: ArrayLike | None = None) -> PlanarTransform:
    """Find the planar transform that lays `others` on `points` best, in closed form [KGP02, Eqs. 2-4].

    It minimises Σ w ‖p - T p'‖²; with bars for sums Σ w ·, and Σ w = 1,
    θ = atan2(Σ w (x z' - x' z) - (x̄ z̄' - x̄' z̄), Σ w (x x' + z z') - (x̄ x̄' + z̄ z̄')),
    x₀ = x̄ - x̄' cos θ - z̄' sin θ and z₀ = z̄ + x̄' sin θ - z̄' cos θ.

    Parameters
    ----------
    points, others : shape (..., P, 3), metres; the n-th point of one belongs to the n-th of the other.
    weights : shape (P,), not negative; equal by default. Any scale: they are divided by their sum.

    Returns
    -------
    The transform; its fields have the leading shape (...).

    Raises
    ------
    MocapError : for clouds of different sizes, points that are not finite, and weights that are negative,
        all 0 or not as many as the points.

    Examples
    --------
    >>> corner = np.array([[0.0, 1, 0], [1, 1, 0], [1, 1, 2]])
    >>> moved = PlanarTransform(0.5, 2.0, -1.0).apply_points(corner)
    >>> [float(np.round(number, 6)) for number in align(moved, corner)]
    [0.5, 2.0, -1.0]

    Notebook: 02-matching
    """
    a, b = np.asarray(points, float), np.asarray(others, float)
    if a.shape[-2:] != b.shape[-2:] or a.shape[-1:] != (3,) or a.ndim < 2:
        raise MocapError(f"Clouds of shapes {a.shape} and {b.shape} do not match: both need (..., P, 3).")
    for cloud in (a, b):
        require_near(cloud, "the cloud")
    w = unit_weights(weights, a.shape[-2])
    mean_a, mean_b = w @ a, w @ b
    # Clouds far from the origin lose no digits when they are measured from their means.
    xa, _, za = np.moveaxis(a - mean_a[..., None, :], -1, 0)
    xb, _, zb = np.moveaxis(b - mean_b[..., None, :], -1, 0)
    angle = np.arctan2((xa * zb - xb * za) @ w, (xa * xb + za * zb) @ w)
    turned = PlanarTransform(angle, 0.0, 0.0).apply_points(mean_b)
    return PlanarTransform(angle, mean_a[..., 0] - turned[..., 0], mean_a[..., 2] - turned[..., 2])


def rms_distance(first: Motion, second: Motion) -> float:
    """Measure how far apart the points of two motions are as they stand: the root mean square, metres.

    Parameters
    ----------
    first, second : as many frames of the same skeleton. They stay where they are, so align them first.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and motions of different lengths.

    Examples
    --------
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> here, there = (Motion(bone, [[x, 0, 0]], [[[1, 0, 0, 0]] * 2], 30.0) for x in (0, 3))
    >>> rms_distance(here, there)
    3.0

    Notebook: 09b-blend-window
    """
    first, second = require_compatible([first, second])
    if len(first) != len(second):
        raise MocapError(f"'{first.name}' has {len(first)} frames, '{second.name}' has {len(second)}.")
    return float(np.sqrt(((point_cloud(first) - point_cloud(second)) ** 2).sum(-1).mean()))


def unit_weights(weights: ArrayLike | None, count: int) -> Array:
    """Scale weights to a sum of one; equal ones by default.

    Raises
    ------
    MocapError : unless they are `count` numbers, not negative, and not all 0.

    Examples
    --------
    >>> unit_weights([1, 3], 2)
    array([0.25, 0.75])
    """
    w = np.ones(count) if weights is None else np.asarray(weights, float)
    if w.shape != (count,) or not np.isfinite(w).all() or np.any(w < 0) or not np.any(w > 0):
        shown = w.tolist() if w.size <= 8 else f"an array of shape {w.shape} from {w.min():g} to {w.max():g}"
        raise MocapError(f"Weights must be {count} numbers, not negative and not all 0, got {shown}.")
    w = w / w.max()  # so that not even the largest numbers overflow in the sum
    return np.asarray(w / w.sum())


def require_near(points: Array, name: str) -> None:
    """Raise unless all coordinates are finite, and at most FARTHEST metres."""
    near = np.abs(points) <= FARTHEST  # NaN is not
    if not near.all():
        at = tuple(np.argwhere(~near)[0].tolist())
        got = f"{name} holds {points[at]} at {list(at)}"
        raise MocapError(f"Points must be numbers within {FARTHEST:g} m; {got}.")
