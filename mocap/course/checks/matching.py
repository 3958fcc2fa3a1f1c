"""Checks of notebook 02."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import Check, Mistake, close_angles
from mocap.matching.point_clouds import align


def _angles(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw angles in degrees, among them two that are equal and two that are half a turn apart."""
    a, b = rng.uniform(-180, 180, (2, int(rng.integers(4, 9))))
    a[:2] = rng.integers(-180, 180, 2)
    b[0], b[1] = a[0], a[1] - 180 * np.copysign(1, a[1])
    return a, b


angle_gap = Check(
    name="angle_gap",
    asks="the differences a - b in degrees, wrapped to [-180, 180)",
    start="how far is it from 179° to -179°? Subtract, then think of the remainder `%`.",
    draw=_angles,
    truth=lambda a, b: (a - b + 180) % 360 - 180,
    mistakes=[
        Mistake(lambda a, b: a - b, "179° and -179° are 2° apart, not 358°: whole turns do not count."),
        Mistake(
            lambda a, b: np.abs(a - b),
            "179° and -179° are 2° apart, not 358°; and the differences have signs, so do not remove them.",
        ),
        Mistake(
            lambda a, b: 180 - (b - a + 180) % 360,
            "right but for half a turn: the range is [-180, 180), so half a turn is -180, not 180.",
        ),
        Mistake(
            lambda a, b: (a - b) % 360,
            "that goes from 0 to 360, so -1° counts as 359°; the range should end at 180.",
        ),
        Mistake(lambda a, b: (b - a + 180) % 360 - 180, "that is b - a: all signs are reversed."),
        Mistake(
            lambda a, b: np.abs((a - b + 180) % 360 - 180),
            "the differences have signs; do not remove them.",
        ),
        Mistake(
            lambda a, b: (a - b + np.pi) % (2 * np.pi) - np.pi,
            "a whole turn is 360 here: these angles are in degrees.",
        ),
    ],
)


def _clouds(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a cloud, and the same cloud turned and moved; two times in three also changed a little.

    One cloud in four is turned by half a turn, and one in four not at all.
    """
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    angle = rng.choice([0.0, np.pi, *rng.uniform(-np.pi, np.pi, 2)])
    moved = PlanarTransform(angle, *rng.normal(size=2)).apply_points(points)
    return points, moved + rng.normal(size=points.shape) * rng.choice([0.0, 0.1, 0.1])


def _turned(points: Array, angle: float) -> Array:
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points)


def _gap(points: Array, others: Array) -> Array:
    """Move from the mean of one cloud to that of another over the ground: (x, z)."""
    return np.asarray((points.mean(0) - others.mean(0))[[0, 2]])


best_shift = Check(
    name="best_shift",
    asks="the best shift (x0, z0) after the others are turned by the angle",
    start="turn the mean of the others; the shift leads from there to the mean of the points.",
    draw=lambda rng: (*_clouds(rng), rng.uniform(-np.pi, np.pi)),
    truth=lambda points, others, angle: _gap(points, _turned(others, angle)),
    mistakes=[
        Mistake(
            lambda points, others, angle: _gap(points, others),
            "the others are turned before they are moved: turn their mean first.",
        ),
        Mistake(
            lambda points, others, angle: _gap(points, _turned(others, -angle)),
            "your turn goes in the wrong direction: look at the signs of the sines in T.",
        ),
        Mistake(
            lambda points, others, angle: _gap(_turned(others, angle), points),
            "that moves the points onto the others: reverse the sign.",
        ),
        Mistake(
            lambda points, others, angle: _gap(points, _turned(others, angle)) * len(points),
            "these are sums, not means: divide by the sum of the weights.",
        ),
        Mistake(
            lambda points, others, angle: _gap(points, _turned(others, angle))[::-1],
            "the order is wrong: x0 first, then z0.",
        ),
    ],
)


def _parts(points: Array, others: Array) -> tuple[float, float]:
    """Give Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    (x, _, z), (other_x, _, other_z) = points.T, others.T
    return float((x * other_z - other_x * z).sum()), float((x * other_x + z * other_z).sum())


def _centred(points: Array, others: Array) -> tuple[float, float]:
    return _parts(points - points.mean(0), others - others.mean(0))


best_angle = Check(
    name="best_angle",
    asks="the angle θ by which the others must be turned",
    start="subtract each cloud's mean first; then take np.arctan2 of two sums.",
    draw=_clouds,
    truth=lambda points, others: align(points, others).angle,
    mistakes=[
        Mistake(
            lambda points, others: np.arctan2(*_parts(points, others)),
            "you did not centre: the means of these clouds are not 0. Subtract each cloud's mean first.",
        ),
        Mistake(
            lambda points, others: -np.arctan2(*_centred(points, others)),
            "the sign of θ is wrong: you turn the points onto the others. Which product has the minus?",
        ),
        Mistake(
            lambda points, others: np.arctan2(*_centred(points, others)[::-1]),
            "np.arctan2 takes the sine's part first, then the cosine's.",
        ),
        Mistake(
            lambda points, others: np.arctan(np.divide(*_centred(points, others))),
            "right only for turns below 90°: a quotient does not show which of B and A is negative.",
        ),
        Mistake(
            lambda points, others: np.arctan2(*_centred(points[:, [0, 2, 1]], others[:, [0, 2, 1]])),
            "y is up here: the ground has x and z, columns 0 and 2.",
        ),
    ],
    same=close_angles,
)
