"""How long graphs take to build, prune and sweep, and how that grows with the clips.

Run them alone, and see the numbers: pytest -m benchmark -n 0 -s tests/benchmarks/test_graphs.py
"""

from dataclasses import replace

import numpy as np
import pytest

import mocap
from mocap.body.planar import PlanarTransform
from mocap.graphs.motion_graph import build, from_transitions
from mocap.graphs.pruning import prune, prune_graph
from mocap.graphs.thresholds import threshold_curve
from mocap.matching.transitions import Transitions
from tests.benchmarks.timing import fastest, least
from tests.strategies import wave

pytestmark = pytest.mark.benchmark

WALKS = [f"16_{number}" for number in (*range(11, 35), 47, 58)]


@pytest.fixture(scope="module")
def walks(real_data):
    return [mocap.load(real_data / f"cmu/16/{name}.amc") for name in WALKS]


def at_speeds(walks, count):
    """Play every walk at so many speeds: `count` times the frames, and no two clips the same."""
    speeds = np.linspace(0.9, 1.1, count) if count > 1 else [1.0]
    return [
        replace(mocap.resample(replace(walk, fps=120 * speed), 30.0), name=f"{walk.name} at {speed:.2f}")
        for walk in walks
        for speed in speeds
    ]


def made(clips):
    return prune(build(clips, window=10, threshold=0.03))


def test_the_walks_of_cmu_16_take_less_than_a_second(walks):
    clips = at_speeds(walks, 1)
    assert sum(map(len, clips)) == 2521
    taken = least(lambda: made(clips))
    print(f"\nbuild and prune {len(clips)} clips: {taken:.2f} s")
    assert taken < 1


def test_time_grows_no_faster_than_the_pairs_of_frames(walks):
    few, many = at_speeds(walks, 1), at_speeds(walks, 4)
    once, more = fastest(lambda: made(few), lambda: made(many), turns=2)
    print(f"\n4 times the frames: {more / once:.1f} times the time, at most 16")
    assert more / once <= 16


def random_transitions(count, frames):
    random = np.random.default_rng(0)
    leave, enter = random.integers(0, frames - 10, (2, count))
    zero = np.zeros(count, int)
    costs = random.uniform(0.01, 0.1, count)
    return Transitions(zero, leave, zero, enter, costs, PlanarTransform(zero, zero, zero))


SMALL, LARGE = 10_000, 40_000


def hold(what, work, small, large):
    """Let an edge take at most twice as long in the larger input: caches, but no worse power."""
    times = fastest(lambda: work(small), lambda: work(large))
    ratio = times[1] / times[0] / (LARGE / SMALL)
    print(f"\n{what}, an edge of {LARGE} against one of {SMALL}: {ratio:.2f} times the time, at most 2")
    assert ratio <= 2


def test_pruning_is_linear_in_the_edges():
    graphs = (from_transitions([wave(n)], random_transitions(n, n), window=10).graph for n in (SMALL, LARGE))
    hold("pruning", prune_graph, *graphs)


def test_the_curve_over_thresholds_is_linear_in_the_edges():
    levels = np.linspace(0.02, 0.1, 20)

    def curve(inputs):
        threshold_curve(*inputs, window=10, thresholds=levels)

    hold("threshold curve", curve, *(([wave(n)], random_transitions(n, n)) for n in (SMALL, LARGE)))
