"""Walks against the duration of their motion: `pytest -m benchmark -n 0 tests/benchmarks/test_walks.py`.

All times are CPU seconds, the least of some runs, so that a busy machine is no failure.
"""

import pytest

from mocap.body import ground_path
from mocap.body.ground_path import s_curve
from mocap.steering import Controller, FootTurner, measure_delay
from mocap.steering.path_following import follow_path
from mocap.synthesis.random_walks import random_walk
from mocap.synthesis.walk_to_motion import to_motion
from tests.benchmarks.timing import least
from tests.bundled import walking

pytestmark = pytest.mark.benchmark


def test_walks_are_played_in_a_hundredth_of_their_duration():
    walk = random_walk(walking().source, seconds=600, seed=1)
    motion = to_motion(walking().source, walk)
    assert least(lambda: to_motion(walking().source, walk)) < motion.duration / 100


def test_playing_is_linear():
    walks = [random_walk(walking().source, seconds=s, seed=1) for s in (100, 800)]
    short, long = (least(lambda walk=walk: to_motion(walking().source, walk)) for walk in walks)
    assert long < 14 * short


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
@pytest.mark.parametrize("shape", ground_path.SHAPES)
def test_paths_are_followed_in_a_fiftieth_of_the_motion(shape):
    path = ground_path.SHAPES[shape]()
    followed = follow_path(walking(), path)
    assert least(lambda: follow_path(walking(), path)) < followed.seconds / 50


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_following_is_linear():
    short, long = (least(lambda n=n: follow_path(walking(), s_curve(n)), 2) for n in (10, 80))
    assert long < 12 * short


def test_a_step_takes_a_millisecond():
    delay = measure_delay(Controller(walking()), turns=20)
    assert delay.step < 1.0
    assert delay.worst < 5.0


def test_to_turn_about_the_standing_foot_takes_a_third_of_a_step_more():
    alone, turned = (
        min(measure_delay(make(), turns=20, seed=seed).step for seed in range(3))
        for make in (lambda: Controller(walking()), lambda: FootTurner(Controller(walking())))
    )
    assert turned < 1.3 * alone
