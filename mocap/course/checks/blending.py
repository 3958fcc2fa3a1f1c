"""Random input and answers, right and wrong, for `04-blending.toml`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from mocap.blending import weights
from mocap.blending.joining import blend
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.check import close, close_rotations

NEAR = 1e-4  # radians between quaternions; below, a wrong answer may give anything


def normalised(q: Array) -> Array:
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def draw_short_way(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw two rotations: far apart, almost the same or the same, and the second with either sign."""
    start, other = normalised(rng.normal(size=(2, 4)))
    away = normalised(other - (other @ start) * start) * 10.0 ** rng.uniform(-9, -5)
    end = (other, other, start + away, start)[rng.integers(4)]
    return start, normalised(end) * rng.choice([-1, 1]), float(rng.uniform(0.1, 0.9))


def nearer(start: Array, end: Array) -> Array:
    return end if start @ end > 0 else -end


def sines(start: Array, end: Array, amount: float) -> Array:
    """Weight by sines without a change of sign; NaN, which stands for any answer, near equal or opposite."""
    cosine = float(np.clip(start @ end, -1, 1))
    if abs(cosine) > np.cos(NEAR):
        return np.full(4, np.nan)
    angle = np.arccos(cosine)
    return np.asarray((np.sin((1 - amount) * angle) * start + np.sin(amount * angle) * end) / np.sin(angle))


def on_a_line(start: Array, end: Array, amount: float) -> Array:
    return (1 - amount) * start + amount * end


def same_where_known(given: Array, wanted: Array) -> bool:
    """Check whether two rotations are the same; a known mistake leaves open what it gives where it is NaN."""
    return bool(np.isnan(wanted).any()) or close_rotations(given, wanted)


Poses = tuple[Array, Array]


def draw_mix(rng: np.random.Generator) -> tuple[Motion, Motion, Array]:
    """Draw two motions of three joints, in some frames with equal poses, and falling weights."""
    body = Skeleton(
        ["hip", "knee", "foot"], np.array([-1, 0, 1]), np.array([[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]])
    )
    frames = int(rng.integers(4, 9))
    turns = normalised(rng.normal(size=(2, frames, 3, 4)))
    turns[1, 0] = turns[0, 0] * rng.choice([-1, 1])
    a, b = (Motion(body, rng.normal(size=(frames, 3)), own, 30.0) for own in turns)
    return a, b, np.sort(rng.uniform(0, 1, frames))[::-1].copy()


def mixed_roots(a: Motion, b: Motion, alpha: Array) -> Array:
    return np.asarray(alpha[:, None] * a.root_positions + (1 - alpha[:, None]) * b.root_positions)


def mixed_turns(a: Motion, b: Motion, alpha: Array) -> Array:
    return rotations.slerp(b.rotations, a.rotations, alpha[:, None])


def mixed_on_lines(a: Motion, b: Motion, alpha: Array, *, nearer: bool = False) -> Array:
    """Mix quaternions on straight lines; with `nearer`, to that of b and -b which is nearer to a."""
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if nearer else 1.0
    share = alpha[:, None, None]
    return np.asarray(share * a.rotations + (1 - share) * signs * b.rotations)


def blended(a: Motion, b: Motion, alpha: Array) -> Poses:
    result = blend(a, b, alpha)
    return result.root_positions, result.rotations


def same_poses(given: Poses, wanted: Poses) -> bool:
    roots, turns = given
    return close(roots, wanted[0]) and close_rotations(turns, wanted[1])
