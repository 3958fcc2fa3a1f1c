"""Curves against SciPy's splines, and fits within bounds against all that might fit better."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from mocap.blending.timewarps import Curve, fit_curve
from tests.refusals import refusals
from tests.strategies import seeds


def random_curve(seed, count=7):
    rng = np.random.default_rng(seed)
    return Curve(float(rng.normal()), float(rng.uniform(0.1, 2)), np.cumsum(rng.uniform(0.1, 1, count)))


@given(seeds, st.integers(3, 12))
def test_curves_are_the_uniform_quadratic_splines_of_scipy(seed, count):
    """As in [KG03, timewarp]."""
    curve = random_curve(seed, count)
    knots = curve.start + curve.step * np.arange(-2, count + 1)
    spline = BSpline(knots, curve.coefficients, 2)
    times = np.linspace(curve.start, curve.knots[-1], 50)
    np.testing.assert_allclose(curve(times), spline(times), atol=1e-12)
    np.testing.assert_allclose(curve.slope(times), spline.derivative()(times), atol=1e-10)


@given(seeds)
def test_beyond_its_ends_a_curve_goes_on_along_its_tangents(seed):
    curve = random_curve(seed)
    for end, side in ((curve.start, -1), (curve.knots[-1], 1)):
        assert float(curve(end + side)) == pytest.approx(float(curve(end) + side * curve.slope(end)))
        assert float(curve.slope(end + side)) == pytest.approx(float(curve.slope(end)))


@given(seeds)
def test_the_inverse_undoes_an_increasing_curve(seed):
    curve = random_curve(seed)
    times = np.linspace(curve.start - 1, curve.knots[-1] + 1, 60)
    np.testing.assert_allclose(curve.inverse(curve(times)), times, atol=1e-10)


@given(seeds, st.floats(0.05, 2))
def test_slopes_stay_within_bounds_and_no_curve_within_them_fits_better(seed, spacing):
    """As in [KG03, timewarp]."""
    rng = np.random.default_rng(seed)
    times = np.sort(rng.uniform(0, 4, 30))
    values = np.cumsum(rng.random(30) < 0.5) / 5
    curve = fit_curve(times, values, spacing=spacing, least=1 / 3, most=3)
    slopes = curve.slope(np.linspace(-1, 5, 400))
    assert slopes.min() >= 1 / 3 - 1e-9 and slopes.max() <= 3 + 1e-9
    best = ((curve(times) - values) ** 2).sum()
    for size in (1e-3, 1e-1):
        moved = curve.coefficients + size * rng.normal(size=curve.coefficients.shape)
        rises = np.clip(np.diff(moved), curve.step / 3, 3 * curve.step)
        other = curve._replace(coefficients=np.cumsum(np.append(moved[0], rises)))
        assert ((other(times) - values) ** 2).sum() >= best - 1e-9


def test_one_moment_and_many_points_at_it_make_a_curve():
    for least in (-np.inf, 0.5):
        curve = fit_curve([2.0, 2.0], [1.0, 3.0], spacing=0.3, least=least)
        assert float(curve(2.0)) == pytest.approx(2.0)


test_what_has_no_curve_is_refused = refusals(
    *(("spacing above 0 s, got", lambda n=n: fit_curve([0, 1], [0, 1], spacing=n)) for n in (0, np.nan)),
    ("finite values at as many finite times", lambda: fit_curve([0, 1], [0], spacing=1)),
    ("finite values at as many finite times", lambda: fit_curve([], [], spacing=1)),
    ("finite values at as many finite times", lambda: fit_curve([0, np.nan], [0, 1], spacing=1)),
    ("which never fall", lambda: fit_curve([1, 0], [0, 1], spacing=1)),
)
