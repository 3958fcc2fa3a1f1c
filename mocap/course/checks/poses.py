"""Random input and answers, right and wrong, of exercises about bodies, places and turns."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Indices, Mask
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


def draw_hamilton(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw two rotations: mostly different ones, sometimes equal, nearly equal, opposite, or no turn."""
    a, b = normalised(rng.normal(size=(2, 4)))
    special = [a, normalised(a + 1e-9 * b), -a, rotations.inverse(a), rotations.IDENTITY]
    return a, np.array([*special, *[b] * 15][rng.integers(20)])


def draw_climb(rng: np.random.Generator) -> tuple[Skeleton, Array, int]:
    """Draw a tree of joints, how they are turned, and its last joint."""
    count = int(rng.integers(4, 9))
    parents = np.array([-1, 0, *(rng.integers(joint - 2, joint) for joint in range(2, count))])
    skeleton = Skeleton([f"joint {n}" for n in range(count)], parents, rng.normal(size=(count, 3)))
    turns = rng.normal(size=(count, 4))
    return skeleton, turns / np.linalg.norm(turns, axis=1, keepdims=True), count - 1


def climb(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    """Go from a joint to the root; each parent turns all that hangs below it."""
    point, matrices = np.zeros(3), rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset, parent = skeleton.offsets[joint], int(skeleton.parents[joint])
        point = matrices[parent] @ (point + offset)
        joint = parent
    return point


# ---- Notebook 01b


# ---- Notebook 03


# ---- Notebook 03b


TURN = 2 * np.pi
Part = tuple[Array, int, int]


def draw_turn_between(rng: np.random.Generator) -> tuple[float, float]:
    """Draw two headings; every fourth time equal, opposite, or nearly so."""
    a = float(rng.uniform(-np.pi, np.pi))
    apart = (0.0, np.pi, 1e-9, np.pi - 1e-6, *rng.uniform(-np.pi, np.pi, 12))[int(rng.integers(16))]
    return a, (a + float(apart) + np.pi) % TURN - np.pi


def draw_nearest_twin(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the angles z, x, y of two frames: nearly the same, or near twins, plus whole turns."""
    before = rng.uniform(-1, 1, 3) * [np.pi, 1.2, np.pi]
    # Nearly the same, not quite: then the twin is half a turn away, which could be written with either sign.
    angles = before + rng.choice([1e-8, 1e-3, 0.05, 0.3]) * rng.uniform(-1, 1, 3)
    if rng.integers(2):
        angles = twin(angles)
    return before, angles + TURN * rng.integers(-1, 2, 3)


def twin(angles: ArrayLike) -> Array:
    """Give the other three angles of the same rotation."""
    return np.asarray(angles) * [1, -1, 1] + np.pi


def near(before: ArrayLike, angles: ArrayLike) -> Array:
    """Add the whole turns that bring each angle nearest to the one before."""
    steps = np.subtract(angles, before)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


def draw_chain(rng: np.random.Generator) -> tuple[list[Part]]:
    """Draw slices of walks over the ground; the second sometimes follows the first in the same clip."""
    clips = [rng.uniform(-3, 3, 2) + rng.uniform(0.1, 0.4, (20, 2)).cumsum(axis=0) for _ in range(3)]
    parts = [(clip, int(rng.integers(0, 6)), int(rng.integers(8, 14))) for clip in clips]
    if rng.integers(2):
        parts[1] = (parts[0][0], parts[0][2], parts[0][2] + 4)
    return (parts,)


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


def draw_mix(rng: np.random.Generator) -> tuple[Motion, Motion, Array]:
    """Draw two motions of three joints, in some frames with equal poses, and falling weights."""
    offsets = np.array([[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]])
    body = Skeleton(["hip", "knee", "foot"], np.array([-1, 0, 1]), offsets)
    frames = int(rng.integers(4, 9))
    turns = normalised(rng.normal(size=(2, frames, 3, 4)))
    turns[1, 0] = turns[0, 0] * rng.choice([-1, 1])
    a, b = (Motion(body, rng.normal(size=(frames, 3)), own, 30.0) for own in turns)
    return a, b, np.sort(rng.uniform(0, 1, frames))[::-1].copy()


def mixed_on_lines(a: Motion, b: Motion, alpha: Array, *, nearer: bool = False) -> Array:
    """Mix quaternions on straight lines; with `nearer`, to that of b and -b which is nearer to a."""
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if nearer else 1.0
    share = alpha[:, None, None]
    return np.asarray(share * a.rotations + (1 - share) * signs * b.rotations)


def blended(a: Motion, b: Motion, alpha: Array) -> tuple[Array, Array]:
    """Mix two motions as the package does."""
    result = blend(a, b, alpha)
    return result.root_positions, result.rotations
