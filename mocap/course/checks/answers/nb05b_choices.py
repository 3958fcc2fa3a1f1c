"""Notebook 05b: answers and mistakes of `inverse_shares`, `chance_to_last` and `turning_point`."""

from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments, draw_odds

# ---- inverse_shares


def draw_inverse_shares(rng: np.random.Generator) -> Arguments:
    """Draw some costs, and the probability that their shares add up to."""
    return rng.uniform(100, 400, rng.integers(1, 9)), float(rng.choice([0.5, 1.0]))


def right_inverse_shares(costs: Array, rest: float) -> Array:
    """Return shares proportional to the inverse of each cost."""
    return rest / costs / np.sum(1 / costs)


def mistake_proportional(costs: Array, rest: float) -> object:
    """Return shares proportional to the costs, with the sum `rest`."""
    return rest * costs / np.sum(costs)


def mistake_all_shared(costs: Array, rest: float) -> object:
    """Return shares proportional to the inverse of each cost, with the sum 1 instead of `rest`."""
    return 1 / costs / np.sum(1 / costs)


def mistake_times_left(costs: Array, rest: float) -> object:
    """Return `rest` over each cost, without the division by the sum."""
    return rest / costs


def mistake_not_divided(costs: Array, rest: float) -> object:
    """Return the inverse of each cost, whatever their sum and `rest`."""
    return 1 / costs


def mistake_one_minus_share(costs: Array, rest: float) -> object:
    """Return rest (1 - D/ΣD) for each cost D, with the sum (n - 1) rest for n costs."""
    return rest * (1 - costs / np.sum(costs))


# ---- chance_to_last


def draw_chance_to_last(rng: np.random.Generator) -> Arguments:
    """Draw the probabilities of a Markov chain that can end, and a number of segments."""
    return draw_odds(rng)


def right_chance_to_last(probabilities: Array, count: int) -> float:
    """Return the probability that a walk from a random start has so many segments."""
    return float(np.linalg.matrix_power(probabilities, count - 1).sum(axis=1).mean())


def mistake_step_too_many(probabilities: Array, count: int) -> object:
    """Return the probability of at least count + 1 segments, by the matrix power `count`."""
    return np.linalg.matrix_power(probabilities, count).sum(axis=1).mean()


def mistake_probability_to_end(probabilities: Array, count: int) -> object:
    """Return the probability that the walk has fewer segments."""
    return 1 - right_chance_to_last(probabilities, count)


def mistake_entrywise_power(probabilities: Array, count: int) -> object:
    """Raise each entry, not the matrix, to the power count - 1, and return the mean of the row sums."""
    return np.sum(probabilities ** (count - 1), axis=1).mean()


def mistake_first_segment_alone(probabilities: Array, count: int) -> object:
    """Return the probability for walks that start at segment 0."""
    return np.linalg.matrix_power(probabilities, count - 1).sum(axis=1)[0]


def mistake_evenly_spread(probabilities: Array, count: int) -> object:
    """Return s to the power count - 1, where s is the fraction of segments that have a successor."""
    return np.mean(probabilities.any(axis=1)) ** (count - 1)


# ---- turning_point


def draw_turning_point(rng: np.random.Generator) -> Arguments:
    """Draw a planar transform that rotates much, hardly, or not at all."""
    angles = [0.0, 1e-3, -1e-3, np.pi, *rng.uniform(-3, 3, 4)]
    return float(rng.choice(angles)), *rng.uniform(-2, 2, 2).tolist()


def right_turning_point(angle: float, x: float, z: float) -> tuple[float, float] | None:
    """Solve T c = c, with the point (x, z) as the complex number z + ix."""
    if angle == 0:
        return None
    centre = complex(z, x) / (1 - np.exp(1j * angle))
    return float(centre.imag), float(centre.real)


def same_turning_point(answer: Any, wanted: tuple[float, float] | None) -> bool:  # noqa: ANN401
    """Compare two points, or two answers that no point stays; a division by zero may give inf or nan."""
    if answer is None or wanted is None:
        return answer is wanted
    a = np.asarray(answer, float)
    b = np.asarray(wanted, float)
    if a.shape == b.shape and not np.isfinite(b).all():
        return not np.isfinite(a).all()
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-6, atol=1e-9)


def mistake_nan_for_none(angle: float, x: float, z: float) -> object:
    """Return the point, or (nan, nan) instead of None for a transform without rotation."""
    return right_turning_point(angle, x, z) or (np.nan, np.nan)


def mistake_opposite_turn(angle: float, x: float, z: float) -> object:
    """Return the fixed point of the transform with the angle -θ."""
    return right_turning_point(-angle, x, z)


def mistake_half_of_shift(angle: float, x: float, z: float) -> object:
    """Return half the translation, which is the fixed point only of a rotation by π."""
    return (x / 2, z / 2) if angle else None


def mistake_image_of_origin(angle: float, x: float, z: float) -> object:
    """Return the translation, to which the transform moves the origin."""
    return (x, z)


def mistake_negated_shift(angle: float, x: float, z: float) -> object:
    """Return the fixed point of the transform with the opposite translation, which is -c."""
    return right_turning_point(angle, -x, -z)


def mistake_z_before_x(angle: float, x: float, z: float) -> object:
    """Return the coordinates of the fixed point in the order z, x."""
    return (right_turning_point(angle, x, z) or ())[::-1] or None
