"""Checks of notebook 02c."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.planar import PlanarTransform
from mocap.course.check import Check, Mistake


def _window(rng: np.random.Generator) -> tuple[Array]:
    """Make a window of random points, turned and moved at random."""
    points = rng.normal(size=(*rng.integers(3, 7, 2), 3)) * [0.5, 0.5, 1.0] + [0, 1.5, 0]
    return (PlanarTransform(*rng.uniform(-3, 3, 3)).apply_points(points),)


def _numbers(points: Array, middle: Any = None, scale: float | None = None) -> Array:  # noqa: ANN401
    """Join heights and distances from a middle; by default that of the window, and over the root of kP."""
    heights, ground = points[..., 1], points[..., [0, 2]]
    centre = ground.mean(axis=(0, 1)) if middle is None else middle
    radii = np.linalg.norm(ground - centre, axis=-1)
    rows = np.concatenate([heights.ravel(), radii.ravel()])
    return np.asarray(rows / (np.sqrt(heights.size) if scale is None else scale))


def _squared(points: Array) -> Array:
    numbers = _numbers(points)
    half = len(numbers) // 2
    return np.asarray(np.concatenate([numbers[:half], numbers[half:] ** 2 * np.sqrt(half)]))


def _with_directions(points: Array) -> Array:
    ground = points[..., [0, 2]] - points[..., [0, 2]].mean(axis=(0, 1))
    rows = np.concatenate([points[..., 1].ravel(), ground.ravel()])
    return np.asarray(rows / np.sqrt(points[..., 1].size))


def _in_space(points: Array) -> Array:
    radii = np.linalg.norm(points - points.mean(axis=(0, 1)), axis=-1)
    return np.asarray(np.concatenate([points[..., 1].ravel(), radii.ravel()]) / np.sqrt(radii.size))


turn_free = Check(
    name="turn_free",
    asks="all heights, then all distances from the window's middle, over the root of the number of points",
    start="points[..., 1] are the heights. What is the mean of x and z over all frames and all points?",
    draw=_window,
    truth=_numbers,
    mistakes=[
        Mistake(
            lambda points: _numbers(points, middle=0),
            "your distances are from the origin, and change when the window moves: measure from its middle.",
        ),
        Mistake(
            lambda points: _numbers(points, middle=points[..., [0, 2]].mean(axis=1, keepdims=True)),
            "each frame has a middle of its own here; the window needs one, over frames and points.",
        ),
        Mistake(
            lambda points: _numbers(points, scale=1),
            "divide by the root of the number of points: each has the weight 1 / (k P).",
        ),
        Mistake(
            lambda points: _numbers(points, scale=points[..., 0].size),
            "the weight is 1 / (k P), but f holds its root, because squares of f are added up.",
        ),
        Mistake(_squared, "these are squares of distances; take the root."),
        Mistake(
            _with_directions, "x and z change when the window turns; their distance from the middle does not."
        ),
        Mistake(_in_space, "r is measured over the ground: leave the height out of it."),
    ],
)


def _rows(rng: np.random.Generator) -> tuple[Array, float]:
    """Make rows of numbers and a reach that leaves some pairs."""
    rows = rng.normal(size=(int(rng.integers(7, 12)), 4))
    apart = np.linalg.norm(rows[:, None] - rows, axis=-1)
    return rows, float(np.quantile(apart[np.triu_indices(len(rows), 1)], rng.uniform(0.3, 0.6)))


def _pairs(near: NDArray[np.bool_]) -> set[tuple[int, int]]:
    return {(int(i), int(j)) for i, j in np.argwhere(near)}


def _near(rows: Array, reach: float) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(rows[:, None] - rows, axis=-1) <= reach)


def _same_pairs(given: Any, wanted: set[tuple[int, int]]) -> bool:  # noqa: ANN401
    found = np.reshape(np.asarray([tuple(pair) for pair in given], float), (-1, 2))
    return {(int(i), int(j)) for i, j in found} == wanted


worth_a_look = Check(
    name="worth_a_look",
    asks="the pairs (i, j) with i < j whose rows are at most `reach` apart",
    start="subtract row j from row i, and take the length of the difference.",
    draw=_rows,
    truth=lambda rows, reach: _pairs(np.triu(_near(rows, reach), 1)),
    mistakes=[
        Mistake(
            lambda rows, reach: _pairs(~np.eye(len(rows), dtype=bool) & _near(rows, reach)),
            "each pair is there twice: keep those with i < j.",
        ),
        Mistake(
            lambda rows, reach: _pairs(np.triu(_near(rows, reach))),
            "a window and itself are no pair: i < j.",
        ),
        Mistake(
            lambda rows, reach: _pairs(np.triu(~_near(rows, reach), 1)),
            "these are the pairs that need no look; the others are asked for.",
        ),
        Mistake(
            lambda rows, reach: _pairs(np.triu(_near(rows, np.sqrt(reach)), 1)),
            "you compare the square of a length with `reach`: take the root.",
        ),
        Mistake(
            lambda rows, reach: _pairs(np.triu(np.abs(rows[:, None] - rows).sum(-1) <= reach, 1)),
            "you add up sizes; the length is the root of the sum of squares, which is smaller.",
        ),
    ],
    same=_same_pairs,
)


def _projected(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a difference of two rows and some orthonormal directions."""
    size = int(rng.integers(5, 9))
    axes, _ = np.linalg.qr(rng.normal(size=(size, size)))
    return rng.normal(size=size), axes[:, : size - 1]


def _bounds(difference: Array, axes: Array) -> Array:
    return np.asarray(np.sqrt(np.cumsum((difference @ axes) ** 2)))


bounds_by_direction = Check(
    name="bounds_by_direction",
    asks="the lengths of the projection on the first direction, on the first two, and so on",
    start="difference @ axes are the components; see `np.cumsum`.",
    draw=_projected,
    truth=_bounds,
    mistakes=[
        Mistake(
            lambda difference, axes: np.cumsum(np.abs(difference @ axes)),
            "lengths of components that are at right angles do not add up; their squares do.",
        ),
        Mistake(
            lambda difference, axes: np.cumsum((difference @ axes) ** 2),
            "these are squares of lengths: take the root at the end.",
        ),
        Mistake(
            lambda difference, axes: np.abs(difference @ axes),
            "these are the components one by one; with each direction the length of all so far is asked for.",
        ),
        Mistake(
            lambda difference, axes: _bounds(difference, axes[:, ::-1]),
            "you begin with the last direction; the first column of `axes` comes first.",
        ),
        Mistake(
            lambda difference, axes: np.sqrt(np.cumsum(difference[: axes.shape[1]] ** 2)),
            "you added up the numbers of the difference itself; project it on the directions first.",
        ),
        Mistake(
            lambda difference, axes: np.linalg.norm(difference @ axes),
            "that is the length with all directions; give one number for each count of directions.",
        ),
    ],
)
