"""The product finds the frame that a plain loop finds; the future is what the springs say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from mocap.methods.motion_matching.nearest_frames import FrameSearch, fade, foresee, spring, spring_way
from mocap.methods.motion_matching.pose_database import FUTURE, features
from tests.methods.motion_matching.matched import walks
from tests.refusals import refused


def queries(count, seed=0):
    """Real poses with other futures: what a character asks."""
    table, random = walks(), np.random.default_rng(seed)
    rows = table.values[random.integers(0, len(table), count)].copy()
    rows[:, FUTURE] = table.values[random.integers(0, len(table), count)][:, FUTURE]
    return rows


@pytest.mark.parametrize("future", [1.0, 0.25])
def test_the_product_finds_what_a_loop_finds(future):
    table, weigh = walks(), np.ones(27)
    search = FrameSearch(table, future=future)
    weigh[FUTURE] = future
    for number, query in enumerate(queries(30)):
        now, near = 37 * number, 6
        costs = (((query - table.values) * weigh) ** 2).sum(axis=1)
        costs[~table.usable | (np.abs(np.arange(len(table)) - now) < near)] = np.inf
        found, paid = search.nearest(query, now, near)
        assert paid == pytest.approx(costs.min(), rel=1e-4)  # 32 bits may take a twin
        assert search.cost(query, found) == paid == pytest.approx(costs[found])


def test_frames_near_now_are_not_found_and_where_all_are_near_none_is():
    table = walks()
    few = replace(table, usable=np.isin(np.arange(len(table)), range(100, 104)))
    assert FrameSearch(table).nearest(table.values[200], now=200, near=0)[0] == 200
    assert abs(FrameSearch(table).nearest(table.values[200], now=200, near=6)[0] - 200) >= 6
    assert FrameSearch(few).nearest(table.values[50], now=102, near=6) == (102, np.inf)


def test_to_go_on_as_the_clip_does_is_to_foresee_its_future():
    """Walking straight at one speed, the springs and the clip agree on the next second to 5 cm."""
    table = walks()
    start = sum(len(clip) for clip in table.clips[:3])
    now = start + 100
    goal = complex(table.drift[now] * np.exp(-1j * table.heading[now]))
    ahead = foresee(table, now, goal, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    np.testing.assert_allclose(ahead[:6], features(table.clips[3])[100, 15:21], atol=0.05)


def test_told_to_stop_it_keeps_facing_as_it_does():
    table = walks()
    ahead = foresee(table, 100, 0j, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    assert np.hypot(*ahead[4:6]) < 0.4 and ahead[11] > 0.9


def test_a_search_among_no_frames_is_refused():
    table = replace(walks(), usable=np.zeros(len(walks()), bool))
    refused("No frame '' can be found", FrameSearch, table)


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
