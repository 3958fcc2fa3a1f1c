"""Answers, right and wrong, of exercises about measured, edited and mixed motions."""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask, Points
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


# ---- Notebook 09


def added_terms(gap: Array, alpha: Array) -> tuple[Array, Array]:
    """Give both terms of the product rule by central differences."""
    slope, speed = (alpha[2:] - alpha[:-2]) / 2, (gap[2:] - gap[:-2]) / 2
    return np.diff(alpha, 2)[:, None] * gap[1:-1], 2 * slope[:, None] * speed


# ---- Notebook 09b


def added(result: Array, first: Array, second: Array, alpha: Array) -> Array:
    """Second differences of a blend without the mean of those of its clips, (F - 2, 3)."""
    share = alpha[:, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    return np.asarray(changes[0] - share * changes[1] - (1 - share) * changes[2])


# ---- Notebook 11


def long_way(quaternion: Array) -> Array:
    """Give a rotation vector without taking the shorter of the two ways."""
    w, v = quaternion[0], quaternion[1:]
    return np.asarray(2 * np.arctan2(np.linalg.norm(v), w) * v / np.linalg.norm(v))


def cardinal(at: Array, values: Array, tension: float) -> Array:
    """Give the slopes of a cardinal spline: of each key those of its neighbours' chord, at the ends none."""
    slopes = np.zeros(len(at))
    slopes[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / (at[2:] - at[:-2])
    return slopes


# ---- Notebook 12


def as_complex(rows: Array) -> Array:
    """Read places on the ground as complex numbers z + ix."""
    return np.asarray(rows[:, -1] + 1j * rows[:, -2])


def as_rows(ground: Array) -> Array:
    """Write complex numbers z + ix as rows (x, z)."""
    return np.stack([ground.imag, ground.real], axis=1)


def carry(points: Array, old: Array, new: Array) -> Array:
    """Carry points from cart to cart."""
    on_cart = np.exp(-1j * old[:, 0]) * (as_complex(points) - as_complex(old))
    return as_rows(np.exp(1j * new[:, 0]) * on_cart + as_complex(new))


# ---- Notebook 13


def scaled_way(hips: Array, ratio: float, heights: tuple[float, float], centre: Array) -> Array:
    """Scale a way about a centre (x, z), and heights from one standing height to another."""
    scaled = np.array(hips)
    scaled[:, [0, 2]] = centre + ratio * (hips[:, [0, 2]] - centre)
    scaled[:, 1] = heights[1] + ratio * (hips[:, 1] - heights[0])
    return scaled


def product(*quaternions: Array) -> Array:
    """Multiply quaternions from left to right."""
    return reduce(multiply, quaternions)


# ---- Notebook 14


def to_the_middle(p: Array, low: Array, high: Array) -> Array:
    """Move to the middle of a box that is closed on both sides; elsewhere stay."""
    both = np.isfinite(low) & np.isfinite(high)
    return np.where(both, (np.where(both, low, 0) + np.where(both, high, 0)) / 2 - p, 0.0)


def fit(weights: Array, data: Array) -> Array:
    """Fit control points: what each datum alone asks for, in the mean by the squares of the weights."""
    squares = (weights**2).sum(axis=1, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above, below = (weights**2 * alone).sum(axis=0), (weights**2).sum(axis=0)
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


# ---- Notebook 17


def integrated(speed: Points, turning: Array, dt: float) -> Points:
    """Add up steps of a speed, each along the heading that the turns before it give."""
    heading = np.concatenate([[0], np.cumsum(turning * dt)])
    return np.concatenate([[0], np.cumsum(speed * np.exp(1j * heading[:-1]) * dt)])


def weighed(asked: float, at: Array, low: Array, high: Array, k: int) -> tuple[float, float]:
    """Mix two values of the k nearest samples by 1 / d - 1 / d_k."""
    near = np.argsort(np.abs(at - asked))[:k]
    gaps = np.abs(at - asked)[near]
    weights = 1 / gaps - 1 / gaps[-1]
    weights = weights / weights.sum()
    return float(weights @ low[near]), float(weights @ high[near])


# ---- Notebook 18


def standardised(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    """Divide each group of columns by its mean spread, and weight it."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() * weight
    return np.asarray(scaled)


def next_frame(costs: Array, usable: Mask, now: int, near: int, bonus: float) -> int:
    """Go to the best usable frame that is not near, if it is better by more than the bonus."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - now) >= near))
    best = int(candidates[costs[candidates].argmin()])
    return now if costs[best] + bonus >= costs[now] else best
