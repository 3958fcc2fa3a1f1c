"""Random input and answers, right and wrong, for `03-transforms.toml`."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import close, close_angles

Placed = tuple[float, float, float]


def same_transform(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare (angle, x, z), the angles up to whole turns."""
    angle, *shift = given
    return len(shift) == 2 and close_angles(angle, wanted[0]) and close(shift, wanted[1:])


def draw_move_points(rng: np.random.Generator) -> tuple[Array, float, float, float]:
    angle, x, z = rng.uniform(-3, 3, 3)
    return rng.normal(size=(int(rng.integers(1, 9)), 3)), angle, x, z


def draw_undo(rng: np.random.Generator) -> tuple[float, float, float]:
    """Draw a transform; now and then half a turn, or none."""
    angle, x, z = rng.uniform(-3, 3, 3).tolist()
    return (0.0, np.pi, *[angle] * 8)[int(rng.integers(10))], x, z


def turned_shift(angle: float, x: float, z: float) -> tuple[float, float]:
    moved = PlanarTransform(angle, 0.0, 0.0).apply_points([x, 0, z])
    return float(moved[0]), float(moved[2])


def draw_lay_on(rng: np.random.Generator) -> tuple[Placed, Placed]:
    """Draw two placed bodies; now and then the same heading, the opposite one, or the same place."""
    first, second = (tuple(rng.uniform(-3, 3, 3).tolist()) for _ in range(2))
    special = [(first[0], *second[1:]), (first[0] + np.pi, *second[1:]), first]
    return first, (*special, *[second] * 9)[int(rng.integers(12))]


def lay_on(moving: Placed, target: Placed) -> Placed:
    angle = target[0] - moving[0]
    x, z = turned_shift(angle, *moving[1:])
    return angle, target[1] - x, target[2] - z


def draw_put_over(rng: np.random.Generator) -> tuple[Array, float, Array]:
    """Draw a path of roots, a turn, and a spot with a height of its own."""
    steps = rng.normal(0, 0.1, (int(rng.integers(2, 8)), 3))
    return steps.cumsum(axis=0) + rng.uniform(-2, 2, 3), float(rng.uniform(-3, 3)), rng.uniform(-2, 2, 3)


def put(roots: Array, angle: float, spot: Array) -> Array:
    """Turn roots, and move the first one over the spot, each as high as it was."""
    turned = PlanarTransform(angle, 0.0, 0.0).apply_points(roots)
    return np.asarray(turned + (spot - turned[0]) * [1, 0, 1])
