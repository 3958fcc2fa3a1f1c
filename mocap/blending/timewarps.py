"""Smooth curves over time whose slope stays within bounds: uniform quadratic B-splines, fitted to points.

Within a knot step h the curve is ½ (1 - t)² c_n + (½ + t - t²) c_{n + 1} + ½ t² c_{n + 2}, and its slope goes
in a straight line from (c_{n + 1} - c_n) / h to (c_{n + 2} - c_{n + 1}) / h. So the slope is within bounds
everywhere if and only if the differences of neighbouring control points are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline
from scipy.optimize import lsq_linear

from mocap._shared.arrays import Array, frozen
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError


class Curve(NamedTuple):
    """A curve over time, which goes on along its tangents before its start and after its end.

    start, step : its first knot, and the time from knot to knot, seconds.
    coefficients : shape (N + 2,), the control points of N knot steps.

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
        """Give the curve's values at some times."""
        u, knots, c = np.asarray(times, float), self.knots, self.coefficients
        span = np.clip(np.searchsorted(knots, u, side="right") - 1, 0, len(c) - 3)
        inside = np.clip(u, knots[0], knots[-1])
        mean = (self.slope(knots[span]) + self.slope(u)) / 2  # slopes are straight lines: a trapezium
        value = (c[span] + c[span + 1]) / 2 + (inside - knots[span]) * mean
        return np.asarray(value + (u - inside) * self.slope(u))

    def slope(self, times: ArrayLike) -> Array:
        """Give the curve's slopes at some times, per second: straight lines from knot to knot."""
        slopes = np.diff(self.coefficients) / self.step
        return np.asarray(np.interp(np.asarray(times, float), self.knots, slopes))

    def inverse(self, values: ArrayLike) -> Array:
        """Give the times at which an increasing curve has some values.

        In the knot step that holds a value it solves a + b t + c t² = value, in a form that allows c = 0.
        """
        values, c = np.asarray(values, float), self.coefficients
        knots = (c[1:] + c[:-1]) / 2
        spans = np.clip(np.searchsorted(knots, values, side="right") - 1, 0, len(c) - 3)
        over, first = values - knots[spans], np.diff(c)[spans]
        within = np.clip(over, 0, knots[spans + 1] - knots[spans])
        bend = np.diff(c, 2)[spans] / 2
        t = 2 * within / (first + np.sqrt(np.maximum(first**2 + 4 * bend * within, 0)))
        times = self.start + (spans + t) * self.step
        return np.asarray(times + (over - within) / self.slope(times))


def fit_curve(
    times: ArrayLike, values: ArrayLike, *, spacing: float, least: float = -np.inf, most: float = np.inf
) -> Curve:
    """Fit a curve to points by least squares, with slopes from `least` to `most` everywhere [KG03, timewarp].

    Written as its first control point and their differences, the curve is linear in numbers that have simple
    bounds: a bounded linear problem, which `scipy.optimize.lsq_linear` solves exactly. (This is ours: that
    [KG03] fits freely and then pushes control points apart is recalled, not checked.)

    Parameters
    ----------
    times, values : shape (N,); times never fall.
    spacing : seconds from knot to knot, at most; `np.inf` fits a straight line.
    least, most : bounds of the slope, per second.

    Raises
    ------
    MocapError : for a spacing that is not above 0, no points, and points that are not finite or not as many
        as the times.

    Examples
    --------
    >>> curve = fit_curve([0, 1, 2, 3, 4], [0, 0, 0, 3, 4], spacing=1.0, least=1 / 3, most=3)
    >>> curve([0, 1, 2, 3, 4]).round(4), curve.slope([0, 1, 2, 3, 4]).round(4)
    (array([-0.3167,  0.0167,  0.6   ,  2.5167,  4.1833]), array([0.3333, 0.3333, 0.8333, 3.    , 0.3333]))

    Notebook: 15-registration
    """
    u, y = np.asarray(times, float), np.asarray(values, float)
    if not spacing > 0:
        raise MocapError(f"Knots need a spacing above 0 s, got {spacing}.")
    pairs = u.ndim == 1 and u.shape == y.shape and u.size > 0
    if not (pairs and np.isfinite([u, y]).all() and (np.diff(u) >= 0).all()):
        raise MocapError("A curve needs finite values at as many finite times, which never fall.")
    count = max(int(np.ceil((u[-1] - u[0]) / spacing - 1e-9)), 1)
    step = (u[-1] - u[0]) / count if u[-1] > u[0] else min(spacing, 1.0)
    empty = Curve(float(u[0]), float(step), np.zeros(count + 2))
    around = u[0] + step * np.arange(-2, count + 3)  # SciPy wants two more knots at each end
    matrix = BSpline.design_matrix(np.minimum(u, around[-3]), around, 2).toarray()
    # The n-th control point is the first one plus n differences; so each difference adds to all later ones.
    matrix = np.cumsum(matrix[:, ::-1], axis=1)[:, ::-1]
    if spacing == np.inf:  # both differences are the same
        matrix = np.stack([matrix[:, 0], matrix[:, 1] + matrix[:, 2]], axis=1)
    low, high = (np.full(matrix.shape[1], bound * step) for bound in (least, most))
    low[0], high[0] = -np.inf, np.inf
    solution = np.clip(lsq_linear(matrix, y, (low, high), method="bvls").x, low, high)
    differences = solution[[0, 1, 1]] if spacing == np.inf else solution
    return empty._replace(coefficients=frozen(np.cumsum(differences), np.float64))
