"""Paths on the ground: polylines, splines, and a few named shapes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from mocap._shared.arrays import Array, VectorsLike, frozen
from mocap._shared.quantities import check_radians, described, numbers_of
from mocap._shared.records import dataclass, rebuilding, same_fields
from mocap.body.tuned import TUNED
from mocap.errors import MocapError, shortened

CLOSEST = 1e-9  # metres: points nearer than this are one point
ROUNDING = 1e-12  # relative: a length of 12.000000000000002 m is divided into as many pieces as 12 m


@dataclass(frozen=True, eq=False)
class GroundPath:
    """A polyline on the ground.

    Parameters
    ----------
    points : shape (N, 2), (x, z) in metres. A point that repeats the previous one is dropped.

    Raises
    ------
    MocapError : for fewer than two points, a length of zero, or a number that is not finite.

    Examples
    --------
    >>> corner = GroundPath([[0, 0], [0, 3], [0, 3], [4, 3]])
    >>> corner, corner.at(4.0)
    (GroundPath(3 points, 7.0 m), array([1., 3.]))

    Notebook: 08-path-synthesis
    """

    points: Array

    if TYPE_CHECKING:  # the types that callers may pass: `__post_init__` converts them to an array

        def __init__(self, points: VectorsLike) -> None: ...

    def __post_init__(self) -> None:
        if isinstance(self.points, str | PathLike | GroundPath):
            object.__setattr__(self, "points", as_path(self.points).points)
        points = numbers_of(self.points, "A path", "[[0, 0], [0, 6]]")
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
            raise MocapError(f"A path needs two points (x, z) or more, got an array {points.shape}.")
        if not np.isfinite(points).all():
            point = int(np.isfinite(points).all(axis=1).argmin())
            raise MocapError(f"Point {point} of the path is not finite: {points[point].tolist()}.")
        if np.abs(points).max() > 1e6:
            raise MocapError(f"The path lies {np.abs(points).max():.3g} m away: is it in metres?")
        is_new = np.concatenate([[True], (np.abs(np.diff(points, axis=0)) > CLOSEST).any(axis=1)])
        if is_new.sum() < 2:
            raise MocapError("The path has zero length: all its points are one.")
        object.__setattr__(self, "points", frozen(points[is_new], np.float64))

    def __repr__(self) -> str:
        return f"GroundPath({len(self.points)} points, {self.length:.1f} m)"

    def __eq__(self, other: object) -> bool:  # reads: name: Python's word for it
        return same_fields(self, other) if isinstance(other, GroundPath) else NotImplemented

    def __hash__(self) -> int:
        return hash((len(self.points), self.length))

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return rebuilding(self)

    @property
    def along(self) -> Array:
        """Arc length from the start to each point, metres, shape (N,)."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))])

    @property
    def length(self) -> float:
        """Arc length of the path, metres."""
        return float(self.along[-1])

    # reads: name: public, and promised to those who call it
    def at(self, along: ArrayLike) -> Array:
        """Interpolate the path at arc lengths `along` (...), metres: points (..., 2), clamped to its ends."""
        distances = np.asarray(along, float)
        knots = self.along
        return np.stack([np.interp(distances, knots, axis) for axis in self.points.T], axis=-1)

    def resampled(self, spacing: float) -> GroundPath:
        """Resample at equal arc lengths of at most `spacing` metres. Corners are cut by at most that."""
        if not (np.isfinite(spacing) and spacing > 0):
            raise MocapError(f"Points must be more than 0 m apart, got {spacing} m.")
        pieces = int(np.ceil(self.length / spacing * (1 - ROUNDING)))
        return GroundPath(self.at(np.linspace(0, self.length, max(pieces, 1) + 1)))


def as_path(path: GroundPath | VectorsLike) -> GroundPath:
    """Convert points (x, z) to a `GroundPath`; a path is returned as it is.

    Raises
    ------
    MocapError : as by `GroundPath`, and for other values, such as the name of a file.

    Examples
    --------
    >>> as_path([[0, 0], [0, 6]])
    GroundPath(2 points, 6.0 m)
    """
    if isinstance(path, GroundPath):
        return path
    if isinstance(path, str | PathLike):
        read = f"files.load_path({shortened(repr(str(path)), 60)})"
        raise MocapError(f"This takes a path on the ground, got the name of a file: write {read}.")
    if not isinstance(path, np.ndarray | list | tuple):
        needs = "This takes a path on the ground, such as [[0, 0], [0, 6]]"
        raise MocapError(f"{needs}, got {described(path)}.")
    return GroundPath(path)


