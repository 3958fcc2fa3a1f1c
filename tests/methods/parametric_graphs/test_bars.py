"""What a parametric graph of the strides of the bundled walks is held to."""

import numpy as np
import pytest

from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.methods.parametric_graphs.parametric_edges import BAD, build_edge
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters
from mocap.quality import plant_slides
from mocap.steering import Controller, command_headings, steer
from tests.bundled import WALKS, bundled
from tests.methods.parametric_graphs.built import bad_ones, space, stepping, walk_anywhere, walking

SPEED = 0.8


GOOD = 0.03  # T_GOOD, metres


def test_boxes_hold_next_to_no_bad_target_among_fresh_ones_and_among_those_drawn_inside():
    """As in [HG07, 4]. A box of no width holds none of the fresh targets: so draw inside each one, too."""
    source, edge = space(), walking().edges["walk", "walk"]["edge"]
    boxes, share = bad_ones(source, source, edge, BAD * GOOD, seed=0)
    assert boxes <= 0.1 and share <= 0.01
    at = draw_parameters(source, 100, np.random.default_rng(0))
    within = [optimal_transitions(source, source, a[None], _inside(edge.look_up(a)))[0] for a in at]
    assert (np.array(within) > BAD * GOOD).mean() <= 0.02


def _inside(way, count=20):
    return np.linspace(np.minimum(way.low, way.high), np.maximum(way.low, way.high), count)


def test_seams_of_300_random_targets_cost_what_the_edges_promise():
    """And at the looked-up phases nearly as little as at the best ones."""
    character = ParametricController(walking())
    pairs = walk_anywhere(character, 300)
    cost = np.array([chosen.cost for chosen in character.chosen])
    bad = BAD * GOOD
    assert cost.max() <= bad + 0.01 and (cost > bad).mean() <= 0.02
    spaces = walking().nodes
    best = [
        optimal_transitions(
            spaces[node]["space"], spaces[chosen.node]["space"], at[None], chosen.taken[None]
        )[0]
        for (node, at), chosen in zip(pairs[:60], character.chosen, strict=False)
    ]
    assert cost[:60].mean() <= 1.15 * np.mean(best)


def test_what_was_got_is_said_and_one_turn_over_and_over_is_no_circle():
    """Seams are aligned by the whole body, and turn it: up to some degrees a stride."""
    character = ParametricController(walking())
    tested = walking().nodes[character.node]["space"]
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
    plain = slide(Controller(bundled(*WALKS)))
    for graph in (walking(), stepping(0.04)):
        assert slide(ParametricController(graph)) <= 1.3 * plain


def test_bad_thresholds_twice_the_good_ones_cut_no_box():
    """Between T_GOOD and 1.35 T_GOOD a target may be in a box; with 2 T_GOOD none is ever cut off."""
    source = space()
    thresholds, few = (0.03, BAD * 0.03, 0.06, 1.0), (50, 300)
    edges = [build_edge(source, source, good=0.03, bad=bad, sampling=few) for bad in thresholds]
    widths = [(edge.high - edge.low).mean() for edge in edges]
    assert widths[0] < widths[1] <= widths[2] == pytest.approx(widths[3], rel=0.01)
