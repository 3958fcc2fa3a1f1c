"""Notebook 03: inputs, right answers and mistakes of `best_angle` and `undo`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import close_angles
from mocap.course.checks.answers.common import Arguments, clouds, same_pose, turned
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


# ---- best_angle


def draw_best_angle(rng: np.random.Generator) -> Arguments:
    return clouds(rng)


def right_best_angle(points: Array, moved: Array) -> float:
    return float(align(points, moved).angle)


same_best_angle = close_angles


def mistake_not_centred(points: Array, moved: Array) -> object:
    return np.arctan2(*sums(points, moved))


def mistake_opposite_angle(points: Array, moved: Array) -> object:
    return -np.arctan2(*centred_sums(points, moved))


def mistake_cosine_first(points: Array, moved: Array) -> object:
    return np.arctan2(*centred_sums(points, moved)[::-1])


def mistake_arctan_of_quotient(points: Array, moved: Array) -> object:
    return np.arctan(np.divide(*centred_sums(points, moved)))


def mistake_z_up(points: Array, moved: Array) -> object:
    return np.arctan2(*centred_sums(points[:, [0, 2, 1]], moved[:, [0, 2, 1]]))


# ---- undo


def draw_undo(rng: np.random.Generator) -> Arguments:
    angle = float(rng.uniform(-3, 3))
    angles = (0.0, np.pi, *[angle] * 8)
    return angles[int(rng.integers(10))], *rng.uniform(-3, 3, 2).tolist()


def right_undo(angle: float, x: float, z: float) -> tuple[float, ...]:
    inverse = PlanarTransform(angle, x, z).inverse()
    return float(inverse.angle), float(inverse.x), float(inverse.z)


same_undo = same_pose


def mistake_each_negated(angle: float, x: float, z: float) -> object:
    return (-angle, -x, -z)


def mistake_translation_rotated_forwards(angle: float, x: float, z: float) -> object:
    return (-angle, *turned(np.array([-x, 0, -z]), angle)[[0, 2]])


def mistake_translation_not_negated(angle: float, x: float, z: float) -> object:
    return (-angle, *turned(np.array([x, 0, z]), -angle)[[0, 2]])


def mistake_angle_kept(angle: float, x: float, z: float) -> object:
    return (angle, *turned(np.array([-x, 0, -z]), -angle)[[0, 2]])
