"""Random input and answers, right and wrong, for `03b-angles.toml`."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import euler
from mocap.course.check import close

TURN = 2 * np.pi
Part = tuple[Array, int, int]


def wrapped(angle: float) -> float:
    return (angle + np.pi) % TURN - np.pi


def same_turn(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare turns; exactly half a turn may go to either side."""
    return close(given, wanted) or (close(abs(wanted), np.pi) and close(abs(given), np.pi))


def draw_turn_between(rng: np.random.Generator) -> tuple[float, float]:
    """Draw two headings; every fourth time equal, opposite, or nearly so."""
    a = float(rng.uniform(-np.pi, np.pi))
    apart = (0.0, np.pi, 1e-9, np.pi - 1e-6, *rng.uniform(-np.pi, np.pi, 12))[int(rng.integers(16))]
    return a, wrapped(a + float(apart))


def draw_mean_heading(rng: np.random.Generator) -> tuple[Array]:
    """Draw headings around the cut at ±180°; now and then all the same."""
    middle = np.pi + rng.uniform(-0.3, 0.3)
    spread = 0.0 if rng.integers(8) == 0 else 0.8
    headings = middle + spread * rng.uniform(-1, 1, int(rng.integers(3, 9)))
    return ((headings + np.pi) % TURN - np.pi,)


def mean_vector(headings: ArrayLike) -> tuple[float, float]:
    return float(np.sin(headings).mean()), float(np.cos(headings).mean())


def draw_nearest_twin(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the angles z, x, y of two frames: nearly the same, or near twins, plus whole turns."""
    before = rng.uniform(-1, 1, 3) * [np.pi, 1.2, np.pi]
    # Nearly the same, not quite: then the twin is half a turn away, which could be written with either sign.
    angles = before + rng.choice([1e-8, 1e-3, 0.05, 0.3]) * rng.uniform(-1, 1, 3)
    if rng.integers(2):
        angles = twin(angles)
    return before, angles + TURN * rng.integers(-1, 2, 3)


def twin(angles: ArrayLike) -> Array:
    return np.asarray(angles) * [1, -1, 1] + np.pi


def near(before: ArrayLike, angles: ArrayLike) -> Array:
    """Add the whole turns that bring each angle nearest to the one before."""
    steps = np.subtract(angles, before)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


def nearer(before: ArrayLike, *candidates: ArrayLike) -> Array:
    return np.asarray(min(candidates, key=lambda c: float(np.abs(np.subtract(c, before)).sum())))


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
