"""No result hangs on the last bit: noise far below any measurement changes no decision.

Another processor, another BLAS or another NumPy changes a clip's numbers by some 1e-15. Here noise of 1e-12 m
is added to roots and places, and of 1e-12 rad to rotations. What a method decides stays the same: which
frames, which edges, in which order. Where two answers are equally good, the method's rule chooses, not the
noise. The inputs have such ties: bodies that stand still, clips that repeat themselves, clips beside their
copies or mirror images, symmetric groups.
"""

from dataclasses import replace
from functools import cache, partial

import networkx as nx
import numpy as np
import pytest
from scipy.ndimage import maximum_filter1d

from mocap import blending, body, editing, feet, graphs, matching, steering, synthesis
from mocap.body import concatenate, resample, rotations
from mocap.datasets import sample
from mocap.editing.cycles import _best, find_loop, repeated
from mocap.graphs.motion_graph import merge_choice_points
from mocap.methods import groups, match_webs, motion_matching, parametric_graphs
from mocap.methods.groups.configurations import cluster, compare
from mocap.steering.layered_search import standing, start_states
from mocap.steering.path_following import follow_as_2002
from tests.bundled import walks_of_16
from tests.feet.quiet_clips import unbent
from tests.refusals import quietly

SIZE = 1e-12  # metres and radians
SEEDS = (1, 2)


class Noise:
    """Add noise to clips and numbers, or none for the seed None."""

    def __init__(self, seed):
        self.random = None if seed is None else np.random.default_rng(seed)

    def numbers(self, values):
        values = np.asarray(values)
        if self.random is None:
            return values
        noise = self.random.normal(0, SIZE, (2, *values.shape))
        return values + (noise[0] + 1j * noise[1] if np.iscomplexobj(values) else noise[0])

    def clip(self, motion):
        if self.random is None:
            return motion
        turns = rotations.from_rotvec(self.random.normal(0, SIZE, (*motion.rotations.shape[:2], 3)))
        turned = rotations.multiply(motion.rotations, turns)
        return replace(motion, root_positions=self.numbers(motion.root_positions), rotations=turned)

    def clips(self, name):
        return [self.clip(motion) for motion in CLIPS[name]()]

    def group(self, group):
        return groups.Configuration(self.numbers(group.positions), self.numbers(group.velocities))


WALK = sample("walk_straight")
CURVE = resample(sample("walk_curve_1"), 30)[:360]


def paused(motion, frame, count):
    """Return a motion that stands still in one frame for some more."""
    return concatenate([motion[:frame], *[motion[frame : frame + 1]] * count, motion[frame:]])


@cache
def rounds(fps):
    """Return four rounds of one stride, which differ by where they are alone."""
    return repeated(editing.loop(resample(WALK, fps), straight=True), 4)


CLIPS = {
    "walks": cache(lambda: [CURVE, resample(sample("walk_circle"), 30)[:300]]),
    "paused": cache(lambda: [paused(CURVE, 60, 30)]),
    "copies": cache(lambda: [CURVE, replace(CURVE, name="copy")]),
    "mirrored": cache(lambda: [CURVE, editing.mirror(CURVE)]),
    "rounds": cache(lambda: [rounds(30)]),
}


def found(noise, name):
    every = matching.find_transitions(noise.clips(name), window=10, below=0.04)
    return [column.tolist() for column in every.columns[:4]]


def built(noise, name):
    return graphs.build(noise.clips(name), window=10, threshold=0.04)


def pruned(noise, name):
    return graphs.prune(built(noise, name))


def edges(graph):
    return list(graph.graph), sorted(graph.graph.edges(keys=True))


def threshold(noise, name):
    clips = noise.clips(name)
    every = matching.find_transitions(clips, window=10, below=0.06)
    thresholds = np.linspace(0.01, 0.06, 11)
    curve = graphs.threshold_curve(clips, every, window=10, thresholds=thresholds)
    return curve.transitions.tolist(), curve.frames.tolist(), curve.suggest()


def followed(noise, name, points, **how):
    once = steering.Settings(tries=1, width=20)
    return quietly(
        partial(steering.follow_path, pruned(noise, name), body.GroundPath(points), settings=once, **how)
    ).walk


