"""The timing of walks: steady, with halts, and changing."""

import numpy as np
import pytest

from mocap.datasets.gait import JOG, SNEAK, WALK
from mocap.datasets.gait_timing import PAD, changing, drift, halting, steady
from mocap.datasets.walking_body import FPS

STAGES = [(0, 1.0, 0), (5, 1.0, 0), (7, 2.8, 1), (14, 2.8, 1), (16, 1.0, 0), (20, 1.0, 0)]


def rng() -> np.random.Generator:
    return np.random.default_rng(3)


@pytest.mark.parametrize(("gait", "speed"), [(WALK, 0.8), (WALK, 1.3), (JOG, 2.8), (SNEAK, 0.5)])
def test_a_steady_walk_is_as_fast_as_asked(gait, speed):
    timing = steady(gait, speed, 40.0, rng()).cut()
    assert len(timing.times) == 40 * FPS + 1
    assert timing.times[[0, -1]].tolist() == [0, 40]
    assert timing.phase[0] == timing.distance[0] == 0
    assert np.diff(timing.phase).min() > 0
    assert timing.distance[-1] == pytest.approx(40 * speed, rel=0.05)
    assert timing.weights.shape == (1, len(timing.times))
    assert (timing.weights == 1).all()


def test_vigour_is_one_where_the_stride_is_the_table_s():
    timing = steady(WALK, WALK.speed, 40.0, rng())
    assert timing.vigour.mean() == pytest.approx(1, abs=0.02)
    assert steady(WALK, 0.6, 40.0, rng()).vigour.mean() < 0.9


def test_a_changing_walk_is_in_each_gait_at_its_time():
    timing = changing((WALK, JOG), STAGES, rng()).cut()
    at = (np.array([2, 10, 18]) * FPS).astype(int)
    assert timing.weights.sum(axis=0) == pytest.approx(1)
    assert timing.weights[:, at] == pytest.approx(np.array([[1, 0, 1], [0, 1, 0]]))
    assert timing.weights[1, 6 * int(FPS)] == pytest.approx(0.5)
    pace = np.gradient(timing.distance) * FPS
    assert pace[at] == pytest.approx([1.0, 2.8, 1.0], abs=0.2)
    cadence = 120 * np.gradient(timing.phase) * FPS
    assert cadence[at[1]] == pytest.approx(JOG.cadence, rel=0.1)
    assert cadence[at[[0, 2]]] == pytest.approx(WALK.cadence, rel=0.1)


def test_a_change_comes_smoothly():
    timing = changing((WALK, JOG), STAGES, rng())
    for rate in (np.diff(timing.phase), np.diff(timing.distance), timing.vigour, *timing.weights):
        assert np.abs(np.diff(rate)).max() < 0.01
        assert np.abs(np.diff(rate, 2)).max() * FPS**2 < 10


def test_before_and_after_a_walk_goes_on_as_it_began_and_ended():
    timing = changing((WALK, JOG), STAGES, rng())
    assert timing.times[0] == -PAD
    assert timing.times[-1] == 20 + PAD
    assert (timing.weights[0, [0, -1]] == 1).all()


def test_a_halt_holds_the_phase_and_the_place():
    timing = halting(WALK, (3, 2.5), (2, 1.5, 2)).cut()
    assert np.diff(timing.phase).min() >= 0
    assert timing.vigour.min() == pytest.approx(0, abs=1e-6)
    still = np.diff(timing.phase) < 1e-9
    assert np.count_nonzero(np.diff(still.astype(int)) == 1) == 2  # the first stand has begun before
    assert np.diff(timing.distance)[still].max() < 1e-6
    assert np.mod(timing.skipped, 0.5) == pytest.approx(0)


def test_drift_is_of_unit_size_and_smooth():
    values = drift(rng(), np.arange(0, 400, 1 / FPS), 20)
    assert values.std() == pytest.approx(1, abs=0.1)
    assert np.abs(np.diff(values, axis=0)).max() * FPS < 6 / 2.0 * 2 * np.pi / np.sqrt(3)
