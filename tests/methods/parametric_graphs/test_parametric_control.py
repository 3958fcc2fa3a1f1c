"""A character obeys nearly as soon as on a motion graph, reaches and punches; planted feet rest."""

from dataclasses import replace
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

from mocap.body.planar import heading
from mocap.editing import plants_kept
from mocap.errors import NoWalk
from mocap.feet import clean_up
from mocap.methods.match_webs import weights_for
from mocap.methods.match_webs.motion_spaces import random_weights
from mocap.methods.parametric_graphs import ParametricController, build_edge, cut_actions, optimal_transitions
from mocap.methods.parametric_graphs.parametric_edges import build_parametric
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters
from mocap.methods.parametric_graphs.tuned import TUNED
from mocap.quality import foot_sliding, jumps, spread
from mocap.steering import Controller, command_headings, measure_delay, steer
from tests.bundled import WALKS, bundled, clips
from tests.methods.parametric_graphs import built
from tests.refusals import refusals

SPEED = 1.0


def test_it_obeys_nearly_as_soon_as_the_motion_graph_of_the_same_clips():
    graph = measure_delay(Controller(bundled(*WALKS)), speed=SPEED).mean
    strides = measure_delay(ParametricController(built.walking()), speed=SPEED)
    steps = measure_delay(ParametricController(built.stepping(0.04)), speed=SPEED)
    assert strides.mean <= 1.7 * graph and steps.mean <= 1.2 * graph
    assert max(strides.slowest, steps.slowest) < 8


@pytest.mark.sweep
def test_seams_between_kinds_cost_what_their_edges_promise():
    """Each is left when its own edge says so: left when the first of them may, one costs 10 cm."""
    random, character = np.random.default_rng(0), ParametricController(built.walk_and_jog())
    for _ in range(60):
        label, heading = ("walk", "jog")[random.integers(2)], random.uniform(-3, 3)
        for _ in range(60):
            character.step(heading, 1.0, label)
    assert {chosen.node for chosen in character.chosen} == set(built.walk_and_jog())
    assert max(chosen.cost for chosen in character.chosen) <= 0.08


def test_no_frame_jolts_more_than_the_clips():
    """As in [HG07, seam]."""
    walked = steer(ParametricController(built.walking()), command_headings(40, 30, seed=1), SPEED).motion
    limit = np.percentile(spread(clips()).within(1), 99.9)
    assert (jumps(walked) > limit).mean() < 0.02


def test_it_goes_where_it_is_asked_to_go():
    walked = steer(ParametricController(built.walking()), [1.0] * 300, SPEED).motion
    way = walked.root_positions[-1] - walked.root_positions[150]
    assert np.arctan2(way[0], way[2]) == pytest.approx(1.0, abs=0.1)
    assert abs(heading(walked.rotations[-60:, 0]).mean() - 1.0) < 0.2


def test_the_wish_is_cut_by_the_box_and_both_are_kept():
    """As in [HG07, 5]."""
    character = ParametricController(built.walking())
    box = character.boxes["walk"]
    for _ in range(60):
        character.step(3.0, SPEED)
    first = character.chosen[0]
    assert first.requested[0] > first.allowed[0] == pytest.approx(box.high[0]) and first.node == "walk"


def test_frames_left_count_down_to_a_decision():
    character = ParametricController(built.walking())
    left, decided = [], []
    for _ in range(80):
        left.append(character.frames_left)
        before = len(character.chosen)
        character.step(0.0, SPEED)
        decided.append(len(character.chosen) > before)
    assert all(decided[frame] == (left[frame] == 0) for frame in range(80))
    assert sum(decided) >= 2


def test_it_goes_from_kind_to_kind_by_the_changes_between_and_without_a_label_as_the_speed_says():
    character = ParametricController(built.walk_and_jog(), start="walk to jog")
    for label, speed, kind in (("walk", 1.0, "walk"), ("jog", 1, "jog"), ("", 0.8, "walk"), ("", 2.5, "jog")):
        for _ in range(200):
            character.step(0.4, speed, label)
        assert character.chosen[-1].node == kind
    seen = [chosen.node for chosen in character.chosen]
    assert all(character.graph.has_edge(*pair) for pair in pairwise(seen))
    assert {"walk to jog", "jog to walk"} <= set(seen)


def walked(label):
    """Walk for two seconds in a graph with a node to which nothing leads."""
    apart = nx.DiGraph(built.walking())
    apart.add_node("far", space=built.walking().nodes["walk"]["space"])
    character = ParametricController(apart)
    for _ in range(60):
        character.step(0.0, 1.0, label)


