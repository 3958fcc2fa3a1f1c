"""How long graphs take to build, prune and sweep, and how that grows with the clips.

Run them alone, and see the numbers: pytest -m benchmark -n 0 -s tests/benchmarks/test_graphs.py
"""

import time
from dataclasses import replace

import numpy as np
import pytest

import mocap
from mocap.graph_summary import threshold_sweep
from mocap.motion_graph import build, from_transitions, prune
from mocap.pruning import prune_graph
from mocap.transforms import IDENTITY
from mocap.transitions import Transition
from tests.strategies import wave

pytestmark = pytest.mark.benchmark

WALKS = [f"16_{number}" for number in (*range(11, 35), 47, 58)]


def seconds(work, rounds=5):
    """Measure the least time of a few, when nothing else disturbed it."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


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
    taken = seconds(lambda: made(clips))
    print(f"\nbuild and prune {len(clips)} clips: {taken:.2f} s")
    assert taken < 1


def test_time_grows_no_faster_than_the_pairs_of_frames(walks):
    once, more = seconds(lambda: made(at_speeds(walks, 1))), seconds(lambda: made(at_speeds(walks, 3)), 2)
    print(f"\n3 times the frames: {more / once:.1f} times the time, at most 9")
    assert more / once <= 9


def random_transitions(count, frames):
    random = np.random.default_rng(0)
    leave, enter = random.integers(0, frames - 10, (2, count)).tolist()
    costs = random.uniform(0.01, 0.1, count).tolist()
    return [Transition(0, i, 0, j, cost, IDENTITY) for i, j, cost in zip(leave, enter, costs, strict=True)]


SIZES = (10_000, 80_000)


def growth(work, inputs):
    """Tell how many times longer an edge takes in the larger input than in the smaller."""
    small, large = (seconds(lambda x=x: work(x), 3) / size for x, size in zip(inputs, SIZES, strict=True))
    return large / small


def test_pruning_is_linear_in_the_edges():
    clips = [wave(SIZES[-1])]
    graphs = [
        from_transitions([clips[0][:size]], random_transitions(size, size), window=10).graph for size in SIZES
    ]
    ratio = growth(prune_graph, graphs)
    print(f"\npruning, an edge in a graph 8 times as large: {ratio:.2f} times the time, at most 2")
    assert ratio <= 2


def test_the_sweep_is_linear_in_the_edges():
    clip = wave(SIZES[-1])
    levels = np.linspace(0.02, 0.1, 20)

    def sweep(size):
        return lambda: threshold_sweep([clip[:size]], random_transitions(size, size), levels, window=10)

    ratio = growth(lambda work: work(), [sweep(size) for size in SIZES])
    print(f"\nsweep, an edge in a graph 8 times as large: {ratio:.2f} times the time, at most 2")
    assert ratio <= 2