def spline(points: VectorsLike) -> GroundPath:
    """Interpolate points by a cubic spline, a C² curve.

    The parametrisation is centripetal (the square roots of the chord lengths), which avoids overshoot and
    loops at closely spaced points.

    Parameters
    ----------
    points : shape (N, 2), (x, z) in metres.

    Returns
    -------
    The curve, with a point every 2 cm.

    Examples
    --------
    >>> spline([[0, 0], [1, 1], [0, 2], [-1, 1]])
    GroundPath(225 points, 4.5 m)

    Notebook: 00-quickstart
    """
    corners = as_path(points).points
    chords = np.hypot(*np.diff(corners, axis=0).T)
    knots = np.concatenate([[0.0], np.cumsum(np.sqrt(chords))])
    curve = CubicSpline(knots, corners, bc_type="natural")
    parameters = np.linspace(0, knots[-1], 50 * len(knots))
    return GroundPath(curve(parameters)).resampled(TUNED.path_spacing)


def arcs(start: tuple[float, float], heading: float, pieces: Sequence[tuple[float, float]]) -> GroundPath:
    """Build a path of circular arcs, each continuing the previous one in position and direction.

    Parameters
    ----------
    start : (x, z), metres.
    heading : radians; 0 is towards +z, π/2 towards +x.
    pieces : (length in metres, rotation in radians) of each arc. A positive rotation is to the left, and 0
        makes a straight line.

    Examples
    --------
    >>> arcs((0, 0), 0.0, [(2.0, 0.0), (np.pi / 2, np.pi / 2)]).points[-1].round(2)
    array([1., 3.])

    Notebook: 08-path-synthesis
    """
    check_radians(heading, "heading")
    steps: list[Array] = []
    rotations: list[Array] = []
    for length, turn in pieces:
        count = max(2, int(np.ceil(length / TUNED.path_spacing)))
        steps.append(np.full(count, length / count))
        rotations.append(np.full(count, turn / count))
    angles = np.concatenate(rotations)
    headings = heading + np.cumsum(angles) - angles / 2  # half-way through each step
    directions = np.stack([np.sin(headings), np.cos(headings)], axis=1)
    offsets = np.cumsum(np.concatenate(steps)[:, None] * directions, axis=0)
    return GroundPath(np.vstack([start, np.asarray(start) + offsets]))


def circle(radius: float = 3.0) -> GroundPath:
    """Build a circle, turning left.

    Examples
    --------
    >>> circle(1.0)
    GroundPath(316 points, 6.3 m)

    Notebook: 12-path-editing
    """
    return arcs((0, 0), 0.0, [(2 * np.pi * radius, 2 * np.pi)])


def s_curve(length: float = 20.0) -> GroundPath:
    """Build an S-curve: two bends of nearly 180° each, the first to the right and the second to the left.

    Examples
    --------
    >>> s_curve(10.0)
    GroundPath(501 points, 10.0 m)

    Notebook: 08c-judging-a-search
    """
    bend = 0.9 * np.pi
    return arcs((0, 0), bend / 2, [(length / 2, -bend), (length / 2, bend)])


def square() -> GroundPath:
    """Build a square, turning left, 6 m wide, whose corners are quarter circles of 1.5 m radius.

    Examples
    --------
    >>> square()
    GroundPath(1073 points, 21.4 m)
    """
    corner = (0.75 * np.pi, np.pi / 2)
    half_side = (1.5, 0.0)
    side = (3.0, 0.0)
    return arcs((0, 0), 0.0, [half_side, corner, side, corner, side, corner, side, corner, half_side])


def figure_of_eight() -> GroundPath:
    """Build a figure of eight: loops of 2.5 m radius, first to the left, then to the right, and two lines.

    Examples
    --------
    >>> figure_of_eight()
    GroundPath(1681 points, 33.6 m)
    """
    half_line = (2.5, 0.0)
    line = (5.0, 0.0)
    loop = 3.75 * np.pi  # metres: three quarters of a circle
    angle = 1.5 * np.pi
    return arcs((0, 0), -np.pi / 4, [half_line, (loop, angle), line, (loop, -angle), half_line])


def letter_s(radius: float = 1.5) -> GroundPath:
    """Build the letter S: two bends of 225° each, the first to the left and the second to the right.

    Examples
    --------
    >>> letter_s(1.0)
    GroundPath(395 points, 7.9 m)
    """
    bend = 1.25 * np.pi
    return arcs((0, 0), 0.0, [(radius * bend, bend), (radius * bend, -bend)])


SHAPES: dict[str, Callable[..., GroundPath]] = {
    "S-curve": s_curve,
    "circle": circle,
    "square": square,
    "figure of eight": figure_of_eight,
    "letter S": letter_s,
}
"""The shapes by name. Each can be called without arguments."""
