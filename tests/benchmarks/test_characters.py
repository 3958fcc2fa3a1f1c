"""How quick characters and crowds are, as ratios within one run, on a machine that does nothing else.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_characters.py
"""

import gc
from functools import partial

import numpy as np
import pytest

from mocap import graphs
from mocap.methods import groups
from mocap.methods.motion_matching import MotionMatcher, tabulate
from mocap.methods.parametric_graphs import ParametricController
from mocap.steering import Controller, FootTurner, measure_delay
from tests.benchmarks.timing import fastest
from tests.bundled import WALKS, bundled, clips
from tests.methods.groups.built import course, graph
from tests.methods.parametric_graphs.built import stepping, walking

pytestmark = pytest.mark.benchmark
STEPS = 1200
POSE = np.ones((38, 4))


def additions():
    """Add poses, 250 per step: where that takes 0.1 ms, a step as quick makes 10 000 poses per second."""
    for _ in range(250 * STEPS):
        np.add(POSE, POSE)


def steps(make):
    """Walk for 40 seconds, with another heading in each frame."""
    character = make()

    def walk():
        for frame in range(STEPS):
            character.step(0.01 * frame, 0.8)

    return walk


def test_steps_beside_those_of_a_character_on_a_motion_graph():
    compiled, table = graphs.compile_graph(bundled(*WALKS)), tabulate(clips())
    gc.freeze()
    makes = {
        "motion graph": lambda: Controller(compiled),
        "turned": lambda: FootTurner(Controller(compiled), np.radians(40)),
        "strides": lambda: ParametricController(walking()),
        "steps": lambda: ParametricController(stepping(0.04)),
        "matching": lambda: MotionMatcher(table),
    }
    *walked, bare = fastest(*map(steps, makes.values()), additions, turns=3)
    times = dict(zip(makes, walked, strict=True))
    for name, took in times.items():
        print(f"\n{name}: {STEPS / took:.0f} poses per second, {took / times['motion graph']:.2f} ×", end="")
        print(f" the graph's time, {took / bare:.2f} × that of 250 additions", end="")
    assert times["matching"] <= times["motion graph"]
    assert max(times["strides"], times["steps"]) <= times["motion graph"]
    assert times["strides"] <= bare and times["steps"] <= 1.7 * bare


def test_worst_steps_beside_those_of_a_character_on_a_motion_graph():
    """The worst step of a run, in the best of five runs: what else the machine does is not the step's."""
    compiled, table = graphs.compile_graph(bundled(*WALKS)), tabulate(clips())
    walks, steps_ = walking(), stepping(0.04)
    gc.freeze()
    makes = {
        "motion graph": lambda: Controller(compiled),
        "strides": lambda: ParametricController(walks),
        "steps": lambda: ParametricController(steps_),
        "matching": lambda: MotionMatcher(table),
    }
    worst = {n: min(measure_delay(make(), speed=0.8).worst for _ in range(5)) for n, make in makes.items()}
    print("\nworst steps:", ", ".join(f"{name} {took:.2f} ms" for name, took in worst.items()))
    assert worst["matching"] <= 1.2 * worst["motion graph"]
    assert max(worst["strides"], worst["steps"]) <= 3 * worst["motion graph"]


def test_to_prepare_matching_is_cheap_beside_a_graph():
    built, tabled = fastest(
        lambda: graphs.compile_graph(graphs.prune(graphs.build(list(clips()), window=10, threshold=0.04))),
        lambda: tabulate(clips()),
        turns=3,
    )
    print(f"\nto tabulate takes {tabled / built:.2f} of building the graph")
    assert tabled <= 0.8 * built


@pytest.mark.filterwarnings("ignore:6 nodes are within")  # of 24 members
@pytest.mark.parametrize(("count", "nodes"), [(6, 6), (12, 8), (24, 6)])
def test_a_group_is_played_at_a_fiftieth_of_its_simulation(count, nodes):
    group = graph(count, nodes)
    walk = groups.random_group_walk(group, 30)
    simulated, played = fastest(
        lambda: groups.simulate(count, 100), lambda: groups.play_group(group, walk), turns=3
    )
    print(f"\nplaying takes 1/{simulated / played:.0f} of simulating the same 120 s")
    assert played <= simulated / 50


def test_to_build_a_group_takes_at_most_twelve_times_as_long_as_to_simulate_its_five_minutes():
    built, simulated = fastest(lambda: groups.build_group(12), lambda: groups.simulate(12, 300), turns=2)
    print(f"\nto build a group takes {built:.1f} s, {built / simulated:.1f} × simulating")
    assert built <= 12 * simulated


def test_a_search_takes_at_most_four_times_as_long_as_simulating():
    """On average over the courses among eight discs that are found; seed 0 is closed from the start."""
    group, times = graph(), []
    for seed in range(1, 12):
        scene = course(seed)
        seconds = groups.plan_group(group, scene).seconds
        searched, simulated = fastest(
            partial(groups.plan_group, group, scene),
            partial(groups.simulate, 12, max(seconds - 20, 1)),
            turns=2,
        )
        times.append(searched / simulated)
    print(f"\na search takes {np.mean(times):.1f} × simulating, {np.median(times):.1f} in the middle")
    assert np.mean(times) <= 4


def test_twelve_characters_for_a_minute_take_a_fifth_of_it():
    group = graph()
    walk = groups.random_group_walk(group, 15, seed=2)
    plan = groups.play_group(group, walk)
    compiled = graphs.compile_graph(bundled(*WALKS))
    (took,) = fastest(lambda: groups.walk_group(compiled, plan), turns=1)
    seconds = (len(plan.places) - 1) / groups.RATE
    print(f"\ntwelve characters take 1/{seconds / took:.1f} of {seconds:.0f} s")
    assert took <= seconds / 5
