"""Random input and answers, right and wrong, of exercises about measured, edited and mixed motions."""

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


def draw_gap(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw how far two clips are apart, and weights that fall between frames of ones and of zeros."""
    steps = np.arange(1, int(rng.integers(8, 60)) + 1)
    falling = (1 - steps / len(steps)) ** rng.uniform(1.5, 4)  # it rarely passes 0.5 in the middle
    weights = np.concatenate([np.ones(3), falling, np.zeros(3)])
    return rng.normal(size=(len(weights), int(rng.integers(1, 7)))).cumsum(axis=0), weights


def added_terms(gap: Array, alpha: Array) -> tuple[Array, Array]:
    """Give both terms of the product rule by central differences."""
    slope, speed = (alpha[2:] - alpha[:-2]) / 2, (gap[2:] - gap[:-2]) / 2
    return np.diff(alpha, 2)[:, None] * gap[1:-1], 2 * slope[:, None] * speed


# ---- Notebook 09b


def draw_added_jolt(rng: np.random.Generator) -> tuple[Array, Array, Array, Array, float]:
    """Draw tracks of a joint in two clips, and a blend of them with a little noise."""
    first = rng.normal(size=(int(rng.integers(12, 40)), 3)).cumsum(axis=0)
    second = first + rng.normal(size=first.shape).cumsum(axis=0)
    window = len(first) - 8
    alpha = np.concatenate([np.ones(4), 1 - np.arange(1, window + 1) / window, np.zeros(4)])
    mixed = alpha[:, None] * first + (1 - alpha[:, None]) * second
    return mixed + 0.1 * rng.normal(size=first.shape), first, second, alpha, float(rng.integers(24, 121))


def added(result: Array, first: Array, second: Array, alpha: Array) -> Array:
    """Second differences of a blend without the mean of those of its clips, (F - 2, 3)."""
    share = alpha[:, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    return np.asarray(changes[0] - share * changes[1] - (1 - share) * changes[2])


# ---- Notebook 10


def draw_standing(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw speeds of a foot: swings, runs that almost stand, and plants."""
    levels = rng.permutation([4.0, 0.6, 4.0, 0.2, 4.0, 0.2, 4.0])
    speeds = np.concatenate([level * rng.uniform(0.6, 1.4, rng.integers(3, 8)) for level in levels])
    speeds[: len(speeds) - 2 : 9] = 0.7
    return speeds, 0.2, 0.9


# ---- Notebook 11


def draw_offset_curve(rng: np.random.Generator) -> tuple[Array, int, Array, Array]:
    """Draw a joint's rotations, a key, the pose asked for there (of either sign), and the shares."""
    q = from_rotvec(rng.normal(size=3) + rng.normal(scale=0.15, size=(20, 3)).cumsum(axis=0))
    key = int(rng.integers(5, 15))
    pose = multiply(q[key], from_rotvec(rng.normal(size=3))) * rng.choice([-1, 1])
    share = np.clip(1 - np.abs(np.arange(20) - key) / 6, 0, 1)
    return q, key, pose, share


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


def draw_plant_place(rng: np.random.Generator) -> tuple[Array, Mask]:
    """Draw places of a joint that rises and falls by 10 cm, and the frames in which it stands."""
    count, start = int(rng.integers(12, 24)), int(rng.integers(2, 5))
    planted = (np.arange(count) >= start) & (np.arange(count) < start + rng.integers(4, 7))
    positions = rng.normal(size=(count, 3)).cumsum(axis=0) * 0.02
    return positions + [0.0, 0.1, 0.0] * ~planted[:, None], planted


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


def draw_clip_gap(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw places (N, 3), and boxes: of no width, narrow and wide, some open on a side or on both."""
    places, low, ends = rng.normal(size=(8, 3)), rng.normal(size=(8, 3)), rng.random((2, 8, 3))
    high = low + rng.choice([0.0, 0.05, 1.0], (8, 3))
    return places, np.where(ends[0] < 0.3, -np.inf, low), np.where(ends[1] < 0.3, np.inf, high)


def to_the_middle(p: Array, low: Array, high: Array) -> Array:
    """Move to the middle of a box that is closed on both sides; elsewhere stay."""
    both = np.isfinite(low) & np.isfinite(high)
    return np.where(both, (np.where(both, low, 0) + np.where(both, high, 0)) / 2 - p, 0.0)


def draw_position_slope(rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """Draw F places of a joint and of an end below it, an axis in its own frame, and how it is turned."""
    turn, _ = np.linalg.qr(rng.normal(size=(5, 3, 3)))
    axis = rng.normal(size=3)
    turn *= np.linalg.det(turn)[:, None, None]
    return *rng.normal(size=(2, 5, 3)), axis / np.linalg.norm(axis), turn


def draw_local_fit(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the weights of N data on K splines, some of which no datum is near, and the data."""
    weights = np.zeros((6, 9))
    for row, first in enumerate(rng.integers(0, 4, 6)):
        weights[row, first : first + 4] = rng.dirichlet(np.ones(4))
    return weights, rng.normal(size=6)


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


def draw_shrink_box(rng: np.random.Generator) -> tuple[Array, Array, Array, float]:
    """Draw good targets in degrees and m/s, and bad ones near a side of them, the first just outside it."""
    scale = np.array([60.0, 0.4])
    good = rng.uniform([-50, 0.7], [50, 1.3], (12, 2))
    low, high = good.min(axis=0), good.max(axis=0)
    bad = rng.uniform(low + 0.05 * (high - low), high - 0.05 * (high - low), (4, 2))
    bad[0, 0] = low[0] - 0.005 * scale[0]
    return good, bad, scale, 0.01


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


def draw_standardise(rng: np.random.Generator) -> tuple[Array, list[slice], list[float]]:
    """Draw columns whose spreads differ within a group, and between groups by a hundred."""
    sizes = rng.integers(2, 5, rng.integers(2, 4))
    stops = np.cumsum(sizes)
    groups = [slice(int(stop - size), int(stop)) for size, stop in zip(sizes, stops, strict=True)]
    spreads = np.concatenate([10 ** rng.uniform(-1, 1) * rng.uniform(0.3, 3, size) for size in sizes])
    values = rng.normal(scale=spreads, size=(int(rng.integers(20, 40)), int(stops[-1]))) + 3 * spreads
    return values, groups, [float(weight) for weight in rng.uniform(0.3, 0.8, len(sizes))]


def next_frame(costs: Array, usable: Mask, now: int, near: int, bonus: float) -> int:
    """Go to the best usable frame that is not near, if it is better by more than the bonus."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - now) >= near))
    best = int(candidates[costs[candidates].argmin()])
    return now if costs[best] + bonus >= costs[now] else best


def draw_next_frame(rng: np.random.Generator) -> tuple[Array, Mask, int, int, float]:
    """Draw so few frames that the best is often not usable, too near, just far enough, or hardly better."""
    count, near = int(rng.integers(12, 18)), int(rng.integers(2, 5))
    now, usable = int(rng.integers(near, count - near)), rng.random(count) < 0.7
    usable[[0, -1]] = True  # of which one is far enough
    costs = rng.uniform(1.0, 3.0, count)
    costs[now] -= rng.integers(2)  # so that it is sometimes by far the best
    return costs, usable, now, near, float(rng.uniform(0.2, 0.6))
