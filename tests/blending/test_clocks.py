"""The blend's clock: how fast it goes, and how long the blend lasts; its curves against SciPy's splines."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from mocap.blending import timewarps
from mocap.blending.clocks import clock_speed, frame_times, match_contacts
from mocap.blending.registering import register
from mocap.blending.timewarps import Curve, fit_curve
from mocap.body import Motion, Skeleton
from tests.blending.registered import walks
from tests.refusals import refusals
from tests.strategies import seeds


@cache
def pair():
    return register([walks()[0.8, 0], walks()[1.4, 0]])


def clock(weights, fps=30.0, **settings):
    return frame_times(pair(), weights, fps=fps, **settings)


def test_the_two_means_of_the_paces_1_and_2():
    """As in [KG03, clock]."""
    assert clock_speed([1, 2], [0.5, 0.5]) == pytest.approx(2 / 3)
    assert clock_speed([1, 2], [0.5, 0.5], "rates") == pytest.approx(3 / 4)


@pytest.mark.parametrize("weight", [0.0, 0.25, 1.0, 1.1, -0.1])
def test_with_constant_weights_a_blend_lasts_as_long_as_the_clips_do_on_average(weight):
    weights = np.array([1 - weight, weight])
    times, shares = clock(weights, 120.0)
    rest = weights @ pair().durations - (len(times) - 1) / 120
    # Room for rounding: a millionth of a frame, as the code has; 0 was measured.
    assert -1e-8 <= rest < 1 / 120
    assert times[0] == pair().span[0] and times[-1] <= pair().span[1]
    assert np.all(np.diff(times) > 0) and shares.shape == (len(times), 2)


@pytest.mark.parametrize("pace", ["durations", "rates"])
def test_weights_that_could_move_and_do_not_give_the_same_times(pace):
    constant, _ = clock([0.4, 0.6], pace=pace)
    moving, shares = clock(lambda u, t: [0.4, 0.6], pace=pace)
    np.testing.assert_allclose(moving, constant, atol=1e-3)
    np.testing.assert_allclose(shares, np.tile([0.4, 0.6], (len(moving), 1)))


def test_averaged_rates_play_faster_than_averaged_durations():
    lengths = [len(clock([0.5, 0.5], 120.0, pace=pace)[0]) for pace in ("rates", "durations")]
    assert 0.95 * lengths[1] < lengths[0] < lengths[1]


test_a_clock_that_would_stop_and_weights_that_are_none_are_refused = refusals(
    (r"2 clips needs 2 weights that add up to 1, got \[1.0\]", clock, [1.0]),
    (r"add up to 1, got \[0.5, 0.6\]", clock, [0.5, 0.6]),
    (r"got \[nan, 1.0\]", clock, [np.nan, 1]),
    (r"got an array of shape \(9,\) with the sum 1", clock, np.full(9, 1 / 9)),
    (r"got \[0.5, 0.4\]", clock, lambda u, t: [0.5, 0.4]),
    (r"got \[1.0, 0.0, 0.0\]", clock, lambda u, t: [t + 1, -t] if t else [1, 0, 0]),
    (r"the weights \[-9.0, 10.0\] time would stop", clock, [-9.0, 10.0]),
    ("time would stop", lambda: clock([10.0, -9.0], pace="rates")),
    ("rate must be above 0, got 0.0", clock, [0.5, 0.5], 0.0),
    ("No pace 'even'; there are: durations, rates", lambda: clock([0.5, 0.5], pace="even")),
)


FPS, SPAN = 100.0, (0.0, 3.0)
BODY = Skeleton(["foot", "other"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
SAME = Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
TWICE = Curve(0.0, 1.0, np.array([-1.0, 1.0, 3.0]))


def standing(*plants, joint="foot"):
    """A body that stands from some times to others, seconds."""
    times = np.arange(601) / FPS
    marks = np.any([(times >= start - 1e-9) & (times < stop - 1e-9) for start, stop in plants], axis=0)
    still = np.tile([1.0, 0, 0, 0], (601, 2, 1))
    return Motion(BODY, np.zeros((601, 3)), still, FPS, contacts={joint: marks})


def matched(*clips, curves=None):
    found = match_contacts(clips, curves or [SAME] * len(clips), SPAN)
    return [tuple(ends.round(3).tolist()) for _, ends in found]


def test_times_are_those_of_the_common_clock():
    found = matched(standing((1.0, 2.0)), standing((2.2, 4.2)), curves=[SAME, TWICE])
    assert found == [([1.0, 1.1], [2.0, 2.1])]


def test_a_plant_that_a_clip_lacks_is_dropped():
    """As in [KG03, constraint matches]."""
    assert matched(standing((0.2, 0.8), (2, 2.5)), standing((0.3, 0.9))) == [([0.2, 0.3], [0.8, 0.9])]
    assert matched(standing((0.2, 0.8)), standing((1.0, 1.5))) == []
    assert matched(standing((0.2, 0.8)), standing((0.3, 0.9), joint="other")) == []


def test_a_plant_beside_two_is_split_where_the_two_pause():
    """As in [KG03, constraint matches]."""
    one, two = standing((0.2, 1.9)), standing((0.1, 0.9), (1.1, 2.0))
    assert matched(one, two) == [([0.2, 0.1], [1.0, 0.9]), ([1.0, 1.1], [1.9, 2.0])]
    assert matched(one, two, one) == [([0.2, 0.1, 0.2], [1.0, 0.9, 1.0]), ([1.0, 1.1, 1.0], [1.9, 2.0, 1.9])]


def test_a_part_of_a_split_group_that_a_clip_lacks_is_dropped():
    assert matched(standing((0.2, 0.92)), standing((0.1, 0.9), (0.91, 2.0))) == [([0.2, 0.1], [0.905, 0.9])]


def test_plants_end_with_the_span_and_slivers_do_not_count():
    assert matched(standing((2.5, 4.0)), standing((2.6, 3.5))) == [([2.5, 2.6], [3.0, 3.0])]
    assert matched(standing((0.2, 0.21)), standing((0.2, 0.21))) == []


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


@pytest.mark.parametrize("bounds", [{"least": 1 / 3, "most": 3.0}, {}])
def test_a_curve_of_many_knots_is_that_of_the_dense_fit(monkeypatch, bounds):
    random = np.random.default_rng(0)
    paces = np.repeat(random.choice([0.2, 1.0, 1.3, 3.5], 60), 30)  # some beyond the bounds
    values = np.cumsum(paces) / 30
    times = np.arange(len(values)) / 30
    dense = fit_curve(times, values, spacing=0.31, **bounds)
    monkeypatch.setattr(timewarps, "TUNED", replace(timewarps.TUNED, many_knots=10))
    sparse = fit_curve(times, values, spacing=0.31, **bounds)
    np.testing.assert_allclose(sparse.coefficients, dense.coefficients, rtol=0, atol=1e-9)


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