def cells(noise):
    """Find the cells of walks on the line x = 0, which is a border between two cells."""
    places = noise.numbers(np.arange(0.05, 2, 0.1) + 0j)
    walks = start_states(np.zeros(len(places), np.intp), np.exp(1j * noise.numbers(0 * places.real)), places)
    return standing(walks, np.zeros(1, complex), 0.1, 0.1).tolist()


def followed_as_2002(noise, name):
    graph = pruned(noise, name)
    start = steering.PathRequest(start=min(graph.graph))
    return follow_as_2002(graph, body.GroundPath([[0, 0], [0, 2]]), start, budget=60).walk


def cheapest(noise):
    """Search a graph in which many ways cost the same."""
    graph = nx.MultiDiGraph()
    ends = [(n, (n + step) % 6) for n in range(6) for step in (1, 2, 3)]
    for (start, end), cost in zip(ends, noise.numbers(np.ones(len(ends))), strict=True):
        graph.add_edge(start, end, frames=1, cost=float(cost))
    walked = synthesis.Problem(
        graph, lambda taken, edge: (graph.edges[edge]["cost"], taken + 1), lambda taken: taken == 5
    )
    best = synthesis.branch_and_bound(walked, 0, 0)
    return best.walk, best.expanded, best.cut


def steered(noise, name):
    controller = steering.Controller(pruned(noise, name))
    played = []
    for heading, speed in ((0.0, 1.0), (np.pi, 1.0)):
        for _ in range(40):
            controller.step(heading, speed)
            played.append((controller.node, tuple(controller.edges)))
    return played


def cycles(noise, motion, **how):
    return find_loop(noise.clip(motion), **how)[:2]


def best_cycle(noise):
    """Find the best cycle of a swing in a grid as exact as 32 bits are."""
    swing = np.abs(np.arange(32) % 8 - 4.0)
    grid = np.abs(np.subtract.outer(swing, swing))
    return _best(np.abs(grid + 1e5 * (noise.numbers(grid) - grid)), 2, 20)[:2]


def registered(noise, first, second, slack=1.2):
    found = quietly(partial(blending.register, [noise.clip(first), noise.clip(second)], slack=slack))
    knots = [len(curve.knots) for curve in found.times]
    times = [curve(np.linspace(*found.span, 9)) for curve in found.times]
    return knots, np.round(found.span, 6).tolist(), np.round(times, 4).tolist()


def time_path(noise, first, second):
    square = matching.distance_grid(noise.clip(first)[::4], noise.clip(second)[::4], window=5)
    return matching.time_path(np.sqrt(square), slack=10).tolist()


def searched(noise, name):
    web = match_webs.build_web(noise.clips(name), below=0.05)
    matches = quietly(partial(match_webs.search, web, 0, slice(60, 95)))
    return web.cells.tolist(), [(one.clip, one.start, one.stop, one.via) for one in matches]


@cache
def unmarked(name):
    return [replace(clip, contacts={}) for clip in CLIPS[name]()]


def cut(noise, name):
    strides = parametric_graphs.cut_strides([noise.clip(clip) for clip in unmarked(name)])
    return len(strides), strides.dropped, np.round(strides.seconds, 6).tolist()


def chosen(noise, name):
    space = parametric_graphs.make_space(parametric_graphs.cut_strides(noise.clips(name)), 0.4, -0.8, 0.8)
    graph = parametric_graphs.build_parametric({"walk": space}, good=0.08, sampling=(6, 20))
    character = parametric_graphs.ParametricController(graph)
    for heading in (0.0, 1.2):
        for _ in range(40):
            character.step(heading, 1.0)
    return [(one.node, np.round(one.allowed, 6).tolist()) for one in character.chosen]


def matched(noise, name):
    matcher = motion_matching.MotionMatcher(motion_matching.tabulate(noise.clips(name)))
    played = []
    for heading in (0.0, 1.2, -0.8):
        for _ in range(30):
            matcher.step(heading, 1.0)
            played.append(matcher.frame)
    return played


def turned_back(noise):
    """Ask again and again for what is straight behind the body, where left is as near as right."""
    table = motion_matching.tabulate(noise.clips("mirrored"))
    signs = []
    for frame in range(0, len(table.heading), 25):
        goal = complex(noise.numbers(-1.0 + 0j))
        signs.append(
            np.sign(motion_matching.nearest_frames.foresee(table, frame, goal, 0.27)[[6, 8]]).tolist()
        )
    return signs


