"""The point cloud of a motion, and the planar transform that best aligns one point cloud with another."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.concatenation import require_compatible
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

FARTHEST = 1e6  # metres: the largest coordinate, whose square is finite in 32 bits


def distinct_joints(skeleton: Skeleton) -> list[int]:
    """List the joints without duplicates: of joints that always coincide, only the first.

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
    """Return the point cloud of a motion: the positions of its distinct joints.

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


# reads: name: `others` is public
def align(points: ArrayLike, others: ArrayLike, weights: ArrayLike | None = None) -> PlanarTransform:
    """Compute the planar transform that best aligns `others` with `points`, in closed form [KGP02, Eqs. 2-4].

    It minimises Σ w ‖p - T p'‖². With bars for the weighted means Σ w ·, and Σ w = 1,
    θ = atan2(Σ w (x z' - x' z) - (x̄ z̄' - x̄' z̄), Σ w (x x' + z z') - (x̄ x̄' + z̄ z̄')),
    x₀ = x̄ - x̄' cos θ - z̄' sin θ and z₀ = z̄ + x̄' sin θ - z̄' cos θ.

    Parameters
    ----------
    points, others : shape (..., P, 3), metres, with points in corresponding order.
    weights : shape (P,), not negative, by default equal. They are divided by their sum.

    Returns
    -------
    The transform, whose fields have the leading shape (...).

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
    a = np.asarray(points, float)
    b = np.asarray(others, float)
    if a.shape[-2:] != b.shape[-2:] or a.shape[-1:] != (3,) or a.ndim < 2:
        raise MocapError(f"Clouds of shapes {a.shape} and {b.shape} do not match: both need (..., P, 3).")
    for cloud in (a, b):
        require_near(cloud, "the cloud")
    w = unit_weights(weights, a.shape[-2])
    mean_a = w @ a
    mean_b = w @ b
    # Measured from their means, clouds far from the origin lose no digits.
    xa, _, za = np.moveaxis(a - mean_a[..., None, :], -1, 0)
    xb, _, zb = np.moveaxis(b - mean_b[..., None, :], -1, 0)
    sine = (xa * zb - xb * za) @ w
    cosine = (xa * xb + za * zb) @ w
    angle = np.arctan2(sine, cosine)
    rotation = PlanarTransform(angle, 0.0, 0.0)
    x, _, z = np.moveaxis(mean_a - rotation.apply_points(mean_b), -1, 0)
    return PlanarTransform(angle, x, z)


def rms_distance(first: Motion, second: Motion) -> float:
    """Compute the RMS distance of the points of two motions, without alignment, in metres.

    Parameters
    ----------
    first, second : motions of the same skeleton and length. Align them first, if only poses are compared.

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
    """Normalise weights to a sum of one, by default equal ones.

    Raises
    ------
    MocapError : unless they are `count` numbers, not negative and not all 0.

    Examples
    --------
    >>> unit_weights([1, 3], 2)
    array([0.25, 0.75])
    """
    w = np.ones(count) if weights is None else np.asarray(weights, float)
    is_valid = np.isfinite(w).all() and np.all(w >= 0) and np.any(w > 0)
    if w.shape != (count,) or not is_valid:
        shown: object = w.tolist()
        if w.size > 8:
            shown = f"an array of shape {w.shape} from {w.min():g} to {w.max():g}"
        raise MocapError(f"Weights must be {count} numbers, not negative and not all 0, got {shown}.")
    w = w / w.max()  # avoids overflow in the sum
    return np.asarray(w / w.sum())


def require_near(points: Array, name: str) -> None:
    """Raise unless all coordinates are finite, and at most FARTHEST metres."""
    is_near = np.abs(points) <= FARTHEST  # False for NaN
    if not is_near.all():
        index = tuple(np.argwhere(~is_near)[0].tolist())
        got = f"{name} holds {points[index]} at {list(index)}"
        raise MocapError(f"Points must be numbers within {FARTHEST:g} m; {got}.")
