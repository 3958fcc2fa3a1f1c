"""Reaches and punches are nodes beside walks: places of the world are met, and planted feet rest."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from mocap.editing import plants_kept
from mocap.feet import clean_up
from mocap.methods.match_webs import weights_for
from mocap.methods.match_webs.motion_spaces import random_weights
from mocap.methods.parametric_graphs import build_edge, cut_actions
from mocap.methods.parametric_graphs.parametric_control import ParametricController
from mocap.quality import plant_slides
from tests.bundled import clips
from tests.methods.parametric_graphs.built import HAND, SMALL, act, acting, of_hands
from tests.refusals import refusals


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_a_place_of_the_world_is_met_and_planted_feet_rest_in_the_changes_too(node):
    """As in [HG07, 5], with a place of the world for the wish."""
    done = act(acting(), node, 12)
    off = done.missed(done.motion)
    assert np.median(off) <= 0.015 and np.percentile(off, 90) <= 0.05
    ways = {"reach": {"walk", "reach"}, "punch": {"walk", "to_guard", "punch", "from_guard"}}
    assert {chosen.node for chosen in done.chosen} == ways[node]
    clean = clean_up(done.motion)
    assert plants_kept(clean, done.motion) >= 0.97 and max(plant.far for plant in plant_slides(clean)) < 1e-3
    after = done.missed(clean)
    assert np.median(after) <= 0.015 and np.percentile(after, 90) <= 0.05


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_a_clip_that_is_left_out_is_made_nearer_than_the_nearest_clip_and_the_mean(node):
    """As in [HG07, nodes]: of the others, in the median; the mean is that of the d + 1 nearest."""
    space, off = of_hands()[node], []
    examples, known = space.examples, space.values[: len(space.examples)]
    for out in range(len(examples)):
        rest = np.abs(space.weights[:, out]) < 1e-9
        others = replace(space, weights=space.weights[rest], values=space.values[rest])
        near = np.argsort(np.linalg.norm(known - known[out], axis=1))[1:5]
        mixes = [weights_for(others, known[out]), np.eye(len(known))[near[0]]]
        mixes.append(np.eye(len(known))[near].mean(axis=0))
        off.append([np.linalg.norm(HAND(examples.blend(mix)) - known[out]) for mix in mixes])
    made, nearest, mean = np.median(off, axis=0)
    assert made < 0.6 * nearest and made < 0.6 * mean


@pytest.mark.parametrize("node", ["reach", "punch"])
def test_what_blends_do_is_got_when_it_is_asked(node):
    space = of_hands()[node]
    rows = random_weights(space.values[: len(space.examples)], 40, spread=0, seed=3)
    wishes = np.array([HAND(space.examples.blend(row)) for row in rows])
    got = [HAND(space.examples.blend(row)) for row in weights_for(space, wishes)]
    assert np.median(np.linalg.norm(got - wishes, axis=1)) < 0.006


def test_walks_do_not_turn_into_punches_by_themselves():
    spaces = {name: acting().nodes[name]["space"] for name in ("walk", "punch", "to_guard")}
    direct, guarded = (
        build_edge(spaces["walk"], spaces[other], good=np.inf, sampling=SMALL).least
        for other in ("punch", "to_guard")
    )
    assert direct > 0.14 > 0.05 > guarded


def test_without_a_label_one_who_punched_walks_on():
    character = ParametricController(acting(), start="punch")
    for _ in range(200):
        character.step(0.5, 0.8)
    seen = [chosen.node for chosen in character.chosen]
    assert seen[:2] == ["from_guard", "walk"] and set(seen[1:]) == {"walk"}
    assert np.isnan(character.chosen[0].wished).all()  # nobody aimed: the middle of the box


def test_actions_are_registered_and_their_margins_run_at_their_own_pace():
    """As in [HG07, examples]."""
    walk = clips()[3]
    strikes = 1 + np.flatnonzero(np.diff(walk.contacts["lfoot"].astype(int)) == 1)[1:5]
    cut = cut_actions([walk] * 3, list(pairwise(strikes)))
    zero, one = cut.ends
    assert len(cut) == 3 and np.abs(cut.seconds[:, zero]).max() == 0
    np.testing.assert_allclose(cut.seconds[:, one], np.diff(strikes) / 30, atol=0.03)
    pace = np.diff(cut.seconds, axis=1)
    assert np.ptp(pace[:, : zero - 1]) < 1e-9 and (pace > 0).all()


WALK = clips()[3]

test_what_makes_no_sense_is_refused = refusals(
    ("one clip or more, got none", cut_actions, [], []),
    ("one span for each clip, got 1 and 0", cut_actions, [WALK], []),
    ("takes those from -13 to 55: leave it more room", cut_actions, [WALK], [(2, 40)]),
    ("leave it more room", cut_actions, [WALK], [(60, 40)]),
    ("A place of the world is three", lambda: ParametricController(acting()).aim([1, 2])),
    ("three finite numbers", lambda: ParametricController(acting()).aim([1, 2, np.nan])),
)
