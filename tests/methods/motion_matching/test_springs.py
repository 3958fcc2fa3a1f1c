"""Springs against a differential equation solved by SciPy, and against their own integral."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from mocap.methods.motion_matching.nearest_frames import fade, spring, spring_way


def test_after_its_half_life_0_597_of_a_gap_is_left_and_half_after_1_211():
    assert spring(1.0, 0.0, 0.0, 0.3, 0.3) == pytest.approx((1 + 2 * np.log(2)) / 4)
    assert spring(1.0, 0.0, 0.0, 0.3, 1.21067 * 0.3) == pytest.approx(0.5, abs=1e-4)


def test_it_solves_the_equation_of_a_critically_damped_spring():
    pull = 2 * np.log(2) / 0.27
    solved = solve_ivp(
        lambda t, x: [x[1], -2 * pull * x[1] - pull**2 * (x[0] - 3)],
        (0, 1.5),
        [1.0, -4.0],
        rtol=1e-9,
        atol=1e-10,
    )
    assert spring(1.0, -4.0, 3.0, 0.27, 1.5) == pytest.approx(solved.y[0, -1], abs=1e-7)


def test_the_way_is_the_integral_of_the_velocity_also_of_complex_ones():
    speed, goal, seconds = 0.4 - 1j, 1.2 + 0.3j, 0.8
    parts = [
        quad(lambda t, p=part: p(spring(speed, 0.0, goal, 0.27, t)), 0, seconds)[0]
        for part in (np.real, np.imag)
    ]
    assert spring_way(speed, goal, 0.27, seconds) == pytest.approx(complex(*parts), abs=1e-9)


def test_two_short_fades_are_one_long_fade_and_leave_nothing():
    offset, speed = np.array([0.3, -0.2]), np.array([1.0, 2.0])
    twice = fade(*fade(offset, speed, 0.1, 0.05), 0.1, 0.05)
    np.testing.assert_allclose(twice, fade(offset, speed, 0.1, 0.1), atol=1e-12)
    np.testing.assert_allclose(fade(offset, speed, 0.1, 0.1)[0], spring(offset, speed, 0.0, 0.1, 0.1))
    assert np.abs(fade(offset, speed, 0.1, 3.0)).max() < 1e-12
