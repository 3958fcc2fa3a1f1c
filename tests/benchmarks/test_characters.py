"""How quick characters and crowds are, as ratios within one run, on a machine that does nothing else.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_characters.py
"""

import gc

import numpy as np
import pytest

from mocap import graphs, groups
from mocap.control import Controller, FootTurner
from mocap.motion_matching import MotionMatcher, tabulate
from mocap.parametric_graphs import ParametricController
from tests.benchmarks.test_matching import fastest
from tests.bundled import bundled
from tests.groups.built import course, graph
from tests.parametric_graphs.built import WALKS, clips, stepping, walking

pytestmark = pytest.mark.benchmark
STEPS = 1200


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
    times = dict(zip(makes, fastest(*map(steps, makes.values()), turns=3), strict=True))
    for name, took in times.items():
        print(f"\n{name}: {STEPS / took:.0f} poses per second, {took / times['motion graph']:.2f} ×", end="")
    assert times["matching"] <= times["motion graph"]
    assert max(times["strides"], times["steps"]) <= 2 * times["motion graph"]


def test_to_prepare_matching_is_cheap_beside_a_graph():
    built, tabled = fastest(
        lambda: graphs.compile_graph(graphs.prune(graphs.build(list(clips()), window=10, threshold=0.04))),
        lambda: tabulate(clips()),
        turns=3,
    )
    print(f"\nto tabulate takes {tabled / built:.2f} of building the graph")
    assert tabled <= 0.8 * built


@pytest.mark.parametrize(("count", "nodes"), [(6, 6), (12, 8)])
def test_a_group_is_played_at_a_fiftieth_of_its_simulation(count, nodes):
    group = graph(count, nodes)
    walk = groups.random_group_walk(group, 30)
    simulated, played = fastest(
        lambda: groups.simulate(count, 100, settle=20), lambda: groups.play_group(group, walk), turns=3
    )
    print(f"\nplaying takes 1/{simulated / played:.0f} of simulating the same 120 s")
    assert played <= simulated / 50


def test_bounds_make_a_search_twice_as_quick():
    group, scene = graph(), course(1)
    slow, quick = fastest(
        lambda: groups.plan_group(group, scene, bounds=False),
        lambda: groups.plan_group(group, scene),
        turns=3,
    )
    seconds = groups.plan_group(group, scene).seconds
    (simulated,) = fastest(lambda: groups.simulate(12, seconds, settle=0), turns=3)
    print(
        f"\nwith bounds {slow / quick:.1f} × as quick; the search takes {quick / simulated:.1f} × simulating"
    )
    assert slow >= 2 * quick


def test_twelve_characters_for_a_minute_take_a_fifth_of_it():
    group = graph()
    walk = groups.random_group_walk(group, 4, seed=2)
    plan = groups.play_group(group, walk)
    compiled = graphs.compile_graph(bundled(*WALKS))
    (took,) = fastest(lambda: groups.walk_group(compiled, plan), turns=1)
    seconds = (len(plan.places) - 1) / groups.RATE
    print(f"\ntwelve characters take 1/{seconds / took:.1f} of {seconds:.0f} s")
    assert took <= seconds / 5