@cache
def flock():
    return groups.simulate(4, 40)


def clustered(noise):
    """Cluster a flock that does the same three times."""
    again = groups.Configuration(*(np.concatenate([part[:130]] * 3) for part in flock()))
    return quietly(partial(cluster, noise.group(again), nodes=6, reach=0.4)).frames.tolist()


ACROSS = groups.Configuration(np.array([1j, -1j]), np.ones(2, complex))
ALONG = groups.Configuration(np.array([1 + 0j, -1 + 0j]), np.ones(2, complex))


def compared(noise):
    """Lay two who go one behind the other on two who go side by side: either may be the left one."""
    match = compare(noise.group(ACROSS), noise.group(ALONG))
    return match.order.tolist(), np.round(complex(match.rotation), 6)


@cache
def group():
    return groups.build_group(3, nodes=1, corridors=(1.5,), simulated=40.0, reach=0.4)


def remade(noise):
    return groups.make_clips([noise.group(node) for node in group().nodes])


def clips_made(noise):
    made = remade(noise)
    return made.tried, [(clip.start, clip.end, clip.order.tolist()) for clip in made.clips]


def planned(noise, points, discs=()):
    start = body.PlanarTransform(*noise.numbers(np.zeros(3)).tolist())
    scene = groups.Scene(tuple(noise.numbers(np.array(points, complex)).tolist()), discs)
    plan = groups.plan_group(remade(noise), scene, start=start)
    return plan.clips, plan.expanded


def led(noise, points):
    scene = groups.Scene(tuple(noise.numbers(np.array(points, complex)).tolist()))
    flock, plan = groups.lead_group(remade(noise), scene)
    return len(flock.positions), plan and plan.clips


def mirrored_plan(noise):
    """Plan with clips and their mirror images to a goal straight ahead: each plan has an equal one."""
    made = remade(noise)
    twins = [
        replace(
            clip,
            positions=clip.positions.conj(),
            velocities=clip.velocities.conj(),
            rotation=clip.rotation.conjugate(),
            translation=clip.translation.conjugate(),
        )
        for clip in made.clips
    ]
    both = groups.GroupGraph(made.nodes, (*made.clips, *twins), 2 * made.tried)
    return groups.plan_group(both, groups.Scene((complex(noise.numbers(9 + 0j)),))).clips


def marks(motion):
    return {name: mark.tolist() for name, mark in motion.contacts.items()}


def marked(noise, motion):
    return marks(feet.mark_plants(noise.clip(replace(motion, contacts={}))))


def cleaned(noise, motion):
    return marks(quietly(partial(feet.clean_up, noise.clip(motion))))


@cache
def lingering():
    late = {name: maximum_filter1d(mark, 61) for name, mark in WALK.contacts.items()}
    return replace(WALK, contacts=late)[:360]


SLIDING = blending.join(WALK, 500, WALK, 242, 40)[440:600]
PAUSED = paused(WALK[100:400], 150, 60)
AHEAD = [[0, 0], [0, 4]]
DISC = (((6 + 0j), 0.5),)

