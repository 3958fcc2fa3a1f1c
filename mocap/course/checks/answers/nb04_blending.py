"""Notebook 04: inputs, right answers and mistakes of `quintic` and `mix`."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.checks.answers.common import Arguments, normalised
from mocap.course.comparisons import close, close_rotations


def mixed_on_lines(a: Motion, b: Motion, alpha: Array, *, is_shorter: bool = False) -> Array:
    """Mix quaternions on straight lines; if `is_shorter`, to that of b and -b which is nearer to a."""
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if is_shorter else 1.0
    weights = alpha[:, None, None]
    return np.asarray(weights * a.rotations + (1 - weights) * signs * b.rotations)


# ---- quintic
#
# In formulas, α(t) = 1 - 10 t³ + 15 t⁴ - 6 t⁵, t = (p + 1)/k, and p = 0 … k - 1 are the frames of the window.


def draw_quintic(rng: np.random.Generator) -> Arguments:
    """Draw the length of a window, from 2 to 59 frames."""
    return (int(rng.integers(2, 60)),)


def right_quintic(window: int) -> Array:
    """Return the weights of a window's frames, from nearly 1 down to 0."""
    return 1 - quintic_step(np.arange(1, window + 1) / window)


def mistake_rising(window: int) -> object:
    """Return 1 - α(t), the weights of the second motion."""
    return 1 - right_quintic(window)


def mistake_frame_late(window: int) -> object:
    """Return α(p/k), which is 1 in the first frame of the window."""
    return 1 - quintic_step(np.arange(window) / window)


def mistake_starts_in_window(window: int) -> object:
    """Return α(p/(k - 1)), from 1 in the first frame of the window to 0 in the last."""
    return 1 - quintic_step(np.linspace(0, 1, window))


def mistake_cubic(window: int) -> object:
    """Return the cubic weights 1 - 3 t² + 2 t³."""
    return cubic_weights(window)


def mistake_never_zero(window: int) -> object:
    """Return α((p + 1)/(k + 1)), which would be 0 in the frame after the window."""
    return 1 - quintic_step(np.arange(1, window + 1) / (window + 1))


def mistake_frame_middles(window: int) -> object:
    """Return α((p + 1/2)/k), the weights in the middles of the frames."""
    return 1 - quintic_step((np.arange(window) + 0.5) / window)


def mistake_coefficients(window: int) -> object:
    """Return the six coefficients of α, whatever the window."""
    return np.array([1.0, 0, 0, -10, 15, -6])


def mistake_straight_line(window: int) -> object:
    """Return the linear weights 1 - t."""
    return 1 - np.arange(1, window + 1) / window


def mistake_cosine(window: int) -> object:
    """Return the weights (1 + cos π t)/2."""
    return (1 + np.cos(np.pi * np.arange(1, window + 1) / window)) / 2


def mistake_rising_frame_late(window: int) -> object:
    """Return 1 - α(p/k), which is 0 in the first frame of the window."""
    return quintic_step(np.arange(window) / window)


def mistake_one_missing(window: int) -> object:
    """Return α(t) - 1, the polynomial without its constant."""
    return -quintic_step(np.arange(1, window + 1) / window)


# ---- mix


def draw_mix(rng: np.random.Generator) -> Arguments:
    """Draw two motions of three joints, in some frames with equal poses, and falling weights."""
    offsets = np.array([[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]])
    body = Skeleton(["hip", "knee", "foot"], np.array([-1, 0, 1]), offsets)
    frames = int(rng.integers(4, 9))
    turns = normalised(rng.normal(size=(2, frames, 3, 4)))
    turns[1, 0] = turns[0, 0] * rng.choice([-1, 1])
    a, b = (Motion(body, rng.normal(size=(frames, 3)), quaternions, 30.0) for quaternions in turns)
    return a, b, np.sort(rng.uniform(0, 1, frames))[::-1].copy()


def right_mix(a: Motion, b: Motion, alpha: Array) -> tuple[Array, Array]:
    """Mix two motions as the package does."""
    mixed = blend(a, b, alpha)
    return (mixed.root_positions, mixed.rotations)


def same_mix(answer: Any, wanted: tuple[Array, Array]) -> bool:  # noqa: ANN401
    """Check whether two blends have the same root positions and the same rotations."""
    return len(answer) == 2 and close(answer[0], wanted[0]) and close_rotations(answer[1], wanted[1])


def mistake_weight_of_b(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix roots and rotations with alpha as the weight of b."""
    return right_mix(a, b, 1 - alpha)


def mistake_rotations_reversed(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix the roots rightly, and the rotations with alpha as the weight of b."""
    roots, _ = right_mix(a, b, alpha)
    return roots, right_mix(a, b, 1 - alpha)[1]


def mistake_roots_reversed(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix the rotations rightly, and the roots with alpha as the weight of b."""
    _, rotations = right_mix(a, b, alpha)
    return right_mix(a, b, 1 - alpha)[0], rotations


def mistake_roots_alone(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix the roots, and return the rotations of a."""
    roots, _ = right_mix(a, b, alpha)
    return roots, a.rotations


def mistake_root_joint_alone(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix the roots and the rotations of the root joint, and return a's rotations of the other joints."""
    roots, rotations = right_mix(a, b, alpha)
    return roots, np.concatenate([rotations[:, :1], a.rotations[:, 1:]], axis=1)


def mistake_straight_lines(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix quaternions linearly, neither scaled to unit length nor with the nearer of q and -q."""
    roots, _ = right_mix(a, b, alpha)
    return roots, mixed_on_lines(a, b, alpha)


def mistake_scaled_straight_lines(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix quaternions linearly and scale them to unit length, without the nearer of q and -q."""
    roots, _ = right_mix(a, b, alpha)
    return roots, normalised(mixed_on_lines(a, b, alpha))


def mistake_scaled_shorter_lines(a: Motion, b: Motion, alpha: Array) -> object:
    """Mix quaternions linearly and scale them to unit length, with the nearer of q and -q."""
    roots, _ = right_mix(a, b, alpha)
    return roots, normalised(mixed_on_lines(a, b, alpha, is_shorter=True))
