"""Smooth curves over time with bounded slopes: uniform quadratic B-splines, fitted by least squares.

Within a knot interval h the curve is ½ (1 - t)² c_n + (½ + t - t²) c_{n + 1} + ½ t² c_{n + 2}, and its slope
is linear, from (c_{n + 1} - c_n) / h to (c_{n + 2} - c_{n + 1}) / h. Therefore the slope is within bounds
everywhere if and only if the differences of neighbouring control points, divided by h, are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline
from scipy.optimize import lsq_linear
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import spsolve

from mocap._shared.arrays import Array, Indices, frozen
from mocap._shared.records import NamedTuple
from mocap.blending.tuned import TUNED
from mocap.errors import MocapError

ROUNDS = 100  # the largest number of rounds in which the active bounds are found, which takes three to ten


class Curve(NamedTuple):
    """A curve over time, a uniform quadratic B-spline that is extrapolated linearly beyond its ends.

    start, step : the first knot, and the knot interval, seconds.
    coefficients : shape (N + 2,), the control points of N knot intervals.

    Examples
    --------
    >>> line = Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
    >>> line([0.0, 0.25, 3.0]), line.slope([0.0, 3.0]), float(line.inverse(3.0))
    (array([0.  , 0.25, 3.  ]), array([1., 1.]), 3.0)

    Notebook: 15-registration
    """

    start: float
    step: float
    coefficients: Array

    @property
    def knots(self) -> Array:
        """The times of the knots, shape (N + 1,)."""
        return np.asarray(self.start + self.step * np.arange(len(self.coefficients) - 1), float)

    def __call__(self, times: ArrayLike) -> Array:
        """Evaluate the curve at times."""
        u = np.asarray(times, float)
        knots = self.knots
        index = _step_index(knots, u)
        inside = np.clip(u, knots[0], knots[-1])
        start_value = (self.coefficients[index] + self.coefficients[index + 1]) / 2
        mean_slope = (self.slope(knots[index]) + self.slope(u)) / 2  # from the knot to u: slopes are linear
        value = start_value + (inside - knots[index]) * mean_slope
        return np.asarray(value + (u - inside) * self.slope(u))

    def slope(self, times: ArrayLike) -> Array:
        """Evaluate the slope of the curve at times, per second. It is linear from knot to knot."""
        slopes = np.diff(self.coefficients) / self.step
        return np.asarray(np.interp(np.asarray(times, float), self.knots, slopes))

    def inverse(self, values: ArrayLike) -> Array:
        """Evaluate the inverse of an increasing curve: return the times at which it has some values.

        In the knot interval of a value, b t + c t² = rise is solved for the rise from its first knot, by
        t = 2 rise / (b + √(b² + 4 c rise)), which allows c = 0.
        """
        values = np.asarray(values, float)
        at_knots = (self.coefficients[1:] + self.coefficients[:-1]) / 2
        index = _step_index(at_knots, values)
        rise = values - at_knots[index]
        inside = np.clip(rise, 0, at_knots[index + 1] - at_knots[index])
        b = np.diff(self.coefficients)[index]
        c = np.diff(self.coefficients, 2)[index] / 2
        root = np.sqrt(np.maximum(b**2 + 4 * c * inside, 0))
        t = 2 * inside / (b + root)
        times = self.start + (index + t) * self.step
        return np.asarray(times + (rise - inside) / self.slope(times))


def _step_index(knots: Array, numbers: Array) -> Indices:
    """Return the index of the knot interval of each number, clamped to the first and the last interval."""
    return np.asarray(np.clip(np.searchsorted(knots, numbers, side="right") - 1, 0, len(knots) - 2))


# reads: name: public, and users write least= and most=
def fit_curve(
    times: ArrayLike, values: ArrayLike, *, spacing: float, least: float = -np.inf, most: float = np.inf
) -> Curve:
    """Fit a curve to points by least squares, with slopes from `least` to `most` everywhere [KG03, timewarp].

    The unknowns are the first control point and the differences of consecutive ones. The curve is linear in
    these, and the bounds of the slope are simple bounds of the differences. `scipy.optimize.lsq_linear`
    solves this linear problem with bounds exactly. (This is ours. As far as we remember, [KG03] fits without
    bounds and then moves control points apart.)

    Parameters
    ----------
    times, values : shape (N,); times never decrease.
    spacing : the largest knot interval, seconds; `np.inf` fits a straight line.
    least, most : bounds of the slope, per second.

    Raises
    ------
    MocapError : for a spacing that is not above 0, no points, points that are not finite, decreasing times,
        and different numbers of times and values.

    Examples
    --------
    >>> curve = fit_curve([0, 1, 2, 3, 4], [0, 0, 0, 3, 4], spacing=1.0, least=1 / 3, most=3)
    >>> curve([0, 1, 2, 3, 4]).round(4), curve.slope([0, 1, 2, 3, 4]).round(4)
    (array([-0.3167,  0.0167,  0.6   ,  2.5167,  4.1833]), array([0.3333, 0.3333, 0.8333, 3.    , 0.3333]))

    Notebook: 15-registration
    """
    u = np.asarray(times, float)
    y = np.asarray(values, float)
    if not spacing > 0:
        raise MocapError(f"Knots need a spacing above 0 s, got {spacing}.")
    are_pairs = u.ndim == 1 and u.shape == y.shape and u.size > 0
    if not (are_pairs and np.isfinite([u, y]).all() and (np.diff(u) >= 0).all()):
        raise MocapError("A curve needs finite values at as many finite times, which never fall.")
    count = max(int(np.ceil((u[-1] - u[0]) / spacing - 1e-9)), 1)
    step = (u[-1] - u[0]) / count if u[-1] > u[0] else min(spacing, 1.0)
    basis = _basis_functions(u, step, count)
    if count > TUNED.many_knots and _determines_all(u, step, count):
        points = bounded_spline(basis, y, least * step, most * step)
        return Curve(float(u[0]), float(step), frozen(points, np.float64))
    # The n-th control point is the sum of the first one and n differences: sum the columns from the end.
    matrix = np.cumsum(basis.toarray()[:, ::-1], axis=1)[:, ::-1]
    is_straight = spacing == np.inf
    if is_straight:  # a single knot interval, whose two differences are equal
        matrix = np.stack([matrix[:, 0], matrix[:, 1] + matrix[:, 2]], axis=1)
    low = np.full(matrix.shape[1], least * step)
    high = np.full(matrix.shape[1], most * step)
    low[0] = -np.inf  # the first control point is free
    high[0] = np.inf
    solution = np.clip(lsq_linear(matrix, y, (low, high), method="bvls").x, low, high)
    differences = solution[[0, 1, 1]] if is_straight else solution
    return Curve(float(u[0]), float(step), frozen(np.cumsum(differences), np.float64))


def _basis_functions(times: Array, step: float, count: int) -> csr_array:
    """Evaluate the quadratic B-splines of `count` knot intervals from the first time, (N, count + 2)."""
    knots = times[0] + step * np.arange(-2, count + 3)  # SciPy requires two more knots at each end
    last = knots[-3]
    return csr_array(BSpline.design_matrix(np.minimum(times, last), knots, 2))


def _determines_all(times: Array, step: float, count: int) -> bool:
    """Tell whether each knot interval has three different times, which determine all control points."""
    intervals = np.minimum((np.unique(times) - times[0]) / step, count - 1).astype(np.intp)
    return bool(np.bincount(intervals, minlength=count).min() >= 3)


def bounded_spline(basis: csr_array, values: Array, low: float, high: float) -> Array:
    """Fit control points to values by least squares, with bounds of the differences of neighbouring ones.

    For many knots, an active set method on the normal equations, as that of `lsq_linear`, but in a time that
    is proportional to the knots. A difference at a bound ties two control points to each other. All control
    points that are tied together move as one, and the normal equations of such groups have five diagonals.

    Parameters
    ----------
    basis : sparse, shape (N, P), the quadratic B-splines at the N values. They must determine all points.
    values : shape (N,).
    low, high : the bounds of the differences.

    Returns
    -------
    The control points, shape (P,).

    Examples
    --------
    >>> points = bounded_spline(csr_array(np.eye(4)), np.array([0.0, 0, 2, 3]), low=0.5, high=1.5)
    >>> points.round(4)
    array([-0.1667,  0.3333,  1.8333,  3.    ])
    """
    normal = csr_array(basis.T @ basis)
    right_side = basis.T @ values
    at_high = np.zeros(basis.shape[1] - 1, bool)
    at_low = np.zeros(basis.shape[1] - 1, bool)
    for _ in range(ROUNDS):
        tied = np.where(at_high, high, np.where(at_low, low, np.nan))
        points = _tied_points(normal, right_side, tied)
        # Half of what the squared error would lose if all control points behind a difference rose together.
        forces = np.cumsum((right_side - normal @ points)[::-1])[-2::-1]
        differences = np.diff(points)
        next_high = np.where(at_high, forces > 0, differences > high)
        next_low = np.where(at_low, forces < 0, differences < low)
        if np.array_equal(next_high, at_high) and np.array_equal(next_low, at_low):
            break
        at_high = next_high
        at_low = next_low
    first = points[0]
    return np.cumsum(np.append(first, np.clip(np.diff(points), low, high)))


def _tied_points(normal: csr_array, right_side: Array, tied: Array) -> Array:
    """Solve normal equations for control points whose differences are given unless `tied` is NaN there."""
    group = np.append(0, np.cumsum(np.isnan(tied)))
    rise = np.append(0, np.cumsum(np.nan_to_num(tied)))
    _, first_of_group = np.unique(group, return_index=True)
    rise = rise - rise[first_of_group][group]  # of each point above the first one of its group
    count = len(group)
    members = csr_array((np.ones(count), (np.arange(count), group)))
    of_groups = csc_array(members.T @ normal @ members)
    return np.asarray(spsolve(of_groups, members.T @ (right_side - normal @ rise))[group] + rise)
