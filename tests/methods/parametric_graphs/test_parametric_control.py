"""A character that decides once per stride obeys nearly as soon as one that searches a motion graph."""

from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

from mocap.body.planar import heading
from mocap.errors import NoWalk
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.methods.parametric_graphs.parametric_edges import build_parametric
from mocap.quality.seam_measures import jumps, spread
from mocap.steering import Controller, command_headings, measure_delay, steer
from tests.bundled import WALKS, bundled, clips
from tests.methods.parametric_graphs.built import SMALL, by_turn_and_speed, stepping, walk_and_jog, walking
from tests.refusals import refusals

SPEED = 0.8


def test_it_obeys_nearly_as_soon_as_the_motion_graph_of_the_same_clips():
    graph = measure_delay(Controller(bundled(*WALKS)), speed=SPEED).mean
    strides = measure_delay(ParametricController(walking()), speed=SPEED)
    steps = measure_delay(ParametricController(stepping(0.04)), speed=SPEED)
    assert strides.mean <= 1.7 * graph and steps.mean <= 1.2 * graph
    assert max(strides.slowest, steps.slowest) < 8


@pytest.mark.sweep
def test_seams_between_kinds_cost_what_their_edges_promise():
    """Each is left when its own edge says so: left when the first of them may, one costs 10 cm."""
    random, character = np.random.default_rng(0), ParametricController(walk_and_jog())
    for _ in range(60):
        label, heading = ("walk", "jog")[random.integers(2)], random.uniform(-3, 3)
        for _ in range(60):
            character.step(heading, 1.0, label)
    assert {chosen.node for chosen in character.chosen} == set(walk_and_jog().graph)
    assert max(chosen.cost for chosen in character.chosen) <= 0.08


def test_no_frame_jolts_more_than_the_clips():
    """As in [HG07, seam]."""
    walked = steer(ParametricController(walking()), command_headings(40, 30, seed=1), SPEED).motion
    limit = np.percentile(spread(clips()).within(1), 99.9)
    assert (jumps(walked) > limit).mean() < 0.02


def test_it_goes_where_it_is_asked_to_go():
    walked = steer(ParametricController(walking()), [1.0] * 300, SPEED).motion
    way = walked.root_positions[-1] - walked.root_positions[150]
    assert np.arctan2(way[0], way[2]) == pytest.approx(1.0, abs=0.1)
    assert abs(heading(walked.rotations[-60:, 0]).mean() - 1.0) < 0.2


def test_the_wish_is_cut_by_the_box_and_both_are_kept():
    """As in [HG07, 5]."""
    character = ParametricController(walking())
    for _ in range(60):
        character.step(3.0, SPEED)
    first = character.chosen[0]
    assert first.wished[0] > first.taken[0] > 0 and first.node == "walk"


def test_frames_left_count_down_to_a_decision():
    character = ParametricController(walking())
    left, decided = [], []
    for _ in range(80):
        left.append(character.frames_left)
        before = len(character.chosen)
        character.step(0.0, SPEED)
        decided.append(len(character.chosen) > before)
    assert all(decided[frame] == (left[frame] == 0) for frame in range(80))
    assert sum(decided) >= 2


def test_it_goes_from_kind_to_kind_by_the_changes_between_and_without_a_label_as_the_speed_says():
    character = ParametricController(walk_and_jog(), start="walk to jog")
    for label, speed, kind in (("walk", 1.0, "walk"), ("jog", 1, "jog"), ("", 0.8, "walk"), ("", 2.5, "jog")):
        for _ in range(200):
            character.step(0.4, speed, label)
        assert character.chosen[-1].node == kind
    seen = [chosen.node for chosen in character.chosen]
    assert all(character.graph.has_edge(*pair) for pair in pairwise(seen))
    assert {"walk to jog", "jog to walk"} <= set(seen)


def walked(label):
    """Walk for two seconds in a graph with a node to which nothing leads."""
    apart = nx.DiGraph(walking())
    apart.add_node("far", space=walking().nodes["walk"]["space"])
    character = ParametricController(apart)
    for _ in range(60):
        character.step(0.0, 1.0, label)


test_commands_that_are_none_and_nodes_that_nothing_leads_to_are_refused = refusals(
    *(
        ("A command is a finite heading", lambda told=told: ParametricController(walking()).step(*told))
        for told in ((np.nan, 1.0), (0.0, np.inf), (0.0, -1.0))
    ),
    ("There is no node 'fly'; there are: walk", lambda: ParametricController(walking(), start="fly")),
    (NoWalk, "There is no node 'fly'", walked, "fly"),
    (NoWalk, "No motions lead from 'walk' to 'far'", walked, "far"),
)


def test_asked_by_turn_and_speed_it_walks_as_fast_as_told_and_knows_what_it_got():
    graph = build_parametric({"walk": by_turn_and_speed()}, good=0.06, sampling=SMALL)
    for speed in (0.7, 0.75, 0.8):
        character = ParametricController(graph)
        track = steer(character, [0.0] * 450, speed).motion.root_positions[150:, [0, 2]] @ [1j, 1]
        assert 30 * np.abs(np.diff(track)).mean() == pytest.approx(speed, abs=0.03)
        taken, got = (np.array([part[place] for part in character.chosen]) for place in (2, 3))
        assert np.abs(got - taken).max() < 0.05
