"""Notebook 03b: inputs, right answers and mistakes of `turn_between`, `nearest_twin` and `chain`."""

from itertools import pairwise
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler
from mocap.course.checks.answers.common import Arguments
from mocap.course.comparisons import close

TURN = 2 * np.pi  # radians
Slice = tuple[Array, int, int]
"""A clip, shape (F, 2), and the frames `start` and `stop`."""


def twin(angles: Array) -> Array:
    """Return the other three angles of the same rotation."""
    return np.asarray(angles) * [1, -1, 1] + np.pi


def unwrapped(previous: Array, angles: Array) -> Array:
    """Add the whole turns that bring each angle nearest to the previous one."""
    steps = np.subtract(angles, previous)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


def nearest_to(previous: Array, *candidates: Array) -> Array:
    """Return the candidate whose angles differ least from the previous ones."""
    return min(candidates, key=lambda angles: float(np.abs(angles - previous).sum()))


# ---- turn_between


def draw_turn_between(rng: np.random.Generator) -> Arguments:
    """Draw two headings; every fourth time equal, opposite, or nearly so."""
    a = float(rng.uniform(-np.pi, np.pi))
    turns = (0.0, np.pi, 1e-9, np.pi - 1e-6, *rng.uniform(-np.pi, np.pi, 12))
    turn = float(turns[int(rng.integers(16))])
    return a, (a + turn + np.pi) % TURN - np.pi


def right_turn_between(a: float, b: float) -> float:
    """Return the difference of two headings, wrapped to half a turn."""
    return (b - a + np.pi) % TURN - np.pi


def same_turn_between(answer: Any, wanted: float) -> bool:  # noqa: ANN401
    """Check whether two turns are the same; half a turn to the left is half a turn to the right."""
    return close(answer, wanted) or (close(abs(wanted), np.pi) and close(abs(answer), np.pi))


def mistake_not_wrapped(a: float, b: float) -> object:
    """Return b - a, between -2π and 2π."""
    return b - a


def mistake_from_b_to_a(a: float, b: float) -> object:
    """Return a - b, wrapped to half a turn."""
    return (a - b + np.pi) % TURN - np.pi


def mistake_never_negative(a: float, b: float) -> object:
    """Return b - a, wrapped to 0 … 2π."""
    return (b - a) % TURN


def mistake_size_alone(a: float, b: float) -> object:
    """Return the absolute value of the wrapped difference."""
    return abs(right_turn_between(a, b))


def mistake_size_by_arccos(a: float, b: float) -> object:
    """Return arccos(cos(b - a)): also the absolute value, but inaccurate near 0 and π."""
    return np.arccos(np.clip(np.cos(b - a), -1, 1))


def mistake_half_turns_dropped(a: float, b: float) -> object:
    """Return b - a, wrapped to 0 … π by half turns."""
    return (b - a) % np.pi


# ---- nearest_twin


def draw_nearest_twin(rng: np.random.Generator) -> Arguments:
    """Draw the angles z, x, y of two frames: nearly the same, or near twins, plus whole turns."""
    previous = rng.uniform(-1, 1, 3) * [np.pi, 1.2, np.pi]
    # Nearly the same, not quite: then the twin is half a turn away, which could be written with either sign.
    angles = previous + rng.choice([1e-8, 1e-3, 0.05, 0.3]) * rng.uniform(-1, 1, 3)
    if rng.integers(2):
        angles = twin(angles)
    return previous, angles + TURN * rng.integers(-1, 2, 3)


def right_nearest_twin(previous: Array, angles: Array) -> Array:
    """Return the Euler angles of the second rotation that continue those of the first."""
    return np.asarray(euler.continuous("ZXY", np.stack([previous, angles]))[1])


def mistake_no_twin(previous: Array, angles: Array) -> object:
    """Return the given angles, with the whole turns that bring each nearest to the previous one."""
    return unwrapped(previous, angles)


def mistake_always_twin(previous: Array, angles: Array) -> object:
    """Return the twin, with whole turns, even if the given angles are nearer."""
    return unwrapped(previous, twin(angles))


def mistake_no_whole_turns(previous: Array, angles: Array) -> object:
    """Return the nearer of the given angles and their twin, both without whole turns."""
    return nearest_to(previous, angles, twin(angles))


def mistake_middle_angle_added(previous: Array, angles: Array) -> object:
    """Return the nearer of two candidates, the second (a + π, b + π, c + π) instead of the twin."""
    return nearest_to(previous, unwrapped(previous, angles), unwrapped(previous, angles + np.pi))


def mistake_angles_before(previous: Array, angles: Array) -> object:
    """Return the angles of the previous frame."""
    return np.asarray(previous)


# ---- chain


def draw_chain(rng: np.random.Generator) -> Arguments:
    """Draw slices of walks over the ground; the second sometimes follows the first in the same clip."""
    clips = [rng.uniform(-3, 3, 2) + rng.uniform(0.1, 0.4, (20, 2)).cumsum(axis=0) for _ in range(3)]
    parts = [(clip, int(rng.integers(0, 6)), int(rng.integers(8, 14))) for clip in clips]
    if rng.integers(2):
        parts[1] = (parts[0][0], parts[0][2], parts[0][2] + 4)
    return (parts,)


def right_chain(parts: list[Slice]) -> Array:
    """Start each slice where the clip before would have been; the moves add up."""
    moves = [np.zeros(2)]
    for (previous, _, end), (clip, start, _) in pairwise(parts):
        moves.append(previous[end] - clip[start])
    slices = [clip[start:stop] for clip, start, stop in parts]
    return np.concatenate([part + move for part, move in zip(slices, np.cumsum(moves, axis=0), strict=True)])


def mistake_frame_repeated(parts: list[Slice]) -> object:
    """Start each slice at the last position of the slice before, which then occurs twice."""
    moves = [np.zeros(2)]
    for (previous, _, end), (clip, start, _) in pairwise(parts):
        moves.append(previous[end - 1] - clip[start])
    slices = [clip[start:stop] for clip, start, stop in parts]
    return np.concatenate([part + move for part, move in zip(slices, np.cumsum(moves, axis=0), strict=True)])


def mistake_not_moved(parts: list[Slice]) -> object:
    """Join the slices at the positions that their clips store."""
    return np.concatenate([clip[start:stop] for clip, start, stop in parts])


def mistake_moves_not_added(parts: list[Slice]) -> object:
    """Start each slice where the clip before stores its frame `stop`, not where that was moved to."""
    moves = [np.zeros(2)]
    for (previous, _, end), (clip, start, _) in pairwise(parts):
        moves.append(previous[end] - clip[start])
    slices = [clip[start:stop] for clip, start, stop in parts]
    return np.concatenate([part + move for part, move in zip(slices, moves, strict=True)])


def mistake_frame_skipped(parts: list[Slice]) -> object:
    """Start each slice where the clip before would be at its frame `stop` + 1."""
    moves = [np.zeros(2)]
    for (previous, _, end), (clip, start, _) in pairwise(parts):
        moves.append(previous[end + 1] - clip[start])
    slices = [clip[start:stop] for clip, start, stop in parts]
    return np.concatenate([part + move for part, move in zip(slices, np.cumsum(moves, axis=0), strict=True)])
