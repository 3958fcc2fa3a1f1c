"""What the tables of exercises use by name: input that several draw, comparisons, and parts of answers."""

from collections import Counter
from functools import partial, reduce
from itertools import combinations, pairwise, permutations
from math import isclose
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import pdist, squareform

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.easing import quintic_step
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body import euler, rotations
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.body.rotations import from_rotvec, inverse, multiply, to_rotvec
from mocap.body.skeleton import Skeleton
from mocap.course.check import close, close_angles
from mocap.matching.minima import local_minima
from mocap.matching.point_clouds import align
from mocap.methods.motion_matching.nearest_frames import spring
from mocap.methods.parametric_graphs.parametric_edges import shrink_box
from mocap.plain import components

# ---- Notebooks 01 and 04


def normalised(q: Array) -> Array:
    """Divide quaternions by their lengths."""
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


# ---- Notebooks 02 and 03


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


def inside(grid: Array, found: NDArray[np.intp]) -> set[tuple[int, int]]:
    """Keep the places that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    return {(int(r), int(c)) for r, c in found[((found > 0) & (found < last)).all(axis=1)]}


def parts(points: Array, others: Array) -> tuple[float, float]:
    """Give Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    (x, _, z), (other_x, _, other_z) = points.T, others.T
    return float((x * other_z - other_x * z).sum()), float((x * other_x + z * other_z).sum())


def centred(points: Array, others: Array) -> tuple[float, float]:
    """Give the same sums of two clouds, each about its mean."""
    return parts(points - points.mean(0), others - others.mean(0))


# ---- Notebooks 03 and 07


def same_place(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare (angle, x, z), the angles up to whole turns."""
    angle, *shift = given
    return len(shift) == 2 and close_angles(angle, wanted[0]) and close(shift, wanted[1:])


# ---- Notebook 03b


TURN = 2 * np.pi


def twin(angles: ArrayLike) -> Array:
    """Give the other three angles of the same rotation."""
    return np.asarray(angles) * [1, -1, 1] + np.pi


def near(before: ArrayLike, angles: ArrayLike) -> Array:
    """Add the whole turns that bring each angle nearest to the one before."""
    steps = np.subtract(angles, before)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


# ---- Notebook 04


def mixed_on_lines(a: Motion, b: Motion, alpha: Array, *, nearer: bool = False) -> Array:
    """Mix quaternions on straight lines; with `nearer`, to that of b and -b which is nearer to a."""
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if nearer else 1.0
    share = alpha[:, None, None]
    return np.asarray(share * a.rotations + (1 - share) * signs * b.rotations)


# ---- Notebooks 04b and 10


def grown(speed: Array, start: float, stay: float, ways: tuple[int, ...] = (1, -1)) -> Mask:
    """Mark frames below `start`, and grow the marks one frame at a time while the speed is below `stay`."""
    marks = speed < start
    for way in ways:
        for before, frame in pairwise(range(len(speed))[::way]):
            marks[frame] |= marks[before] and speed[frame] < stay
    return marks


# ---- Notebooks 05b and 09


def draw_chance_to_last(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of going from segment to segment, some without successor, and a length."""
    count = int(rng.integers(3, 9))
    odds = rng.random((count, count)) * (rng.random((count, count)) < 0.5)
    odds[rng.integers(count)] = 0
    return odds / np.maximum(odds.sum(axis=1, keepdims=True), 1e-9), int(rng.integers(2, 9))


# ---- Notebook 05b


def same_point(given: Any, wanted: tuple[float, float] | None) -> bool:  # noqa: ANN401
    """Compare two points, or two answers that no point stays; a division by zero may give inf or nan."""
    if given is None or wanted is None:
        return given is wanted
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    if a.shape == b.shape and not np.isfinite(b).all():
        return not np.isfinite(a).all()
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-6, atol=1e-9)


# ---- Notebooks 06 and 06b


def draw_graph(rng: np.random.Generator) -> dict[int, list[int]]:
    """Draw a graph of three to eight nodes, with about one edge each."""
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}


# ---- Notebook 07


At = tuple[int, int]  # a node, and the edges walked before it


def ways_from(lengths: dict[int, dict[int, float]], longest: int, state: At) -> list[tuple[float, At]]:
    """Lengthen a walk by each edge of its last node, unless it has so many already."""
    node, made = state
    return [(more, (end, made + 1)) for end, more in lengths[node].items()] if made < longest else []


def is_at(goal: int, state: At) -> bool:
    """Say whether a walk is at its goal."""
    return state[0] == goal


# ---- Notebook 11


def long_way(quaternion: Array) -> Array:
    """Give a rotation vector without taking the shorter of the two ways."""
    w, v = quaternion[0], quaternion[1:]
    return np.asarray(2 * np.arctan2(np.linalg.norm(v), w) * v / np.linalg.norm(v))


# ---- Notebook 16


Links = dict[int, list[tuple[float, int, int]]]  # of each motion: cost, the other motion, frames off
MOST = 400  # calls of `matches_of`, far more than a right answer needs


def found_near(links: Links, asked: list[int], match: int) -> list[tuple[float, int]]:
    """Give what is like a match, as pairs (cost, match): motions ten frames apart, a little off each time."""
    asked.append(match)
    if len(asked) > MOST:
        raise RecursionError(
            f"it has asked {MOST} times and does not end: what is found again, at nearly the same "
            "frames, is not new"
        )
    return [(cost, 10 * other + off) for cost, other, off in links[(match + 5) // 10]]


# ---- Notebook 19


def greedy(a: Points, b: Points) -> Indices:
    """Assign the nearest pair first, then the nearest of those that are left."""
    squares, order = abs(a[:, None] - b) ** 2, np.zeros(len(a), int)
    for _ in a:
        i, j = divmod(int(squares.argmin()), len(b))
        order[i] = j
        squares[i], squares[:, j] = np.inf, np.inf
    return order
