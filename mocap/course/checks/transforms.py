"""Checks of notebook 03-transforms."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import Check, Mistake, close, close_angles

Placed = tuple[float, float, float]


def _same_transform(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare (angle, x, z), the angles up to whole turns."""
    angle, *shift = given
    return len(shift) == 2 and close_angles(angle, wanted[0]) and close(shift, wanted[1:])


def _points(rng: np.random.Generator) -> tuple[Array, float, float, float]:
    angle, x, z = rng.uniform(-3, 3, 3)
    return rng.normal(size=(int(rng.integers(1, 9)), 3)), angle, x, z


def _moved_first(points: Array, angle: float, x: float, z: float) -> Array:
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points + np.array([x, 0, z]))


move_points = Check(
    name="move_points",
    asks="the moved points, shape (N, 3)",
    start="take the columns x, y, z; write the two lines of the formula; put them together with np.stack.",
    draw=_points,
    truth=lambda points, angle, x, z: PlanarTransform(angle, x, z).apply_points(points),
    mistakes=[
        Mistake(
            lambda points, angle, x, z: PlanarTransform(-angle, x, z).apply_points(points),
            "the sign of θ is wrong: a positive turn about +y moves the z axis towards the x axis.",
        ),
        Mistake(
            _moved_first,
            "you move first and turn afterwards, so the turn also changes the move; turn first.",
        ),
        Mistake(
            lambda points, angle, x, z: (
                PlanarTransform(angle, 0, 0).apply_points(points) + np.array([x, z, 0])
            ),
            "the second column is y, the height: the ground is columns 0 and 2.",
        ),
        Mistake(
            lambda points, angle, x, z: PlanarTransform(angle, 0, 0).apply_points(points),
            "the points are turned, but not moved.",
        ),
    ],
)


def _numbers(rng: np.random.Generator) -> tuple[float, float, float]:
    """Draw a transform; now and then half a turn, or none."""
    angle, x, z = rng.uniform(-3, 3, 3).tolist()
    return (0.0, np.pi, *[angle] * 8)[int(rng.integers(10))], x, z


undo = Check(
    name="undo",
    asks="the three numbers (angle, x, z) of the transform that moves everything back",
    start="solve p' = R p + t for p: which angle and which shift does the solution have?",
    draw=_numbers,
    truth=lambda angle, x, z: tuple(PlanarTransform(angle, x, z).inverse()),
    mistakes=[
        Mistake(
            lambda angle, x, z: (-angle, -x, -z),
            "minus each number undoes turn and shift in the wrong order: turn the shift back as well.",
        ),
        Mistake(
            lambda angle, x, z: (-angle, *_turned(angle, -x, -z)),
            "the shift is turned the wrong way: R⁻¹ turns by -θ.",
        ),
        Mistake(
            lambda angle, x, z: (-angle, *_turned(-angle, x, z)),
            "the sign of the shift is wrong: p = R⁻¹ p' - R⁻¹ t.",
        ),
        Mistake(
            lambda angle, x, z: (angle, *_turned(-angle, -x, -z)),
            "the sign of the angle is wrong: the inverse turns in the opposite direction.",
        ),
    ],
    same=_same_transform,
)


def _turned(angle: float, x: float, z: float) -> tuple[float, float]:
    moved = PlanarTransform(angle, 0.0, 0.0).apply_points([x, 0, z])
    return float(moved[0]), float(moved[2])


def _places(rng: np.random.Generator) -> tuple[Placed, Placed]:
    """Draw two placed bodies; now and then the same heading, the opposite one, or the same place."""
    first, second = (tuple(rng.uniform(-3, 3, 3).tolist()) for _ in range(2))
    special = [(first[0], *second[1:]), (first[0] + np.pi, *second[1:]), first]
    return first, (*special, *[second] * 9)[int(rng.integers(12))]


def _lay_on(moving: Placed, target: Placed) -> Placed:
    angle = target[0] - moving[0]
    x, z = _turned(angle, *moving[1:])
    return angle, target[1] - x, target[2] - z


def _turned_otherwise(moving: Placed, target: Placed) -> Placed:
    angle = moving[0] - target[0]
    x, z = _turned(angle, *moving[1:])
    return angle, target[1] - x, target[2] - z


lay_on = Check(
    name="lay_on",
    asks="the angle, x and z of the transform that aligns `moving` with `target`",
    start="find the angle first. Turn the moving (x, z) by it, and see how far the target still is.",
    draw=_places,
    truth=_lay_on,
    mistakes=[
        Mistake(
            lambda moving, target: (target[0] - moving[0], target[1] - moving[1], target[2] - moving[2]),
            "the turn is about the origin, so it also moves the body: measure the shift from where the body "
            "is after the turn.",
        ),
        Mistake(
            lambda moving, target: _lay_on(target, moving),
            "that aligns `target` with `moving`; it is `moving` that should move.",
        ),
        Mistake(
            _turned_otherwise,
            "the sign of the angle is wrong: it must turn the moving heading to the target's.",
        ),
        Mistake(
            lambda moving, target: (target[0], *_lay_on((0.0, *moving[1:]), target)[1:]),
            "the moving body has a heading already; turn by the difference.",
        ),
    ],
    same=_same_transform,
)


def _roots(rng: np.random.Generator) -> tuple[Array, float, Array]:
    """Draw a path of roots, a turn, and a spot with a height of its own."""
    steps = rng.normal(0, 0.1, (int(rng.integers(2, 8)), 3))
    return steps.cumsum(axis=0) + rng.uniform(-2, 2, 3), float(rng.uniform(-3, 3)), rng.uniform(-2, 2, 3)


def _put(roots: Array, angle: float, spot: Array, level: tuple[float, float, float] = (1, 0, 1)) -> Array:
    """Turn roots, and move the first one over the spot, in the coordinates where `level` is 1."""
    turned = PlanarTransform(angle, 0.0, 0.0).apply_points(roots)
    return np.asarray(turned + (spot - turned[0]) * level)


put_over = Check(
    name="put_over",
    asks="new roots, shape (F, 3): turned, the first one over the spot, and each as high as it was",
    start="make a new array of turned roots; then add what is missing to the spot, in x and z only.",
    draw=_roots,
    truth=_put,
    mistakes=[
        Mistake(
            lambda roots, angle, spot: _put(roots, angle, spot, (1, 1, 1)),
            "bug one is still there: your function also moves the height, by spot[1] - roots[0, 1].",
        ),
        Mistake(
            lambda roots, angle, spot: _put(roots, angle, spot) * [1, 0, 1],
            "the heights are lost: each root must stay as high as it was.",
        ),
        Mistake(
            lambda roots, angle, spot: _put(roots, angle, spot) - [0, roots[0, 1], 0],
            "all heights have changed by that of the first root: leave column 1 as it was.",
        ),
        Mistake(
            lambda roots, angle, spot: PlanarTransform(angle, 0, 0).apply_points(
                roots + (spot - roots[0]) * [1, 0, 1]
            ),
            "you move first and turn afterwards, so the turn carries the roots away from the spot.",
        ),
        Mistake(
            lambda roots, angle, spot: _put(roots, -angle, spot),
            "the sign of the turn is wrong: a positive angle turns the z axis towards the x axis.",
        ),
        Mistake(
            lambda roots, angle, spot: roots + (spot - roots[0]) * [1, 0, 1],
            "the roots are moved, but not turned.",
        ),
    ],
)
