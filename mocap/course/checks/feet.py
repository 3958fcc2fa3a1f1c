"""Random input and answers, right and wrong, for `04b-feet.toml`."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array

Marks = NDArray[np.bool_]


def stray(points: Array, planted: Marks, *, about: Array | None = None) -> float:
    """Measure the largest distance of planted points from their mean, or from another point, in cm."""
    centre = points[planted].mean(axis=0) if about is None else about
    return float(100 * np.linalg.norm(points[planted] - centre, axis=1).max())


def draw_plant_marks(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw the speed of a joint: slow and fast stretches with noise, and two thresholds."""
    level = np.repeat(rng.uniform(0.0, 1.0, 8), rng.integers(2, 6, 8))
    return np.abs(level + rng.normal(0, 0.08, len(level))), 0.25, 0.5


def grown(speed: Array, start: float, stay: float) -> Marks:
    """Mark frames below `start`, and grow the marks one frame at a time while the speed is below `stay`."""
    marks = speed < start
    for way in (1, -1):
        for before, frame in pairwise(range(len(speed))[::way]):
            marks[frame] |= marks[before] and speed[frame] < stay
    return marks


def inner(thigh: float, shank: float, distance: float) -> float:
    """Give the angle between thigh and shank, radians."""
    return float(np.arccos((thigh**2 + shank**2 - distance**2) / (2 * thigh * shank)))