test_commands_that_are_none_and_nodes_that_nothing_leads_to_are_refused = refusals(
    *(
        ("A command is a finite heading", lambda told=told: ParametricController(built.walking()).step(*told))
        for told in ((np.nan, 1.0), (0.0, np.inf), (0.0, -1.0))
    ),
    ("There is no node 'fly'; there are: walk", lambda: ParametricController(built.walking(), start="fly")),
    (NoWalk, "There is no node 'fly'", walked, "fly"),
    (NoWalk, "No motions lead from 'walk' to 'far'", walked, "far"),
)


def test_asked_by_turn_and_speed_it_walks_as_fast_as_told_and_knows_what_it_got():
    graph = build_parametric({"walk": built.by_turn_and_speed()}, good=0.06, sampling=built.SMALL)
    for speed in (1.0, 1.1, 1.2):
        character = ParametricController(graph)
        track = steer(character, [0.0] * 450, speed).motion.root_positions[150:, [0, 2]] @ [1j, 1]
        assert 30 * np.abs(np.diff(track)).mean() == pytest.approx(speed, abs=0.03)
        taken, got = (np.array([part[place] for part in character.chosen]) for place in (2, 3))
        assert np.abs(got - taken).max() < 0.05


GOOD = 0.03  # T_GOOD, metres


def test_boxes_hold_next_to_no_bad_target_among_fresh_ones_and_among_those_drawn_inside():
    """As in [HG07, 4]. A box of no width holds none of the fresh targets: so draw inside each one, too."""
    source, edge = built.space(), built.walking().edges["walk", "walk"]["edge"]
    boxes, share = built.bad_ones(source, source, edge, TUNED.bad * GOOD, seed=0)
    assert boxes <= 0.1 and share <= 0.01
    at = draw_parameters(source, 100, np.random.default_rng(0))
    within = [optimal_transitions(source, source, a[None], _inside(edge.look_up(a)))[0] for a in at]
    assert (np.array(within) > TUNED.bad * GOOD).mean() <= 0.02


def _inside(way, count=20):
    return np.linspace(np.minimum(way.low, way.high), np.maximum(way.low, way.high), count)


def test_seams_of_300_random_targets_cost_what_the_edges_promise():
    """And at the looked-up phases nearly as little as at the best ones [HG07, seam]."""
    character = ParametricController(built.walking())
    pairs = built.walk_anywhere(character, 300)
    cost = np.array([chosen.cost for chosen in character.chosen])
    bad = TUNED.bad * GOOD
    assert cost.max() <= bad + 0.01 and (cost > bad).mean() <= 0.02
    spaces = dict(built.walking().nodes(data="space"))
    seams = zip(pairs[:60], character.chosen, strict=False)
    seams = [(spaces[node], spaces[to.node], at[None], to.allowed[None]) for (node, at), to in seams]
    best = [optimal_transitions(*seam)[0] for seam in seams]
    assert cost[:60].mean() <= 1.15 * np.mean(best)


def test_what_was_got_is_said_and_one_turn_over_and_over_is_no_circle():
    """Seams are aligned by the whole body, and turn it: up to some degrees a stride."""
    character = ParametricController(built.walking())
    character._requested = lambda *_: np.full(1, np.radians(20))
    facing = []
    while len(character.chosen) < 12:
        before = len(character.chosen)
        character.step(0.0, SPEED)
        if len(character.chosen) > before:
            facing.append(character.transform.angle)
    got = np.degrees([chosen.reached[0] for chosen in character.chosen[3:]])
    assert np.abs(got - np.degrees(character.chosen[-1].allowed[0])).max() <= 1
    assert built.space().parameters == ("turn",)
    turned = np.degrees(np.diff(np.unwrap(facing)))[3:]
    assert np.abs(turned[-8:].mean() - 20) < 8


def slide(character):
    """How far planted joints stray from their mean place in 30 s of turns; plants as the clips say."""
    headings = command_headings(30, character.fps).tolist()
    return np.mean(built.slides(steer(character, headings, SPEED).motion))


def test_feet_slide_no_more_than_those_of_a_motion_graph_of_the_same_clips():
    plain = slide(Controller(bundled(*WALKS)))
    for graph in (built.walking(), built.stepping(0.04)):
        assert slide(ParametricController(graph)) <= 1.3 * plain


