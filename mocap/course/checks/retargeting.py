"""Checks of notebook 13."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.course.check import Check, Mistake, close_rotations


def _scaled(hips: Array, ratio: float, heights: tuple[float, float], centre: Array) -> Array:
    """Scale a way about a centre (x, z), and heights from one standing height to another."""
    scaled = np.array(hips)
    scaled[:, [0, 2]] = centre + ratio * (hips[:, [0, 2]] - centre)
    scaled[:, 1] = heights[1] + ratio * (hips[:, 1] - heights[0])
    return scaled


scaled_root = Check(
    name="scaled_root",
    asks="the new places of the hips: x and z scaled about the centre, heights over the standing ankles",
    start="how far are the hips from the centre over the ground, and how far above the ankles? Scale these, "
    "and put the new centre and the new ankles below.",
    draw=lambda rng: (
        rng.normal([0.3, 0.9, 2.0], [0.4, 0.03, 1.0], (6, 3)),
        rng.uniform(0.4, 0.8),
        *rng.uniform(0.04, 0.14, 2),
        rng.normal(size=2),
    ),
    truth=lambda hips, ratio, low_s, low_t, centre: _scaled(hips, ratio, (low_s, low_t), centre),
    mistakes=[
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: _scaled(hips, ratio, (0.0, 0.0), centre),
            "heights are scaled about the floor; the ankles of the new body then hang in the air or sink in. "
            "Scale what is above the ankles.",
        ),
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: _scaled(hips, ratio, (low_s, low_s), centre),
            "the new body's ankles stand at `low_t`, not at `low_s`.",
        ),
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: _scaled(hips, ratio, (low_t, low_s), centre),
            "the two ankles' heights are swapped: `low_s` is the source's.",
        ),
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: _scaled(hips, ratio, (low_s, low_t), np.zeros(2)),
            "x and z are scaled about the origin of the world: the new body starts elsewhere. Scale about "
            "the centre.",
        ),
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: np.stack(
                [hips[:, 0], _scaled(hips, ratio, (low_s, low_t), centre)[:, 1], hips[:, 2]], axis=1
            ),
            "the way over the ground stays as long as it was: the steps are too long for these legs.",
        ),
        Mistake(
            lambda hips, ratio, low_s, low_t, centre: _scaled(hips, 1 / ratio, (low_s, low_t), centre),
            "the ratio is the wrong way round: a ratio of 0.5 makes all ways half as long.",
        ),
    ],
)


def _turn(*factors: Array) -> Array:
    """Multiply quaternions."""
    product = factors[0]
    for factor in factors[1:]:
        product = rotations.multiply(product, factor)
    return product


def _quaternions(rng: np.random.Generator) -> tuple[Array, ...]:
    return tuple(rotations.from_rotvec(rng.normal(size=3)) for _ in range(3))


_back = rotations.inverse
bone_turn = Check(
    name="bone_turn",
    asks="the quaternion C with R_source C = A R_target, where both bodies stand",
    start="rotations do not commute, so say for each factor on which side of C it stands; to take one away, "
    "multiply both sides by its inverse, on that side.",
    draw=_quaternions,
    truth=lambda source, target, turn: _turn(_back(source), turn, target),
    same=close_rotations,
    mistakes=[
        Mistake(
            lambda source, target, turn: _turn(source, turn, target),
            "the source's stance is not taken off: multiply by its inverse on the left.",
        ),
        Mistake(
            lambda source, target, turn: _turn(_back(source), target, turn),
            "A stands on the wrong side: it turns the target as it stands in the world, so it stands on the "
            "left of the target's stance.",
        ),
        Mistake(
            lambda source, target, turn: _turn(_back(source), target),
            "A is missing: the bones of both bodies do not point the same way where they stand.",
        ),
        Mistake(
            lambda source, target, turn: _turn(turn, target, _back(source)),
            "the source's inverse stands on the wrong side: R_source C is the source's turn first in the "
            "product, so its inverse stands on the left of C.",
        ),
        Mistake(
            lambda source, target, turn: _back(_turn(_back(source), turn, target)),
            "that is the inverse of C: it goes from the target to the source.",
        ),
        Mistake(
            lambda source, target, turn: _turn(_back(source), _back(turn), target),
            "A goes from the target's bone to the source's already: do not invert it.",
        ),
    ],
)


def _weights(u: float) -> Array:
    """Give the four weights of the uniform cubic B-spline, from the earliest control point to the latest."""
    return np.array([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3]) / 6


def _catmull_rom(u: float) -> Array:
    return np.array([-u + 2 * u**2 - u**3, 2 - 5 * u**2 + 3 * u**3, u + 4 * u**2 - 3 * u**3, u**3 - u**2]) / 2


def _bernstein(u: float) -> Array:
    return np.array([(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3])


design_row = Check(
    name="design_row",
    asks="the four weights of the cubic B-spline, earliest control point first; they add up to 1",
    start="backwards in time, u becomes 1 - u, and the earliest control point becomes the latest one.",
    draw=lambda rng: (float(rng.uniform(0, 1)),),
    truth=_weights,
    mistakes=[
        Mistake(lambda u: 6 * _weights(u), "these weights add up to 6, not to 1."),
        Mistake(
            lambda u: _weights(u)[::-1],
            "the order is reversed: at u = 0 the latest control point has no weight yet.",
        ),
        Mistake(
            _catmull_rom,
            "these are Catmull and Rom's weights: they pass through the points, and their curvature jumps.",
        ),
        Mistake(
            _bernstein,
            "these are Bernstein's weights, of one Bézier curve; pieces side by side would have corners.",
        ),
        Mistake(
            lambda u: np.array([0, 1 - u, u, 0]),
            "that is linear: the speed jumps at each knot.",
        ),
    ],
)
