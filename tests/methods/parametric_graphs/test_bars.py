"""What a parametric graph of walks is held to: on the bundled clips, and on the homework's walker.

The same for strides and for steps. A graph of the bundled clips has T_GOOD = 3 cm, of the homework's 5.5 cm
for strides and 4 cm for steps.
"""

from typing import NamedTuple

import numpy as np
import pytest
import turns_held_out
from turns_held_out import CASES, WAYS

from mocap.body.motion import resample
from mocap.feet.footplants import mark_plants
from mocap.files.load_save import load
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.methods.parametric_graphs.parametric_edges import (
    BAD,
    ParametricGraph,
    Sampling,
    build_edge,
    build_parametric,
)
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters, make_space
from mocap.methods.parametric_graphs.strides import cut_strides
from mocap.quality import plant_slides
from mocap.steering import Controller, command_headings, steer
from tests.bundled import bundled
from tests.methods.parametric_graphs import built
from tests.methods.parametric_graphs.built import SHARE, bad_ones, space, walk_anywhere

SPEED = 0.8
STRIDES, STEPS = ("lrl",), ("lr", "rl")


class Walks(NamedTuple):
    """A parametric graph, and T_GOOD in metres."""

    graph: ParametricGraph
    good: float

    @property
    def edges(self):
        space, edges = self.graph.space, self.graph.graph.edges
        return [(space(a), space(b), self.graph.edge(a, b)) for a, b in edges]


def walks(spaces, kinds, good):
    following = [(kind, kinds[(number + 1) % len(kinds)]) for number, kind in enumerate(kinds)]
    return Walks(build_parametric(spaces, following, good=good), good)


def of_bundled(kinds, good=0.03):
    if kinds == STRIDES:
        return Walks(built.walking(good), good)
    return walks({kind: space(kind) for kind in kinds}, kinds, good)


def of_homework(some, kinds):
    spaces = {}
    for kind in kinds:
        width, high = np.radians([14, 120]) * SHARE[kind]
        spaces[kind] = make_space(cut_strides(some, feet=kind), width, -high, high)
    return walks(spaces, kinds, 0.055 if kinds == STRIDES else 0.04)


@pytest.fixture(scope="module")
def homework(real_data):
    paths = sorted((real_data / "hw3").glob("*.AMC"))
    return tuple(mark_plants(resample(load(path), 30)) for path in paths)


@pytest.fixture(
    scope="module",
    params=[
        ("bundled", STRIDES),
        pytest.param(("bundled", STEPS), marks=pytest.mark.exhaustive),
        pytest.param(("homework", STRIDES), marks=pytest.mark.exhaustive),
        pytest.param(("homework", STEPS), marks=pytest.mark.exhaustive),
    ],
    ids=["bundled strides", "bundled steps", "homework strides", "homework steps"],
)
def walking(request):
    name, kinds = request.param
    if name == "bundled":
        return of_bundled(kinds)
    return of_homework(request.getfixturevalue("homework"), kinds)


def test_boxes_hold_next_to_no_bad_target_among_fresh_ones_and_among_those_drawn_inside(walking):
    """As in [HG07, 4]. A box of no width holds none of the fresh targets: so draw inside each one, too."""
    for source, target, edge in walking.edges:
        boxes, share = bad_ones(source, target, edge, BAD * walking.good, seed=0)
        assert boxes <= 0.1 and share <= 0.01
        at = draw_parameters(source, 100, np.random.default_rng(0))
        within = [optimal_transitions(source, target, a[None], _inside(edge.look_up(a))).cost for a in at]
        assert (np.array(within) > BAD * walking.good).mean() <= 0.02


def _inside(way, count=20):
    return np.linspace(np.minimum(way.low, way.high), np.maximum(way.low, way.high), count)


def test_seams_of_300_random_targets_cost_what_the_edges_promise(walking):
    """And at the looked-up phases nearly as little as at the best ones."""
    character = ParametricController(walking.graph)
    pairs = walk_anywhere(character, 300)
    cost = np.array([chosen.cost for chosen in character.chosen])
    bad = BAD * walking.good
    assert cost.max() <= bad + 0.01 and (cost > bad).mean() <= 0.02
    best = [
        optimal_transitions(
            walking.graph.space(node), walking.graph.space(chosen.node), at[None], chosen.taken[None]
        ).cost[0, 0]
        for (node, at), chosen in zip(pairs[:60], character.chosen, strict=False)
    ]
    assert cost[:60].mean() <= 1.15 * np.mean(best)


