"""The two distance metrics of the homework, for comparison with point clouds.

Each takes two motions and a `window`, and returns a grid like `distance_grid`: entry [i, j] compares the
`window` frames of a from frame i with those of b from frame j. `root_grid` depends only on the root, and
`euler_grid` only on the pose, with the faults that 3.1 of [KGP02] describes. `distance_grid` depends on
points of the whole body. All three have the signature `Metric`, and each can be used in place of another.
"""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.matching.distance_grids import distance_grid
from mocap.matching.prepared_clouds import require_windows
from mocap.matching.window_sums import diagonal_sum

_DIVISOR = 480  # common divisor of the weights
_SIDED = {"femur": 50, "tibia": 30, "foot": 15, "toes": 5, "clavicle": 30, "humerus": 15, "radius": 5}
_MIDDLE = {"lowerback": 50, "upperback": 40, "thorax": 30, "lowerneck": 20, "upperneck": 15, "head": 5}
_BOTH_SIDES = {side + bone: weight for bone, weight in _SIDED.items() for side in "lr"}
HOMEWORK_WEIGHTS: Mapping[str, float] = {
    bone: weight / _DIVISOR for bone, weight in (_MIDDLE | _BOTH_SIDES).items()
}
"""The weight of each bone in the homework's metric. That of other bones is 0."""


Metric = Callable[..., NDArray[np.floating]]
"""The common signature of all metrics, `metric(a, b, window=k)`; other keywords have defaults."""


def root_grid(a: Motion, b: Motion, *, window: int) -> Array:
    """Compute the distance of the homework's report: the roots' distance plus the angle between them.

    It is the mean over the window of ‖p - p'‖ + angle(q, q'), in which a metre counts as much as a radian. It
    ignores the limbs, and is not invariant to planar rigid transforms of a motion [KGP02, 3.1].

    Parameters
    ----------
    a, b : motions.
    window : frames in a window.

    Returns
    -------
    Shape (F_a - window + 1, F_b - window + 1), metres plus radians.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and clips shorter than the window.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> here, there = (Motion(dot, [[x, 1, 0]], [[[1, 0, 0, 0]]], 30.0) for x in (0, 3))
    >>> root_grid(here, there, window=1)
    array([[3.]])
    """
    a, b = require_windows([a, b], window)
    cosines = np.abs(
        a.rotations[:, 0] @ b.rotations[:, 0].T
    )  # of half the angle, because q and -q are the same rotation
    angles = 2 * np.arccos(np.minimum(cosines, 1.0))
    return diagonal_sum(cdist(a.root_positions, b.root_positions) + angles, window) / window


def euler_grid(a: Motion, b: Motion, *, window: int) -> Array:
    """Compute the distance of the homework's program: the weighted difference of the bones' Euler angles.

    It is the sum over the window and over the bones of w ‖Δ‖, with w from `HOMEWORK_WEIGHTS`. Δ are the
    differences in degrees between the angles that the file has for the bone, each wrapped to [-180, 180]. The
    root is ignored.

    Parameters
    ----------
    a, b : motions.
    window : frames in a window.

    Returns
    -------
    Shape (F_a - window + 1, F_b - window + 1), degrees · frames.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, clips shorter than the window, and a
        skeleton with none of the weighted bones.

    Notes
    -----
    A motion stores quaternions L, not the angles of its file. The angles are recovered from M = C⁻¹ L C, with
    the axes C and the `dofs` of the bone, which the skeleton stores.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> offsets = [[0, 0, 0], [0, -1, 0], [0, -1, 0]]
    >>> leg = Skeleton(["root", "ltibia", "lfoot"], [-1, 0, 1], offsets, dofs=["", "x", ""])
    >>> one, bent = rotations.from_rotvec([[0, 0, 0], [np.radians(30), 0, 0]])
    >>> a, b = (Motion(leg, [[0, 1, 0]], [[one, knee, one]], 30.0) for knee in (one, bent))
    >>> euler_grid(a, b, window=1) / HOMEWORK_WEIGHTS["ltibia"]
    array([[30.]])
    """
    a, b = require_windows([a, b], window)
    skeleton = a.skeleton
    weights = HOMEWORK_WEIGHTS
    bones = [j for j, name in enumerate(skeleton.names) if j and name in weights and skeleton.dofs[j]]
    if not bones:
        raise MocapError(f"This skeleton has no bone with a weight: {shortened(', '.join(weights))}.")
    grid = np.zeros((len(a), len(b)))
    for bone in bones:
        # In revolutions, so that the nearest integer wraps a difference.
        angles = (file_angles(clip, bone).T / 360 for clip in (a, b))  # (dofs, F)
        differences = (np.subtract.outer(*pair) for pair in zip(*angles, strict=True))
        square = sum((difference - np.rint(difference)) ** 2 for difference in differences)
        grid += 360 * weights[skeleton.names[bone]] * np.sqrt(square)
    return diagonal_sum(grid, window)


def file_angles(motion: Motion, joint: int) -> Array:
    """Recover the angles of a joint in a motion's file, in degrees: shape (F, D) for D dofs.

    The joint's rotation is L = C M C⁻¹, with C from the skeleton's `axes`. The result are the angles of M
    about the joint's `dofs`, in their order. Of equivalent triples, it is the one whose middle angle is
    within ±90°.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> knee = Skeleton(["knee", "foot"], [-1, 0], [[0, 0, 0], [0, -1, 0]], dofs=["x", ""])
    >>> from mocap.body.euler import from_euler
    >>> bent = from_euler("x", [np.radians(30)])
    >>> file_angles(Motion(knee, [[0, 1, 0]], [[bent, [1, 0, 0, 0]]], 30.0), 0).round(6)
    array([[30.]])
    """
    axes = motion.skeleton.axes[joint]
    dofs = motion.skeleton.dofs[joint]
    in_axes = rotations.multiply(rotations.inverse(axes), motion.rotations[:, joint])
    in_axes = rotations.multiply(in_axes, axes)
    sequence = dofs + "".join(sorted(set("xyz") - set(dofs)))  # about the axes without a dof the angle is 0
    return np.degrees(euler.to_euler(sequence, in_axes)[:, : len(dofs)])


METRICS: Mapping[str, Metric] = {
    "point clouds": distance_grid,
    "roots": root_grid,
    "Euler angles": euler_grid,
}
"""All metrics by name, with the signature of `Metric`."""