CASES = {
    "marking a pause": lambda noise: marked(noise, PAUSED),
    "marking a statue": lambda noise: marked(noise, concatenate([WALK[100:101]] * 60)),
    "marking rounds": lambda noise: marked(noise, rounds(30)),
    "clean-up of a seam": lambda noise: cleaned(noise, SLIDING),
    **{f"clean-up at {fps} Hz": partial(cleaned, motion=resample(SLIDING, fps)) for fps in (30, 60, 120)},
    "clean-up of straight legs": lambda noise: cleaned(noise, unbent(CURVE[:120], 4)),
    **{
        f"transitions of {name}": partial(found, name=name)
        for name in ("walks", "paused", "copies", "mirrored", "rounds")
    },
    "a pruned graph": lambda noise: edges(pruned(noise, "paused")),
    "merged choice points": lambda noise: edges(
        merge_choice_points(built(noise, "paused"), within=3, threshold=0.04)
    ),
    "a threshold": lambda noise: threshold(noise, "copies"),
    "a random walk": lambda noise: synthesis.random_walk(pruned(noise, "rounds"), seconds=30, seed=1),
    "a path": lambda noise: followed(noise, "mirrored", AHEAD),
    "a bent path": lambda noise: followed(noise, "mirrored", AHEAD, bend=1.0),
    "cells of a straight path": cells,
    "a path as in 2002": lambda noise: followed_as_2002(noise, "mirrored"),
    "branch and bound": cheapest,
    "control": lambda noise: steered(noise, "mirrored"),
    "the best cycle of a swing": best_cycle,
    "a loop": lambda noise: cycles(noise, resample(WALK, 30)),
    "a loop of rounds": lambda noise: cycles(noise, rounds(30)),
    "a loop of rounds at 120 Hz": lambda noise: cycles(noise, rounds(120)),
    "registration": lambda noise: registered(noise, WALK[100:500], WALK[233:640]),
    "registration of a clip with itself": lambda noise: registered(noise, PAUSED, PAUSED),
    "registration of a mirror image": lambda noise: registered(
        noise, WALK[100:500], editing.mirror(WALK[100:500])
    ),
    "a time path through a pause": lambda noise: time_path(noise, PAUSED, paused(WALK[100:400], 150, 100)),
    "a time path to a mirror image": lambda noise: time_path(
        noise, WALK[100:500], editing.mirror(WALK[100:500])
    ),
    "a match web": lambda noise: searched(noise, "copies"),
    "strides": lambda noise: cut(noise, "mirrored"),
    "parametric control": lambda noise: chosen(noise, "walks"),
    "motion matching": lambda noise: matched(noise, "copies"),
    "motion matching of rounds": lambda noise: matched(noise, "rounds"),
    "a goal behind": turned_back,
    "clusters of groups": clustered,
    "groups that are symmetric": compared,
    "clips of groups": clips_made,
    "a group's plan": lambda noise: planned(noise, (12, 20), DISC),
    "a group that is led back": lambda noise: led(noise, (-9,)),
    "a group's plan of mirrored clips": mirrored_plan,
}


@cache
def without_noise(name):
    return CASES[name](Noise(None))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", CASES)
def test_noise_changes_no_decision(name, seed):
    assert CASES[name](Noise(seed)) == without_noise(name)


def changed(decide, seeds=SEEDS):
    """Check whether some seed's noise changes a decision."""
    usual = decide(Noise(None))
    return any(decide(Noise(seed)) != usual for seed in seeds)


@pytest.mark.sweep
def test_noise_changes_no_plant_that_is_out_of_reach():
    assert not changed(lambda noise: cleaned(noise, lingering()), range(8))


@pytest.mark.sweep
@pytest.mark.parametrize("fps", [30.0, 60.0, 120.0])
def test_noise_changes_no_decision_of_clean_up_at_any_rate(real_data, fps):
    clips = [feet.mark_plants(resample(clip, fps)) for clip in walks_of_16(real_data)[:6]]
    assert not changed(lambda noise: [cleaned(noise, clip) for clip in clips])


def captured_transitions(noise, clips):
    every = matching.find_transitions([noise.clip(clip) for clip in clips], window=10, below=0.04)
    return [column.tolist() for column in every.columns[:4]]


CAPTURED = {
    "marking": lambda noise, clips: [marked(noise, clip) for clip in clips],
    "transitions": captured_transitions,
    "loops": lambda noise, clips: [cycles(noise, clip) for clip in clips],
    "a match web": lambda noise, clips: match_webs.build_web(
        [noise.clip(clip) for clip in clips], below=0.05
    ).cells.tolist(),
    "a path": lambda noise, clips: followed_on(noise, clips),
}


def followed_on(noise, clips):
    graph = graphs.prune(graphs.build([noise.clip(clip) for clip in clips], window=10, threshold=0.04))
    once = steering.Settings(tries=1)
    return quietly(partial(steering.follow_path, graph, body.s_curve(), settings=once)).walk


@pytest.mark.sweep
@pytest.mark.parametrize("name", CAPTURED)
def test_noise_changes_no_decision_on_captured_clips(real_data, name):
    clips = [resample(clip, 30) for clip in walks_of_16(real_data)[:8]]
    assert not changed(partial(CAPTURED[name], clips=clips))
