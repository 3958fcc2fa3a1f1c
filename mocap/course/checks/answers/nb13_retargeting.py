"""Notebook 13: inputs, right answers and mistakes of `scaled_root`, `bone_turn` and `design_row`."""

from functools import reduce

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.rotations import from_rotvec, inverse, multiply
from mocap.course.checks.answers.common import Arguments
from mocap.course.comparisons import close_rotations

# ---- scaled_root


def draw_scaled_root(rng: np.random.Generator) -> Arguments:
    """Draw places of the hips, a ratio of sizes, the heights of two ankles, and the centre."""
    hips = rng.normal([0.3, 0.9, 2.0], [0.4, 0.03, 1.0], (6, 3))
    ratio = rng.uniform(0.4, 0.8)
    return hips, ratio, *rng.uniform(0.04, 0.14, 2), rng.normal(size=2)


def right_scaled_root(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> Array:
    """Scale a way about a centre (x, z), and heights from one standing height to another."""
    scaled = np.array(hips)
    scaled[:, [0, 2]] = centre + ratio * (hips[:, [0, 2]] - centre)
    scaled[:, 1] = low_t + ratio * (hips[:, 1] - low_s)
    return scaled


def mistake_about_the_floor(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Scale the heights about the floor: y becomes ratio · y."""
    return right_scaled_root(hips, ratio, 0.0, 0.0, centre)


def mistake_source_ankles(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Put the scaled heights on the source's ankle height: low_s + ratio (y - low_s)."""
    return right_scaled_root(hips, ratio, low_s, low_s, centre)


def mistake_ankles_swapped(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Scale the heights as low_s + ratio (y - low_t), with the two ankle heights exchanged."""
    return right_scaled_root(hips, ratio, low_t, low_s, centre)


def mistake_about_the_origin(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Scale x and z about the origin instead of the centre."""
    return right_scaled_root(hips, ratio, low_s, low_t, np.zeros(2))


def mistake_path_not_scaled(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Return the hips' x and z as they are, with the right heights."""
    scaled = right_scaled_root(hips, ratio, low_s, low_t, centre)
    return np.stack([hips[:, 0], scaled[:, 1], hips[:, 2]], axis=1)


def mistake_inverse_ratio(hips: Array, ratio: float, low_s: float, low_t: float, centre: Array) -> object:
    """Scale by 1 / ratio."""
    return right_scaled_root(hips, 1 / ratio, low_s, low_t, centre)


# ---- bone_turn


def draw_bone_turn(rng: np.random.Generator) -> Arguments:
    """Draw three rotations: the stance of the source, that of the target, and the turn between them."""
    return tuple(from_rotvec(rng.normal(size=3)) for _ in range(3))


def right_bone_turn(source: Array, target: Array, turn: Array) -> Array:
    """Return C = R_source⁻¹ A R_target."""
    return reduce(multiply, (inverse(source), turn, target))


same_bone_turn = close_rotations


def mistake_source_not_inverted(source: Array, target: Array, turn: Array) -> object:
    """Return R_source A R_target."""
    return reduce(multiply, (source, turn, target))


def mistake_turn_on_the_right(source: Array, target: Array, turn: Array) -> object:
    """Return R_source⁻¹ R_target A."""
    return reduce(multiply, (inverse(source), target, turn))


def mistake_no_turn(source: Array, target: Array, turn: Array) -> object:
    """Return R_source⁻¹ R_target."""
    return reduce(multiply, (inverse(source), target))


def mistake_no_target(source: Array, target: Array, turn: Array) -> object:
    """Return R_source⁻¹ A."""
    return reduce(multiply, (inverse(source), turn))


def mistake_source_on_the_right(source: Array, target: Array, turn: Array) -> object:
    """Return A R_target R_source⁻¹."""
    return reduce(multiply, (turn, target, inverse(source)))


def mistake_inverted(source: Array, target: Array, turn: Array) -> object:
    """Return C⁻¹ = R_target⁻¹ A⁻¹ R_source."""
    return inverse(right_bone_turn(source, target, turn))


def mistake_turn_inverted(source: Array, target: Array, turn: Array) -> object:
    """Return R_source⁻¹ A⁻¹ R_target."""
    return reduce(multiply, (inverse(source), inverse(turn), target))


# ---- design_row


def draw_design_row(rng: np.random.Generator) -> Arguments:
    """Draw a parameter between 0 and 1."""
    return (float(rng.uniform(0, 1)),)


def right_design_row(u: float) -> Array:
    """Return the four basis functions of the uniform cubic B-spline."""
    second = 3 * u**3 - 6 * u**2 + 4
    third = -3 * u**3 + 3 * u**2 + 3 * u + 1
    return np.array([(1 - u) ** 3, second, third, u**3]) / 6


def mistake_not_divided(u: float) -> object:
    """Return the basis functions times 6, which add up to 6."""
    return 6 * right_design_row(u)


def mistake_reversed_weights(u: float) -> object:
    """Return the four weights with the latest control point first."""
    return right_design_row(u)[::-1]


def mistake_copied_weights(u: float) -> object:
    """Return the first two weights, followed by the same two in reverse order."""
    return right_design_row(u)[[0, 1, 1, 0]]


def mistake_catmull_rom(u: float) -> object:
    """Return the weights of a Catmull-Rom spline, which interpolates its control points."""
    first = -u + 2 * u**2 - u**3
    second = 2 - 5 * u**2 + 3 * u**3
    third = u + 4 * u**2 - 3 * u**3
    return np.array([first, second, third, u**3 - u**2]) / 2


def mistake_bernstein(u: float) -> object:
    """Return the cubic Bernstein polynomials, the weights of a Bézier curve."""
    second = 3 * u * (1 - u) ** 2
    third = 3 * u**2 * (1 - u)
    return np.array([(1 - u) ** 3, second, third, u**3])


def mistake_linear(u: float) -> object:
    """Return the weights of linear interpolation between the two middle control points."""
    return np.array([0, 1 - u, u, 0])
