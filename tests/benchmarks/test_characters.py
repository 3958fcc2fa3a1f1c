"""Time of steps of characters, of building what they play, and of groups, as ratios within one run.

See the ratios: pytest -m benchmark -n 0 tests/benchmarks/test_characters.py
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
from tests.benchmarks.timing import add_poses, fastest, hold, ratio, yardstick
from tests.bundled import WALKS, bundled, clips
from tests.methods.groups.built import course, graph
from tests.methods.parametric_graphs.built import stepping, walking

pytestmark = pytest.mark.benchmark
STEPS = 1200  # 40 seconds


def additions():
    """Add poses as often as 1200 steps take at 10 000 poses per second."""
    for _ in range(STEPS):
        add_poses()


def steps(make):
    """Return a work: a walk of 40 seconds with another heading in each frame."""
    character = make()

    def walk():
        for frame in range(STEPS):
            character.step(0.01 * frame, 0.8)

    return walk


def characters():
    """Return a function for each kind of character that makes one, all of the same clips."""
    compiled = graphs.compile_graph(bundled(*WALKS))
    table = tabulate(clips())
    walks = walking()
    paces = stepping(0.04)
    gc.freeze()
    return {
        "motion graph": lambda: Controller(compiled),
        "turned": lambda: FootTurner(Controller(compiled), np.radians(40)),
        "strides": lambda: ParametricController(walks),
        "steps": lambda: ParametricController(paces),
        "matching": lambda: MotionMatcher(table),
    }


def test_steps_beside_those_of_a_character_on_a_motion_graph():
    makers = characters()
    *walked, bare = fastest(*map(steps, makers.values()), additions, repeats=3)
    times = dict(zip(makers, walked, strict=True))
    hold("a step of a motion graph, in 250 additions", times["motion graph"] / bare, 8)
    hold("a turned step, in steps of a graph", times["turned"] / times["motion graph"], 1.3)
    for name in ("matching", "strides", "steps"):
        hold(f"a step of {name}, in steps of a graph", times[name] / times["motion graph"], 1)
    for name, bound in (("strides", 1), ("steps", 1.7)):
        hold(f"a step of {name}, in 250 additions", times[name] / bare, bound)


def test_worst_steps_beside_those_of_a_character_on_a_motion_graph():
    """The worst step of a run is that of the best of five runs: other processes delay single steps."""
    makers = characters()
    worst = {}
    for name, make in makers.items():
        worst[name] = min(measure_delay(make(), speed=0.8).worst for _ in range(5))
    for name, bound in (("matching", 1.2), ("strides", 3), ("steps", 3)):
        hold(f"the worst step of {name}, in those of a graph", worst[name] / worst["motion graph"], bound)


def build_graph():
    graphs.compile_graph(graphs.prune(graphs.build(list(clips()), window=10, threshold=0.04)))


def test_to_prepare_matching_is_cheap_beside_a_graph():
    hold("to tabulate, in building the graph", ratio(lambda: tabulate(clips()), build_graph, 3), 0.8)


@pytest.mark.filterwarnings("ignore:6 nodes are within")  # of 24 members
@pytest.mark.parametrize(("count", "nodes"), [(6, 6), (12, 8), (24, 6)])
def test_a_group_is_played_at_a_fiftieth_of_its_simulation(count, nodes):
    group = graph(count, nodes)
    walk = groups.random_group_walk(group, 30)
    play = partial(groups.play_group, group, walk)
    simulate = partial(groups.simulate, count, 100)
    hold(f"playing 120 s of {count}, in simulating them", ratio(play, simulate, 3), 1 / 50)


def test_to_build_a_group_takes_at_most_twelve_times_as_long_as_to_simulate_its_five_minutes():
    build = partial(groups.build_group, 12)
    simulate = partial(groups.simulate, 12, 300)
    hold("to build a group, in simulating its 300 s", ratio(build, simulate, 2), 12)


def test_a_search_takes_at_most_four_times_as_long_as_simulating():
    """The mean over the courses among eight discs that have a plan; seed 0 is closed from the start."""
    group = graph()
    ratios = []
    for seed in range(1, 12):
        scene = course(seed)
        seconds = groups.plan_group(group, scene).seconds
        search = partial(groups.plan_group, group, scene)
        simulate = partial(groups.simulate, 12, max(seconds - 20, 1))
        ratios.append(ratio(search, simulate, 2))
    hold("a search of a group, in simulating its plan", np.mean(ratios), 4)


def test_twelve_characters_take_a_few_yardsticks_for_each_second():
    """A yardstick takes some 10 ms: 20 for each second are a fifth of its duration."""
    group = graph()
    plan = groups.play_group(group, groups.random_group_walk(group, 15, seed=2))
    compiled = graphs.compile_graph(bundled(*WALKS))
    seconds = (len(plan.positions) - 1) / groups.RATE
    walk = partial(groups.walk_group, compiled, plan)
    hold("twelve characters, yardsticks per second", ratio(walk, yardstick, 1) / seconds, 20)
