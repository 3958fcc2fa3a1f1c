"""Inputs, comparisons and parts of answers of more than one notebook."""

from itertools import pairwise
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body.planar import PlanarTransform
from mocap.course.comparisons import close, close_angles

Arguments = tuple[Any, ...]
"""The arguments of one call of a student's function."""


def normalised(q: Array) -> Array:
    """Divide quaternions by their lengths."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def clouds(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw a cloud, and the same cloud rotated and translated; two times in three also changed a little.

    One cloud in four is rotated by half a turn, and one in four not at all.
    """
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    angle = rng.choice([0.0, np.pi, *rng.uniform(-np.pi, np.pi, 2)])
    moved = PlanarTransform(angle, *rng.normal(size=2)).apply_points(points)
    return points, moved + rng.normal(size=points.shape) * rng.choice([0.0, 0.1, 0.1])


def turned(points: Array, angle: float) -> Array:
    """Rotate points about the vertical axis."""
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points)


def same_pose(answer: Any, wanted: tuple[float, ...]) -> bool:  # noqa: ANN401
    """Compare (angle, x, z), the angles up to whole turns."""
    angle, *shift = answer
    return len(shift) == 2 and close_angles(angle, wanted[0]) and close(shift, wanted[1:])


def grown(speed: Array, start: float, stay: float, directions: tuple[int, ...] = (1, -1)) -> Mask:
    """Mark frames below `start`, and extend the marks frame by frame while the speed is below `stay`."""
    marks = speed < start
    for direction in directions:
        for previous, frame in pairwise(range(len(speed))[::direction]):
            marks[frame] |= marks[previous] and speed[frame] < stay
    return marks


def draw_odds(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of going from segment to segment, some without successor, and a length."""
    count = int(rng.integers(3, 9))
    odds = rng.random((count, count))
    odds[rng.random((count, count)) >= 0.5] = 0
    odds[rng.integers(count)] = 0
    return odds / np.maximum(odds.sum(axis=1, keepdims=True), 1e-9), int(rng.integers(2, 9))


def draw_graph(rng: np.random.Generator) -> dict[int, list[int]]:
    """Draw a graph of three to eight nodes, with about one edge each."""
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}
