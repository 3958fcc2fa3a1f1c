"""How alike are two moments of motion? Four metrics, one interface.

Each takes two motions and a `window`, and gives a grid: entry [i, j] lays the `window` frames of b that
start at j on those of a that start at i. Which one is right? `root_grid` sees only the root, `euler_grid`
and `pose_grid` only the pose; 3.1 of [KGP02] says what goes wrong. `distance_grid` sees the body's points.
"""

from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.matching.distance_grids import check_window, diagonal_sum, tiles

pass
pass
pass
pass
pass

_SIDED = {"femur": 50, "tibia": 30, "foot": 15, "toes": 5, "clavicle": 30, "humerus": 15, "radius": 5}
_MIDDLE = {"lowerback": 50, "upperback": 40, "thorax": 30, "lowerneck": 20, "upperneck": 15, "head": 5}
HOMEWORK_WEIGHTS: Mapping[str, float] = {
    name: weight / 480
    for name, weight in (_MIDDLE | {side + bone: w for bone, w in _SIDED.items() for side in "lr"}).items()
}
"""How much each bone counts in the homework's metric; the others do not."""


class Metric(Protocol):
    """What all four have in common; the keywords of their own have defaults."""

    def __call__(self, a: Motion, b: Motion, *, window: int) -> NDArray[np.floating]:
        """Compare all windows of a with all of b."""


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

    Notebook: 02-matching
    """
    _require_windows(a, b, window)

    def apart(p: Array, q: Array) -> Array:
        cosines = np.abs(p[:, 3:] @ q[:, 3:].T)  # of half the angle, the short way round
        moved = np.linalg.norm(p[:, None, :3] - q[:, :3], axis=-1)
        return np.asarray(moved + 2 * np.arccos(np.minimum(cosines, 1.0)))

    roots = [np.hstack([clip.root_positions, clip.rotations[:, 0]]) for clip in (a, b)]
    return diagonal_sum(_all_pairs(apart, *roots), window) / window


def euler_grid(
    a: Motion, b: Motion, *, window: int, weights: Mapping[str, float] = HOMEWORK_WEIGHTS
) -> Array:
    """Measure the homework code's distance: how far the bones' Euler angles are apart.

    The sum over the window, and over the bones, of w ‖Δ‖, where Δ are the differences in degrees of the
    angles that the file tells for the bone, each wrapped to [-180, 180). The root is left out.

    Parameters
    ----------
    a, b : motions.
    window : frames in a window.
    weights : of the bones, by name; those of the homework by default.

    Returns
    -------
    Shape (F_a - window + 1, F_b - window + 1), degrees · frames.

    Raises
    ------
    MocapError : where the skeleton has none of the weighted bones.

    Notes
    -----
    A motion holds quaternions. The skeleton remembers in which axes C and about which `dofs` its file
    tells a bone's angles, so they can be read off M = C⁻¹ L C: one truth, not two kept side by side.

    Notebook: 02-matching
    """
    _require_windows(a, b, window)
    if unusable := {n: w for n, w in weights.items() if not (np.isfinite(w) and w >= 0)}:
        raise MocapError(f"Weights must be numbers, not negative, got {unusable}.")
    skeleton = a.skeleton
    bones = [j for j, name in enumerate(skeleton.names) if j and weights.get(name) and skeleton.dofs[j]]
    if not bones:
        raise MocapError(f"This skeleton has none of the bones with a weight: {', '.join(weights)}.")
    columns = np.cumsum([len(skeleton.dofs[bone]) for bone in bones])[:-1]

    def apart(p: Array, q: Array) -> Array:
        total = np.zeros((len(p), len(q)))
        each = zip(bones, np.split(p, columns, axis=1), np.split(q, columns, axis=1), strict=True)
        for bone, angles, others in each:
            total += weights[skeleton.names[bone]] * _angle_gaps(angles, others)
        return total

    angles = [np.hstack([file_angles(clip, bone) for bone in bones]) for clip in (a, b)]
    return diagonal_sum(_all_pairs(apart, *angles), window)


def file_angles(motion: Motion, joint: int) -> Array:
    """Read the angles that a motion's file tells for a joint, in degrees: shape (F, D) for D dofs.

    The joint's rotation is L = C M C⁻¹ with C the skeleton's `axes`; these are the angles of M about the
    joint's `dofs`, in their order. Of the triples that mean the same M the one with the middle angle
    within ±90°.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> knee = Skeleton(["knee", "foot"], [-1, 0], [[0, 0, 0], [0, -1, 0]], dofs=["x", ""])
    >>> from mocap.body.euler import from_euler
    >>> bent = from_euler("x", [np.radians(30)])
    >>> file_angles(Motion(knee, [[0, 1, 0]], [[bent, [1, 0, 0, 0]]], 30.0), 0).round(6)
    array([[30.]])

    Notebook: 02-matching
    """
    axis, dofs = motion.skeleton.axes[joint], motion.skeleton.dofs[joint]
    own = rotations.multiply(rotations.multiply(rotations.inverse(axis), motion.rotations[:, joint]), axis)
    every = dofs + "".join(sorted(set("xyz") - set(dofs)))  # about those it lacks it does not turn
    return np.degrees(euler.to_euler(every, own)[:, : len(dofs)])


def _angle_gaps(a: Array, b: Array) -> Array:
    """Measure ‖Δ‖ for all pairs of frames of angles (F, D) in degrees; Δ wrapped to half a turn."""
    square = np.zeros((len(a), len(b)))
    for column_a, column_b in zip(a.T / 360, b.T / 360, strict=True):
        turns = column_a[:, None] - column_b
        if max(np.ptp(column_a), np.ptp(column_b), np.abs(turns).max()) > 0.5:
            turns -= np.rint(turns)
        square += np.multiply(turns, turns, out=turns)
    return 360 * np.sqrt(square)


def pose_grid(
    a: Motion, b: Motion, *, window: int, form: str = "quaternion", velocities: float = 0.0
) -> Array:
    """Measure the norm of the difference of pose vectors: what 3.1 of [KGP02] starts from, and drops.

    The mean over the window of √(Σ over joints of ‖Δq‖² + (velocities · ‖Δω‖)²). The root is left out.

    Parameters
    ----------
    a, b : motions.
    window : frames in a window.
    form : "quaternion", where q and -q are the same; or "log", the rotation vectors in radians.
    velocities : how many seconds of a difference in angular velocity ω count as the same difference in
        pose; 0 leaves velocities out.

    Returns
    -------
    Shape (F_a - window + 1, F_b - window + 1).

    Raises
    ------
    MocapError : for another form, and for velocities that are negative or asked of a single frame.

    Notebook: 02-matching
    """
    _require_windows(a, b, window)
    if form not in ("quaternion", "log"):
        raise MocapError(f'A pose is told by form="quaternion" or "log", got {form!r}.')
    if not (np.isfinite(velocities) and velocities >= 0):
        raise MocapError(f"velocities must be seconds, 0 or more, got {velocities}.")
    if form == "log":
        square = _square_gaps(*(rotations.to_rotvec(m.rotations[:, 1:]) for m in (a, b)))
    else:
        square = _all_pairs(_quaternion_gaps, a.rotations[:, 1:], b.rotations[:, 1:])
    if velocities:
        square += velocities**2 * _square_gaps(*(_angular_velocities(m)[:, 1:] for m in (a, b)))
    return diagonal_sum(np.sqrt(square), window) / window


def _quaternion_gaps(a: Array, b: Array) -> Array:
    """Measure Σ over joints of ‖q ∓ q'‖² = 2 ∓ 2 q·q', whichever sign is nearer."""
    square = np.zeros((len(a), len(b)))
    for q, other in zip(np.swapaxes(a, 0, 1), np.swapaxes(b, 0, 1), strict=True):
        square += 2 - 2 * np.minimum(np.abs(q @ other.T), 1.0)
    return square


def _square_gaps(a: Array, b: Array) -> Array:
    """Measure ‖v - v'‖² between all rows of two stacks of vectors."""
    a, b = a.reshape(len(a), -1), b.reshape(len(b), -1)
    square = (a**2).sum(1)[:, None] + (b**2).sum(1) - 2 * a @ b.T
    return np.asarray(np.maximum(square, 0.0))


def _angular_velocities(motion: Motion) -> Array:
    """Turn from each frame to the next, radians a second; the last frame goes on as the one before it."""
    if len(motion) < 2:
        raise MocapError(f"'{motion.name}' has one frame, and so no velocities.")
    steps = rotations.multiply(rotations.inverse(motion.rotations[:-1]), motion.rotations[1:])
    speeds = rotations.to_rotvec(steps) * motion.fps
    return np.concatenate([speeds, speeds[-1:]])


def _require_windows(a: Motion, b: Motion, window: int) -> None:
    require_alike([a, b])
    for clip in (a, b):
        check_window(window, len(clip), f"'{clip.name}'")


def _all_pairs(apart: Callable[[Array, Array], Array], a: Array, b: Array) -> Array:
    """Measure all pairs of rows of two arrays, tile by tile so that the work stays in the cache."""
    grid = np.empty((len(a), len(b)))
    for rows, columns in tiles(*grid.shape):
        grid[rows, columns] = apart(a[rows], b[columns])
    return grid
