"""Checks of notebook 02."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import Check, Mistake, close_angles
from mocap.matching.point_clouds import align

angle_gap = Check(
    name="angle_gap",
    asks="the differences a - b in degrees, wrapped to [-180, 180)",
    start="how far is it from 179° to -179°? Subtract, then think of the remainder `%`.",
    draw=lambda rng: tuple(rng.uniform(-180, 180, (2, rng.integers(4, 9)))),
    truth=lambda a, b: (a - b + 180) % 360 - 180,
    mistakes=[
        Mistake(lambda a, b: a - b, "179° and -179° are 2° apart, not 358°: whole turns do not count."),
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
    """Make a cloud, and the same cloud turned, moved and changed a little, all at random."""
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    way = PlanarTransform(rng.uniform(-np.pi, np.pi), *rng.normal(size=2))
    return points, way.apply_points(points) + rng.normal(size=points.shape) * 0.1


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


def _sums(products: Array, window: int, *, step: int = 1) -> Array:
    """Add up products[i + f, j + step f] over a window's frames, as far as a window fits."""
    rows, columns = (count - window + 1 for count in products.shape)
    first = 0 if step >= 0 else window - 1
    each = [products[f : f + rows, first + step * f : first + step * f + columns] for f in range(window)]
    return np.asarray(np.sum(each, axis=0))


window_sums = Check(
    name="window_sums",
    asks="the sums of products[i + f, j + f] over the frames f of a window",
    start="shift the whole array by f rows and f columns, and add up. How many windows fit?",
    draw=lambda rng: (rng.normal(size=rng.integers(7, 12, 2)), int(rng.integers(2, 5))),
    truth=_sums,
    mistakes=[
        Mistake(
            lambda products, window: _sums(products, window - 1),
            "off by one: a window has the frames f = 0 to window - 1, and fits F - window + 1 times.",
        ),
        Mistake(
            lambda products, window: _sums(products, window + 1),
            "your windows are one frame too long: f runs from 0 to window - 1.",
        ),
        Mistake(
            lambda products, window: _sums(products, window)[:-1, :-1],
            "the last window is missing: F frames have F - window + 1 windows.",
        ),
        Mistake(
            lambda products, window: _sums(products, window, step=0),
            "that goes down the columns; both frames advance together, along the diagonal.",
        ),
        Mistake(
            lambda products, window: _sums(products, window, step=-1),
            "that is the other diagonal: one clip would run backwards.",
        ),
        Mistake(
            lambda products, window: _sums(products, window) / window, "that is the mean; a sum is asked for."
        ),
    ],
)
