"""Random input and answers, right and wrong, of exercises about what is measured."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask

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
