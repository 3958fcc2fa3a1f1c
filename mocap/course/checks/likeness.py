"""Answers, right and wrong, of exercises about windows that are alike."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist, squareform

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.matching.minima import local_minima
from mocap.matching.point_clouds import align

# ---- Notebook 02


def clouds(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a cloud, and the same cloud turned and moved; two times in three also changed a little.

    One cloud in four is turned by half a turn, and one in four not at all.
    """
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    angle = rng.choice([0.0, np.pi, *rng.uniform(-np.pi, np.pi, 2)])
    moved = PlanarTransform(angle, *rng.normal(size=2)).apply_points(points)
    return points, moved + rng.normal(size=points.shape) * rng.choice([0.0, 0.1, 0.1])


def turned(points: Array, angle: float) -> Array:
    """Turn points about the vertical."""
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points)


def parts(points: Array, others: Array) -> tuple[float, float]:
    """Give Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    (x, _, z), (other_x, _, other_z) = points.T, others.T
    return float((x * other_z - other_x * z).sum()), float((x * other_x + z * other_z).sum())


def centred(points: Array, others: Array) -> tuple[float, float]:
    """Give the same sums of two clouds, each about its mean."""
    return parts(points - points.mean(0), others - others.mean(0))


# ---- Notebook 02b


def inside(grid: Array, found: NDArray[np.intp]) -> set[tuple[int, int]]:
    """Keep the places that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    return {(int(r), int(c)) for r, c in found[((found > 0) & (found < last)).all(axis=1)]}


# ---- Notebook 15


def shifted(row: Array) -> Array:
    """Move a row by one place, with infinity before it."""
    return np.append(np.inf, row[:-1])


# ---- Notebook 16


Pairs = list[tuple[float, int]]


MOST = 400  # calls of `matches_of`, far more than a right answer needs


def found_near(links: dict[int, list[tuple[float, int, int]]], asked: list[int], match: int) -> Pairs:
    """Give what is like a match, as pairs (cost, match): motions ten frames apart, a little off each time."""
    asked.append(match)
    if len(asked) > MOST:
        raise RecursionError(
            f"it has asked {MOST} times and does not end: what is found again, at nearly the same "
            "frames, is not new"
        )
    return [(cost, 10 * other + off) for cost, other, off in links[(match + 5) // 10]]


def same_frame(first: int, second: int) -> bool:
    """Say whether two frames are at most four apart."""
    return abs(first - second) <= 4


def spread(query: int, matches_of: Callable[[int], Pairs], same: Callable[[int, int], bool]) -> list[int]:
    """Ask what is like a query, then what is like each new find, the cheapest first, until nothing is new."""
    found, asking = [query], [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _cost, match in new:
            if not any(same(match, other) for other in found):
                found.append(match)
                asking.append(match)
    return found


def shares(distances: Array) -> Array:
    """Weigh samples by 1 / d - 1 / d_k; one that is hit gets all."""
    if distances[0] == 0:
        return np.asarray(np.eye(len(distances))[0])
    with np.errstate(all="ignore"):
        weights = 1 / distances - 1 / distances[-1]
        return np.asarray(weights / weights.sum())
