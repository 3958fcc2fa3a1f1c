"""Notebook 03: inputs, right answers and mistakes of `best_angle` and `undo`."""

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.body.planar import PlanarTransform
from mocap.course.checks.answers.common import Arguments, clouds, same_pose, turned
from mocap.course.comparisons import close_angles
from mocap.matching.point_clouds import align


def sums(points: Array, moved: Array) -> tuple[float, float]:
    """Return Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    x, _, z = points.T
    moved_x, _, moved_z = moved.T
    sine = (x * moved_z - moved_x * z).sum()
    cosine = (x * moved_x + z * moved_z).sum()
    return float(sine), float(cosine)


def centred_sums(points: Array, moved: Array) -> tuple[float, float]:
    """Return the same sums of two clouds, each about its mean."""
    return sums(points - points.mean(0), moved - moved.mean(0))


def complex_of(points: Array) -> Points:
    """Return z + ix of a cloud's points about its mean."""
    around_mean = points - points.mean(0)
    return np.asarray(around_mean[:, 2] + 1j * around_mean[:, 0])


def mirrored_sums(points: Array, moved: Array) -> tuple[float, float]:
    """Return the parts of Σ g h of two centred clouds, without a conjugate: the imaginary one first."""
    total = (complex_of(points) * complex_of(moved)).sum()
    return float(total.imag), float(total.real)


# ---- best_angle
#
# In formulas, θ is the right angle, and g and h are the points of the clouds as z + ix about their means.


def draw_best_angle(rng: np.random.Generator) -> Arguments:
    """Draw two clouds of points."""
    return clouds(rng)


def right_best_angle(points: Array, moved: Array) -> float:
    """Return the angle of the best alignment, by Eq. 2 of [KGP02]."""
    return float(align(points, moved).angle)


same_best_angle = close_angles


def mistake_not_centred(points: Array, moved: Array) -> object:
    """Return the angle of Eq. 2 from sums over the points themselves, without subtracting the means."""
    return np.arctan2(*sums(points, moved))


def mistake_opposite_angle(points: Array, moved: Array) -> object:
    """Return -θ, the angle by which the first cloud must be rotated to align with the second."""
    return -np.arctan2(*centred_sums(points, moved))


def mistake_cosine_first(points: Array, moved: Array) -> object:
    """Return arctan2 of the two sums in the wrong order, which is π/2 - θ."""
    return np.arctan2(*centred_sums(points, moved)[::-1])


def mistake_arctan_of_quotient(points: Array, moved: Array) -> object:
    """Return the arctangent of the quotient of the two sums, which differs by π beyond ±π/2."""
    return np.arctan(np.divide(*centred_sums(points, moved)))


def mistake_z_up(points: Array, moved: Array) -> object:
    """Return the angle of Eq. 2 in the vertical plane of x and y."""
    return np.arctan2(*centred_sums(points[:, [0, 2, 1]], moved[:, [0, 2, 1]]))


def mistake_mean_of_angles(points: Array, moved: Array) -> object:
    """Return the mean of the angles between the single pairs of points, each about its cloud's mean."""
    return np.angle(complex_of(points) / complex_of(moved)).mean()


def mistake_not_conjugated(points: Array, moved: Array) -> object:
    """Return the angle of Σ g h instead of Σ g h*, with points as z + ix about their mean."""
    sine, cosine = mirrored_sums(points, moved)
    return np.arctan2(sine, cosine)


def mistake_half_angle(points: Array, moved: Array) -> object:
    """Return θ/2."""
    return right_best_angle(points, moved) / 2


def mistake_in_degrees(points: Array, moved: Array) -> object:
    """Return θ in degrees."""
    return np.degrees(right_best_angle(points, moved))


# ---- undo
#
# In formulas, the transform rotates by R(θ), with θ = angle, and then translates by m = (x, z).


def draw_undo(rng: np.random.Generator) -> Arguments:
    """Draw a planar transform; one in five does not rotate, or rotates by half a turn."""
    angle = float(rng.uniform(-3, 3))
    angles = (0.0, np.pi, *[angle] * 8)
    return angles[int(rng.integers(10))], *rng.uniform(-3, 3, 2).tolist()


def right_undo(angle: float, x: float, z: float) -> tuple[float, ...]:
    """Return the three numbers of the inverse transform."""
    inverse = PlanarTransform(angle, x, z).inverse()
    return float(inverse.angle), float(inverse.x), float(inverse.z)


same_undo = same_pose


def mistake_each_negated(angle: float, x: float, z: float) -> object:
    """Return (-θ, -x, -z): the translation is negated, but not rotated."""
    return (-angle, -x, -z)


def mistake_translation_rotated_forwards(angle: float, x: float, z: float) -> object:
    """Return the inverse with -R(θ) m as its translation, instead of -R(-θ) m."""
    return (-angle, *turned(np.array([-x, 0, -z]), angle)[[0, 2]])


def mistake_translation_not_negated(angle: float, x: float, z: float) -> object:
    """Return the inverse with R(-θ) m as its translation, instead of -R(-θ) m."""
    return (-angle, *turned(np.array([x, 0, z]), -angle)[[0, 2]])


def mistake_angle_kept(angle: float, x: float, z: float) -> object:
    """Return the inverse with the angle θ of the transform itself, and the right translation."""
    return (angle, *turned(np.array([-x, 0, -z]), -angle)[[0, 2]])


def mistake_z_before_x(angle: float, x: float, z: float) -> object:
    """Return the inverse with the coordinates of its translation in the order z, x."""
    inverse = right_undo(angle, x, z)
    return inverse[0], inverse[2], inverse[1]


def mistake_unchanged(angle: float, x: float, z: float) -> object:
    """Return the transform itself."""
    return (angle, x, z)


def mistake_translation_kept(angle: float, x: float, z: float) -> object:
    """Return (-θ, x, z): the translation stays as it is."""
    return (-angle, x, z)


def mistake_translation_alone(angle: float, x: float, z: float) -> object:
    """Return (θ, -x, -z): the angle stays as it is, and the translation is negated."""
    return (angle, -x, -z)


def mistake_angle_converted(angle: float, x: float, z: float) -> object:
    """Return -θ and the translation of an inverse that rotates by -θ · π/180."""
    return (-angle, *right_undo(float(np.radians(angle)), x, z)[1:])
