"""One loop for all characters: the graph, the graph turned about its feet, strides, and matching."""

from functools import cache

import numpy as np
import pytest

from mocap.body.motion import Motion
from mocap.body.rotations import about_y
from mocap.datasets.samples import SKELETON
from mocap.graphs.compiled_graph import compile_graph
from mocap.methods.motion_matching import MotionMatcher, Wants
from mocap.methods.parametric_graphs import ParametricController
from mocap.quality.seam_measures import spread
from mocap.steering import Controller, FootTurner, command_headings, judge_control
from mocap.steering.judged_control import _pivots
from tests.bundled import WALKS, bundled, clips
from tests.methods.motion_matching.matched import walks
from tests.methods.parametric_graphs.built import walking
from tests.refusals import refused
from tests.widgets.steerable import Dot

SPEED = 1.0


@cache
def graph():
    return compile_graph(bundled(*WALKS))


CHARACTERS = {
    "motion graph": lambda: Controller(graph()),
    "motion graph, turned": lambda: FootTurner(Controller(graph()), np.radians(40)),
    "strides": lambda: ParametricController(walking()),
    "matching": lambda: MotionMatcher(walks(), Wants(future=0.5)),
}


@cache
def report(name):
    return judge_control(CHARACTERS[name], spread(clips()), speed=SPEED, seconds=40)


@pytest.mark.parametrize("name", CHARACTERS)
def test_all_obey_and_all_feet_can_be_cleaned(name):
    judged = report(name)
    assert judged.delay.mean < 3 and judged.delay.slowest < 8
    assert judged.cleaned < 0.01 < judged.slide < 4
    assert judged.kept >= 0.9 and judged.jolting <= 0.02
    assert judged.pace == pytest.approx(SPEED, abs=0.1)


def test_what_a_turn_about_the_foot_costs_is_that_feet_turn_on_the_ground():
    """In the clips feet that stand do not turn, in blends of strides hardly; about a pivot by 7°."""
    pivots = {name: report(name).pivots for name in ("motion graph", "motion graph, turned", "strides")}
    assert pivots["strides"] < pivots["motion graph"] < 2 < 5 < pivots["motion graph, turned"]


def test_pivots_are_the_degrees_between_a_plant_s_ends():
    """A figure that turns by one degree per frame, its foot lifted in every eleventh."""
    turns = np.tile([1.0, 0, 0, 0], (66, 38, 1))
    turns[:, 0] = about_y(np.radians(np.arange(66)))
    stands = dict.fromkeys(("lfoot", "rfoot"), np.arange(66) % 11 > 0)
    assert _pivots(Motion(SKELETON, np.zeros((66, 3)), turns, 30.0, contacts=stands)) == pytest.approx(9)


def test_commands_turn_by_30_to_120_degrees_every_two_seconds():
    headings = command_headings(20, 30, seed=3)
    turns = np.abs(np.diff(headings[::60]))
    assert len(headings) == 600 and turns.min() >= np.pi / 6 and turns.max() <= 2 * np.pi / 3
    assert not np.diff(headings.reshape(-1, 60), axis=1).any()


class Flier(Dot):
    """Its feet are marked, and never stand."""

    def step(self, *command):
        return super().step(*command)._replace(contacts={"lfoot": False, "rfoot": False})


def test_a_character_that_never_stands_is_refused():
    refused("do not say when feet stand", judge_control, Flier, spread(clips()), seconds=5)
