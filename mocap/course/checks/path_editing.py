"""Checks of notebook 12."""

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.course.check import Check, Mistake


def _steps(points: Array) -> Array:
    return np.asarray(np.linalg.norm(np.diff(points, axis=0), axis=1))


def _arc_length(points: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(_steps(points))])


arc_length = Check(
    name="arc_length",
    asks="the metres along the path of each point, as many numbers as there are points",
    start="np.diff gives the steps from point to point. How long is each, and how do they add up?",
    draw=lambda rng: (rng.normal(size=(rng.integers(4, 12), 2)).cumsum(axis=0),),
    truth=_arc_length,
    mistakes=[
        Mistake(
            lambda points: np.cumsum(_steps(points)),
            "the start is missing: the first point is 0 m along, and there is one number for each point.",
        ),
        Mistake(
            lambda points: np.concatenate([[0.0], np.cumsum(_steps(points) ** 2)]),
            "these are squares: take the root of each step before you add them up.",
        ),
        Mistake(
            lambda points: np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points, axis=0)).sum(axis=1))]),
            "x and z are not added: a step is as long as the hypotenuse of its two parts.",
        ),
        Mistake(
            lambda points: np.linalg.norm(points - points[0], axis=1),
            "that is the straight way from the start; add up the steps along the path.",
        ),
        Mistake(
            lambda points: np.concatenate([[0.0], _steps(points)]),
            "these are the single steps: add up all that come before.",
        ),
    ],
)


def _complex(rows: Array) -> Array:
    return np.asarray(rows[:, -1] + 1j * rows[:, -2])


def _pairs(ground: Array) -> Array:
    return np.stack([ground.imag, ground.real], axis=1)


def _carry(points: Array, old: Array, new: Array, *, mirrored: bool = False) -> Array:
    """Carry points from cart to cart; `mirrored` with the turns the wrong way round."""
    sign = -1 if mirrored else 1
    on_cart = np.exp(-1j * sign * old[:, 0]) * (_complex(points) - _complex(old))
    return _pairs(np.exp(1j * sign * new[:, 0]) * on_cart + _complex(new))


def _only_moved(points: Array, old: Array, new: Array) -> Array:
    return points + new[:, 1:] - old[:, 1:]


def _about_the_origin(points: Array, old: Array, new: Array) -> Array:
    """N⁻¹ N': the products in the wrong order."""
    there = np.exp(1j * new[:, 0]) * _complex(points) + _complex(new)
    return _pairs(np.exp(-1j * old[:, 0]) * (there - _complex(old)))


def _turned_in_place(points: Array, old: Array, new: Array) -> Array:
    """Turn about the origin by the difference of the headings, then move from cart to cart."""
    turn = np.exp(1j * (new[:, 0] - old[:, 0]))
    return _pairs(turn * _complex(points) + _complex(new) - _complex(old))


def _draw_carts(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    count = int(rng.integers(3, 9))
    carts = [rng.normal(size=(count, 3)) * [1.0, 2.0, 2.0] for _ in range(2)]
    return rng.normal(size=(count, 2)), carts[0], carts[1]


carry = Check(
    name="carry",
    asks="the points on the new path, shape (F, 2), as x and z",
    start="first find where each point is on the old cart: take its place away, then turn it back.",
    draw=_draw_carts,
    truth=_carry,
    mistakes=[
        Mistake(
            lambda points, old, new: _carry(points, old, new, mirrored=True),
            "it turns the other way round: headings go from +z towards +x, so use z + ix, not x + iz.",
        ),
        Mistake(
            _about_the_origin,
            "the order is wrong: the old cart is undone first, then comes the new one.",
        ),
        Mistake(_only_moved, "the carts also turn: a point beside the cart must stay beside it."),
        Mistake(
            _turned_in_place,
            "it turns about the origin: take the old cart's place away first, then turn, then add the new.",
        ),
        Mistake(
            lambda points, old, new: _carry(points, new, old),
            "that goes back from the new path to the old one.",
        ),
        Mistake(
            lambda points, old, new: _pairs(np.exp(-1j * old[:, 0]) * (_complex(points) - _complex(old))),
            "these are the points on the cart; now put the cart on the new path.",
        ),
        Mistake(
            lambda points, old, new: _carry(points, old, new)[:, ::-1],
            "x and z are swapped: the real part is z, and x comes first in the result.",
        ),
    ],
)


def _draw_plant(rng: np.random.Generator) -> tuple[Array, Mask]:
    count, start = int(rng.integers(12, 24)), int(rng.integers(2, 5))
    planted = (np.arange(count) >= start) & (np.arange(count) < start + rng.integers(4, 7))
    positions = rng.normal(size=(count, 3)).cumsum(axis=0) * 0.02
    return positions + [0.0, 0.1, 0.0] * ~planted[:, None], planted


plant_place = Check(
    name="plant_place",
    asks="one place (3,): the squares of its distances from the planted frames' places have the least sum",
    start="keep only the planted frames. From which point is the sum of squared distances least?",
    draw=_draw_plant,
    truth=lambda positions, planted: positions[planted].mean(axis=0),
    mistakes=[
        Mistake(
            lambda positions, planted: positions.mean(axis=0),
            "that is the mean over all frames; while it swings, the foot is elsewhere, and higher.",
        ),
        Mistake(
            lambda positions, planted: positions[planted][0],
            "that is the first planted frame's place; the last frame then needs the largest correction.",
        ),
        Mistake(
            lambda positions, planted: positions[planted][-1],
            "that is the last planted frame's place; the first frame then needs the largest correction.",
        ),
        Mistake(
            lambda positions, planted: positions[planted][planted.sum() // 2],
            "that is the middle frame's place; the mean needs smaller corrections.",
        ),
        Mistake(
            lambda positions, planted: np.array([1.0, 0.0, 1.0]) * positions[planted].mean(axis=0),
            "the height counts as well: a joint stands some centimetres above the floor, not on it.",
        ),
        Mistake(
            lambda positions, planted: (
                positions[planted].mean(axis=0) * [1, 0, 1] + positions.mean(axis=0) * [0, 1, 0]
            ),
            "the height is averaged with the swing: take it from the planted frames, too.",
        ),
    ],
)