def test_bad_thresholds_twice_the_good_ones_cut_no_box():
    """Between T_GOOD and 1.35 T_GOOD one may be in a box; with 2 T_GOOD none is cut off [HG07, 3.2].

    Means of few strides each: of more, costs rise so evenly on both sides that no box has a bad target.
    """
    source = built.space(degrees=4)
    thresholds, few = (0.025, None, 0.05, 1.0), (50, 300)
    edges = [build_edge(source, source, good=0.025, bad=bad, sampling=few) for bad in thresholds]
    widths = [(edge.high - edge.low).mean() for edge in edges]
    assert widths[0] < widths[1] < widths[2] == widths[3]


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_a_place_of_the_world_is_met_and_planted_feet_rest_in_the_changes_too(node):
    """As in [HG07, 5], with a place of the world for the wish."""
    done = built.act(built.acting(), node, 12)
    off = done.missed(done.motion)
    assert np.median(off) <= 0.02 and np.percentile(off, 90) <= 0.05
    ways = {"reach": {"walk", "reach"}, "punch": {"walk", "to_guard", "punch", "from_guard"}}
    assert {chosen.node for chosen in done.chosen} == ways[node]
    slides = built.slides(done.motion)
    assert np.percentile(slides, 95) <= 2.5 and max(slides) <= 5  # cm, as in walks
    clean = clean_up(done.motion)
    slides = [plant.distance for plant in foot_sliding(clean)]
    assert plants_kept(clean, done.motion) >= 0.97 and max(slides) < 1e-3
    after = done.missed(clean)
    assert np.median(after) <= 0.02 and np.percentile(after, 90) <= 0.05


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_a_clip_that_is_left_out_is_made_nearer_than_the_nearest_clip_and_the_mean(node):
    """As in [HG07, nodes]: of the others, in the median; the mean is that of the d + 1 nearest."""
    space, off = built.of_hands()[node], []
    examples, known = space.examples, space.values[: len(space.examples)]
    for out in range(len(examples)):
        rest = np.abs(space.weights[:, out]) < 1e-9
        others = replace(space, weights=space.weights[rest], values=space.values[rest])
        near = np.argsort(np.linalg.norm(known - known[out], axis=1))[1:5]
        mixes = [weights_for(others, known[out]), np.eye(len(known))[near[0]]]
        mixes.append(np.eye(len(known))[near].mean(axis=0))
        off.append([np.linalg.norm(built.HAND(examples.blend(mix)) - known[out]) for mix in mixes])
    made, nearest, mean = np.median(off, axis=0)
    assert made < 0.6 * nearest and made < 0.6 * mean


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_what_blends_do_is_got_when_it_is_asked(node):
    space = built.of_hands()[node]
    rows = random_weights(space.values[: len(space.examples)], 40, spread=0, seed=3)
    wishes = np.array([built.HAND(space.examples.blend(row)) for row in rows])
    got = [built.HAND(space.examples.blend(row)) for row in weights_for(space, wishes)]
    assert np.median(np.linalg.norm(got - wishes, axis=1)) < 0.006


def test_walks_do_not_turn_into_punches_by_themselves():
    spaces = {name: built.acting().nodes[name]["space"] for name in ("walk", "punch", "to_guard")}
    direct, guarded = (
        build_edge(spaces["walk"], spaces[other], good=np.inf, sampling=built.SMALL).smallest_good
        for other in ("punch", "to_guard")
    )
    assert direct > 0.14 > 0.05 > guarded


def test_without_a_label_one_who_punched_walks_on():
    character = ParametricController(built.acting(), start="punch")
    for _ in range(200):
        character.step(0.5, 0.8)
    seen = [chosen.node for chosen in character.chosen]
    assert seen[:2] == ["from_guard", "walk"] and set(seen[1:]) == {"walk"}
    assert np.isnan(character.chosen[0].requested).all()  # nobody aimed: the middle of the box


def test_actions_are_registered_and_their_margins_run_at_their_own_pace():
    """As in [HG07, examples]."""
    walk = clips()[3]
    strikes = 1 + np.flatnonzero(np.diff(walk.contacts["lfoot"].astype(int)) == 1)[1:5]
    cut = cut_actions([walk] * 3, list(pairwise(strikes)))
    zero, one = cut.ends
    assert len(cut) == 3 and np.abs(cut.seconds[:, zero]).max() == 0
    np.testing.assert_allclose(cut.seconds[:, one], np.diff(strikes) / 30, atol=0.04)
    pace = np.diff(cut.seconds, axis=1)
    assert np.ptp(pace[:, : zero - 1]) < 1e-9 and (pace > 0).all()


WALK = clips()[3]

test_what_makes_no_sense_is_refused = refusals(
    ("one clip or more, got none", cut_actions, [], []),
    ("one span for each clip, got 1 and 0", cut_actions, [WALK], []),
    ("takes those from -1 to 105: leave it more room", cut_actions, [WALK], [(22, 82)]),
    ("leave it more room", cut_actions, [WALK], [(60, 40)]),
    ("takes those from 195 to 301: leave it more room", cut_actions, [WALK], [(218, 278)]),
    ("A position is three", lambda: ParametricController(built.acting()).aim([1, 2])),
    ("three finite numbers", lambda: ParametricController(built.acting()).aim([1, 2, np.nan])),
)
