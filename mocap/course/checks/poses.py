"""Answers, right and wrong, of exercises about bodies, places and turns."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.body.rotations import multiply
from mocap.body.skeleton import Skeleton
from mocap.course.check import close, close_rotations

# ---- Notebook 01


def climb(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    """Go from a joint to the root; each parent turns all that hangs below it."""
    point, matrices = np.zeros(3), rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset, parent = skeleton.offsets[joint], int(skeleton.parents[joint])
        point = matrices[parent] @ (point + offset)
        joint = parent
    return point


# ---- Notebook 03b


TURN = 2 * np.pi
Part = tuple[Array, int, int]


def twin(angles: ArrayLike) -> Array:
    """Give the other three angles of the same rotation."""
    return np.asarray(angles) * [1, -1, 1] + np.pi


def near(before: ArrayLike, angles: ArrayLike) -> Array:
    """Add the whole turns that bring each angle nearest to the one before."""
    steps = np.subtract(angles, before)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


def chained(parts: list[Part]) -> Array:
    """Join slices: each first frame where the clip before would have been."""
    pieces, moved = [], np.zeros(2)
    for number, (clip, start, stop) in enumerate(parts):
        if number:
            before, _, end = parts[number - 1]
            moved = moved + before[end] - clip[start]
        pieces.append(clip[start:stop] + moved)
    return np.concatenate(pieces)


# ---- Notebook 04


def normalised(q: Array) -> Array:
    """Divide quaternions by their lengths."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def mixed_on_lines(a: Motion, b: Motion, alpha: Array, *, nearer: bool = False) -> Array:
    """Mix quaternions on straight lines; with `nearer`, to that of b and -b which is nearer to a."""
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if nearer else 1.0
    share = alpha[:, None, None]
    return np.asarray(share * a.rotations + (1 - share) * signs * b.rotations)
