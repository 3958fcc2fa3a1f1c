"""What motion matching is worth beside the motion graph of the same clips, by one protocol."""

from functools import cache

import numpy as np
import pytest

from mocap.graphs import build, compile_graph, prune
from mocap.methods.motion_matching.matching_control import MotionMatcher
from mocap.methods.motion_matching.nearest_frames import Wants
from mocap.methods.motion_matching.pose_database import tabulate
from mocap.quality.seam_measures import spread
from mocap.steering import Controller, judge_control, measure_delay, steer
from tests.bundled import WALKS, clips
from tests.methods.motion_matching.matched import walks

SPEED = 0.8  # m/s, of the generated clips


@cache
def usual():
    return spread(clips())


@cache
def matching(future=1.0, fade=0.1):
    wants = Wants(future=future, fade=fade)
    return judge_control(lambda: MotionMatcher(walks(), wants), usual(), speed=SPEED)


@cache
def graph(threshold=0.04):
    compiled = compile_graph(prune(build(clips(), window=10, threshold=threshold)))
    return judge_control(lambda: Controller(compiled), usual(), speed=SPEED)


def test_it_obeys_in_three_quarters_of_the_graph_s_time_and_always():
    assert matching().delay.mean <= 0.75 * graph().delay.mean
    assert matching().delay.never == 0


@pytest.mark.sweep
def test_at_the_slide_of_a_graph_it_still_obeys_sooner():
    """A quarter of the future's weight, beside the graph of 2.5 to 8 cm that slides most nearly as much."""
    gentle, alike = matching(future=0.25), graph(0.08)
    assert gentle.slide == pytest.approx(alike.slide, abs=0.3)
    assert gentle.delay.mean <= 0.95 * alike.delay.mean


def test_its_feet_slide_further_than_the_graph_s_and_can_be_cleaned():
    assert graph().slide < matching().slide <= 3 * graph().slide
    assert matching().cleaned < 0.01
    assert matching().kept >= 0.95 and matching(0.5).kept >= 0.97


def test_its_cuts_do_not_jolt_and_hard_ones_would():
    assert matching().jolting <= 0.015
    assert matching(fade=0.001).jolting > 0.05


def delay(**wants):
    return measure_delay(MotionMatcher(walks(), Wants(**wants)), speed=SPEED, turns=60)


def test_to_search_in_every_frame_gains_nothing_and_a_new_command_searches_at_once():
    usual = delay().mean
    assert delay(every=1 / 30).mean == pytest.approx(usual, abs=0.15)
    assert delay(every=20 / 30).mean == pytest.approx(usual, abs=0.15)


@pytest.mark.filterwarnings("ignore:0 m/s is outside")
def test_it_stands_where_a_clip_stands_and_shuffles_where_none_does():
    def stopped(table):
        character = MotionMatcher(table)
        steer(character, [0.0] * 90, SPEED)
        track = steer(character, [0.0] * 300, 0.0).motion.root_positions[90:, [0, 2]]
        return np.hypot(*(track[-1] - track[0])) / 7

    assert stopped(walks()) > 0.1
    assert stopped(tabulate(clips(*WALKS, "stop_and_go"))) < 0.01
