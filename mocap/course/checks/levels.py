"""Checks of notebook 14."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake


def _box(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw places (N, 3), and boxes of every kind around, above and below them: held, free, half open."""
    places = rng.normal(size=(8, 3))
    low = places + rng.choice([-1.0, 1.0], (8, 3)) * rng.uniform(0.1, 1, (8, 3))
    high = low + rng.choice([0.0, 0.05], (8, 3))
    kind = rng.integers(0, 4, (8, 3))
    kind[0] = [1, 2, 3]  # each kind at least once
    low = np.where((kind == 1) | (kind == 3), -np.inf, low)
    high = np.where((kind == 2) | (kind == 3), np.inf, high)
    return places, low, high


def _gap(p: Array, low: Array, high: Array) -> Array:
    return np.asarray(np.clip(p, low, high) - p)


def _to_the_middle(p: Array, low: Array, high: Array) -> Array:
    both = np.isfinite(low) & np.isfinite(high)
    return np.where(both, (np.where(both, low, 0) + np.where(both, high, 0)) / 2 - p, 0.0)


clip_gap = Check(
    name="clip_gap",
    asks="the way from p into the box, axis by axis: 0 where p is between low and high",
    start="draw one axis with a box. From p, which point of the box is nearest, and which way leads there?",
    draw=_box,
    truth=_gap,
    mistakes=[
        Mistake(
            lambda p, low, high: p - np.clip(p, low, high), "the sign: p plus the gap must lie in the box."
        ),
        Mistake(
            lambda p, low, high: np.clip(p, low, high),
            "that is the nearest point of the box; the gap is the way to it from p.",
        ),
        Mistake(
            _to_the_middle,
            "that goes to the middle of the box, and forgets floors and ceilings: go only as far as needed.",
        ),
        Mistake(
            lambda p, low, high: np.maximum(low - p, 0.0),
            "a floor pushes up, but a ceiling must push down as well: use both low and high.",
        ),
        Mistake(
            lambda p, low, high: np.minimum(high - p, 0.0),
            "a ceiling pushes down, but a floor must push up as well: use both low and high.",
        ),
        Mistake(
            lambda p, low, high: np.where(low == high, 0.0, _gap(p, low, high)),
            "an axis with low equal to high is held at this number; it is not free.",
        ),
        Mistake(lambda p, low, high: np.abs(_gap(p, low, high)), "a gap has a direction: down is negative."),
    ],
)


def _joint(rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """Draw a joint, an end below it, an axis in the joint's own frame, and how the joint is turned."""
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    axis = rng.normal(size=3)
    return rng.normal(size=3), rng.normal(size=3), axis / np.linalg.norm(axis), turn * np.linalg.det(turn)


def _slope(joint: Array, end: Array, axis: Array, turn: Array) -> Array:
    return np.asarray(np.cross(turn @ axis, end - joint))


position_slope = Check(
    name="position_slope",
    asks="how fast the end moves, in metres per radian, when the joint turns about the axis",
    start="bring the axis into the world's frame. Which product of two vectors is at right angles to both?",
    draw=_joint,
    truth=_slope,
    mistakes=[
        Mistake(
            lambda joint, end, axis, turn: -_slope(joint, end, axis, turn),
            "the end moves the other way: axis × arm, and the arm goes from the joint to the end.",
        ),
        Mistake(
            lambda joint, end, axis, turn: np.cross(axis, end - joint),
            "the axis is given in the joint's own frame; the places are in the world's.",
        ),
        Mistake(
            lambda joint, end, axis, turn: np.cross(turn.T @ axis, end - joint),
            "that turns the axis the wrong way: the matrix leads from the joint's frame to the world's.",
        ),
        Mistake(
            lambda joint, end, axis, turn: np.cross(turn @ axis, end),
            "the arm starts at the joint that turns, not at the origin.",
        ),
        Mistake(
            lambda joint, end, axis, turn: turn @ np.cross(axis, end - joint),
            "the cross product mixes two frames: bring the axis into the world's frame first.",
        ),
    ],
)


def _data(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the weights of N data on K splines, some of which no datum is near, and the data."""
    weights = np.zeros((6, 9))
    for row, first in enumerate(rng.integers(0, 4, 6)):
        weights[row, first : first + 4] = rng.dirichlet(np.ones(4))
    return weights, rng.normal(size=6)


def _fit(weights: Array, data: Array, power: int = 2, axis: int = 1) -> Array:
    """Fit control points; `power` of the weights in the mean, `axis` over which squares are added."""
    squares = (weights**2).sum(axis=axis, keepdims=True)
    alone = np.divide(weights * data[:, None], squares, out=np.zeros_like(weights), where=squares > 0)
    above, below = (weights**power * alone).sum(axis=0), (weights**power).sum(axis=0)
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def _unguarded(weights: Array, data: Array) -> Array:
    with np.errstate(invalid="ignore"):
        alone = weights * data[:, None] / (weights**2).sum(axis=1, keepdims=True)
        return np.asarray((weights**2 * alone).sum(axis=0) / (weights**2).sum(axis=0))


def _mean_of_data(weights: Array, data: Array) -> Array:
    above, below = (weights * data[:, None]).sum(axis=0), weights.sum(axis=0)
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def _same(given: Array, wanted: Array) -> bool:
    """Check whether control points are the same; numbers that are none are the same only as themselves."""
    given, wanted = np.asarray(given, float), np.asarray(wanted, float)
    return given.shape == wanted.shape and np.allclose(given, wanted, rtol=1e-8, atol=1e-9, equal_nan=True)


local_fit = Check(
    name="local_fit",
    asks="the K heights c_i for which the sum is least, and 0 where a hill has no datum",
    start="the table of β has the shape of the weights. Then set the derivative of the sum by c_i to zero.",
    draw=_data,
    truth=_fit,
    same=_same,
    mistakes=[
        Mistake(
            lambda weights, data: _fit(weights, data, power=1),
            "the mean of what the data ask for is weighted by w², not by w.",
        ),
        Mistake(
            lambda weights, data: _fit(weights, data, axis=0),
            "β divides by the sum over the hills of its datum: a row of the weights, not a column.",
        ),
        Mistake(
            _unguarded,
            "where no datum is near, that is 0 divided by 0: give such a hill the height 0.",
        ),
        Mistake(
            _mean_of_data,
            "that is the mean of the data; the curve would fall short of a lonely datum. Use β.",
        ),
        Mistake(
            lambda weights, data: np.linalg.lstsq(weights, data, rcond=None)[0],
            "that is least squares over all hills together; here each one is found by itself.",
        ),
    ],
)
