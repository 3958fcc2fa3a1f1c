"""Answers, right and wrong, of exercises about measured, edited and mixed motions."""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Array, Mask, Points
from mocap.body.rotations import from_rotvec, inverse, multiply, to_rotvec
from mocap.methods.motion_matching.nearest_frames import spring
from mocap.methods.parametric_graphs.parametric_edges import shrink_box

# ---- Notebook 04b


def grown(speed: Array, start: float, stay: float, ways: tuple[int, ...] = (1, -1)) -> Mask:
    """Mark frames below `start`, and grow the marks one frame at a time while the speed is below `stay`."""
    marks = speed < start
    for way in ways:
        for before, frame in pairwise(range(len(speed))[::way]):
            marks[frame] |= marks[before] and speed[frame] < stay
    return marks


# ---- Notebook 11


def long_way(quaternion: Array) -> Array:
    """Give a rotation vector without taking the shorter of the two ways."""
    w, v = quaternion[0], quaternion[1:]
    return np.asarray(2 * np.arctan2(np.linalg.norm(v), w) * v / np.linalg.norm(v))


# ---- Notebook 12


def as_complex(rows: Array) -> Array:
    """Read places on the ground as complex numbers z + ix."""
    return np.asarray(rows[:, -1] + 1j * rows[:, -2])


def as_rows(ground: Array) -> Array:
    """Write complex numbers z + ix as rows (x, z)."""
    return np.stack([ground.imag, ground.real], axis=1)


# ---- Notebook 13


def product(*quaternions: Array) -> Array:
    """Multiply quaternions from left to right."""
    return reduce(multiply, quaternions)


# ---- Notebook 14


def to_the_middle(p: Array, low: Array, high: Array) -> Array:
    """Move to the middle of a box that is closed on both sides; elsewhere stay."""
    both = np.isfinite(low) & np.isfinite(high)
    return np.where(both, (np.where(both, low, 0) + np.where(both, high, 0)) / 2 - p, 0.0)


# ---- Notebook 17


def integrated(speed: Points, turning: Array, dt: float) -> Points:
    """Add up steps of a speed, each along the heading that the turns before it give."""
    heading = np.concatenate([[0], np.cumsum(turning * dt)])
    return np.concatenate([[0], np.cumsum(speed * np.exp(1j * heading[:-1]) * dt)])


# ---- Notebook 18


def standardised(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    """Divide each group of columns by its mean spread, and weight it."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() * weight
    return np.asarray(scaled)
