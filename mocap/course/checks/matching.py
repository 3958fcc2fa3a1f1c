"""Random input and answers, right and wrong, for `02-matching.toml`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.matching.point_clouds import align


def draw_angle_gap(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw angles in degrees, among them two that are equal and two that are half a turn apart."""
    a, b = rng.uniform(-180, 180, (2, int(rng.integers(4, 9))))
    a[:2] = rng.integers(-180, 180, 2)
    b[0], b[1] = a[0], a[1] - 180 * np.copysign(1, a[1])
    return a, b


def clouds(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a cloud, and the same cloud turned and moved; two times in three also changed a little.

    One cloud in four is turned by half a turn, and one in four not at all.
    """
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    angle = rng.choice([0.0, np.pi, *rng.uniform(-np.pi, np.pi, 2)])
    moved = PlanarTransform(angle, *rng.normal(size=2)).apply_points(points)
    return points, moved + rng.normal(size=points.shape) * rng.choice([0.0, 0.1, 0.1])


def turned(points: Array, angle: float) -> Array:
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points)


def gap(points: Array, others: Array) -> Array:
    """Move from the mean of one cloud to that of another over the ground: (x, z)."""
    return np.asarray((points.mean(0) - others.mean(0))[[0, 2]])


def parts(points: Array, others: Array) -> tuple[float, float]:
    """Give Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    (x, _, z), (other_x, _, other_z) = points.T, others.T
    return float((x * other_z - other_x * z).sum()), float((x * other_x + z * other_z).sum())


def centred(points: Array, others: Array) -> tuple[float, float]:
    return parts(points - points.mean(0), others - others.mean(0))