def test_what_was_got_is_said_and_one_turn_over_and_over_is_no_circle(walking):
    """Seams are aligned by the whole body, and turn it: up to some degrees a stride."""
    character = ParametricController(walking.graph)
    tested = walking.graph.space(character.node)
    character._wish = lambda *_: np.full(1, np.radians(20))
    facing = []
    while len(character.chosen) < 12:
        before = len(character.chosen)
        character.step(0.0, SPEED)
        if len(character.chosen) > before:
            facing.append(character.place.angle)
    got = np.degrees([chosen.got[0] for chosen in character.chosen[3:]])
    assert np.abs(got - np.degrees(character.chosen[-1].taken[0])).max() <= 1
    assert tested.parameters == ("turn",)
    turned = np.degrees(np.diff(np.unwrap(facing)))[3:]
    assert np.abs(turned[-8:].mean() - 20) < 8


def slide(character):
    """How far planted joints stray from their mean place in 30 s of turns; plants as the clips say."""
    headings = command_headings(30, character.fps).tolist()
    plants = plant_slides(steer(character, headings, SPEED).motion)
    return np.mean([plant.far for plant in plants if plant.stop - plant.start > 2])


def test_feet_slide_no_more_than_those_of_a_motion_graph_of_the_same_clips():
    plain = slide(Controller(bundled(*built.WALKS)))
    for graph in (built.walking(), built.stepping(0.04)):
        assert slide(ParametricController(graph)) <= 1.3 * plain


def test_bad_thresholds_twice_the_good_ones_cut_no_box():
    """Between T_GOOD and 1.35 T_GOOD a target may be in a box; with 2 T_GOOD none is ever cut off."""
    source = space()
    thresholds, few = (0.03, BAD * 0.03, 0.06, 1.0), Sampling(targets=300)
    edges = [build_edge(source, source, good=0.03, bad=bad, sampling=few) for bad in thresholds]
    widths = [(edge.high - edge.low).mean() for edge in edges]
    assert widths[0] < widths[1] <= widths[2] == pytest.approx(widths[3], rel=0.01)


CURVES, STRIKES, PLAIN, ANYWHERE = WAYS


@pytest.fixture(scope="module")
def strides(real_data):
    with pytest.warns(match="may not be the same kind of motion"):  # straight on, and turns by 180°
        return turns_held_out.walker(real_data / "bvh" / "puppy0512_motion_graph")


@pytest.mark.exhaustive
@pytest.mark.parametrize("case", CASES[:2], ids=str)
def test_straight_on_and_90_degrees_make_45(strides, case):
    """Knee, hip, stride and sway, each within two standard deviations of the real turns."""
    found = turns_held_out.compare(strides, case)
    assert np.abs(found.off(CURVES)).max() <= 2
    off = {way: np.abs(found.off(way)).mean() for way in WAYS}
    assert off[CURVES] < off[STRIKES] < off[ANYWHERE] and off[CURVES] < off[PLAIN]
    assert np.abs(found.off(ANYWHERE)).max() > 4


@pytest.mark.exhaustive
@pytest.mark.parametrize("case", CASES[2:], ids=str)
def test_sharper_turns_have_the_knees_and_hips_of_real_ones(strides, case):
    """And the length, unless the strides on either side are all shorter: no blend is longer than both."""
    found = turns_held_out.compare(strides, case)
    assert np.abs(found.off(CURVES)[[0, 1, 3]]).max() <= 2 and found.off(ANYWHERE)[0] < -2
    assert np.abs(found.off(CURVES)).max() <= 3
    real, straighter, sharper, made = (
        some[:, 2].mean() for some in (found.real, found.straighter, found.sharper, found.made[CURVES])
    )
    if case == CASES[2]:
        assert abs(found.off(CURVES)[2]) <= 2
    else:
        assert sharper < made < straighter < real
