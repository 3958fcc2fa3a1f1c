"""Checks of notebook 03."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

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


undo = Check(
    name="undo",
    asks="the three numbers (angle, x, z) of the transform that moves everything back",
    start="solve p' = R p + t for p: which angle and which shift does the solution have?",
    draw=lambda rng: tuple(rng.uniform(-3, 3, 3)),
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
    first, second = (tuple(rng.uniform(-3, 3, 3).tolist()) for _ in range(2))
    return first, second


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
    asks="the angle, x and z of the transform that lays `moving` on `target`",
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
            "that lays `target` on `moving`; it is `moving` that should move.",
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


def _wrapped(angle: float) -> float:
    return (angle + np.pi) % (2 * np.pi) - np.pi


turn_between = Check(
    name="turn_between",
    asks="the shorter turn from a to b, in [-π, π), above 0 to the left",
    start="subtract, then add or subtract whole turns until the result lies between -π and π.",
    draw=lambda rng: tuple(rng.uniform(-np.pi, np.pi, 2)),
    truth=lambda a, b: _wrapped(b - a),
    mistakes=[
        Mistake(
            lambda a, b: b - a,
            "for 170° and -170° that is -340°, nearly a whole turn in the wrong direction.",
        ),
        Mistake(lambda a, b: _wrapped(a - b), "the sign is wrong: that is the turn from b to a."),
        Mistake(
            lambda a, b: (b - a) % (2 * np.pi),
            "that lies between 0 and 2π: a turn of 10° to the right becomes 350° to the left.",
        ),
        Mistake(
            lambda a, b: abs(_wrapped(b - a)),
            "left and right look the same in your answer: keep the sign.",
        ),
    ],
)


def _around(rng: np.random.Generator) -> tuple[Array]:
    middle = np.pi + rng.uniform(-0.3, 0.3)
    headings = middle + rng.uniform(-0.8, 0.8, int(rng.integers(3, 9)))
    return ((headings + np.pi) % (2 * np.pi) - np.pi,)


def _mean_vector(headings: ArrayLike) -> tuple[float, float]:
    return float(np.sin(headings).mean()), float(np.cos(headings).mean())


mean_heading = Check(
    name="mean_heading",
    asks="the mean direction, in radians",
    start="a heading is a point on the circle, (sin θ, cos θ); take the mean of the points, and its angle.",
    draw=_around,
    truth=lambda headings: np.arctan2(*_mean_vector(headings)),
    mistakes=[
        Mistake(
            lambda headings: np.mean(headings),
            "this way the mean of 170° and -170° is 0°, the opposite of where both look.",
        ),
        Mistake(
            lambda headings: np.arctan2(*_mean_vector(headings)[::-1]),
            "sine and cosine are swapped: arctan2 takes the sine first.",
        ),
        Mistake(
            lambda headings: np.arctan(np.divide(*_mean_vector(headings))),
            "arctan covers only half the circle; arctan2 takes sine and cosine and covers all of it.",
        ),
        Mistake(
            lambda headings: np.median(headings),
            "the median also cuts the circle at ±180°: headings on a circle have no order.",
        ),
    ],
    same=close_angles,
)
