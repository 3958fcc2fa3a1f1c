"""The naive ways, each shown to fail by numbers: on generated clips."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from mocap.methods.motion_matching.matching_control import MotionMatcher
from mocap.methods.motion_matching.nearest_frames import Wants
from mocap.methods.motion_matching.pose_database import WEIGHTS, tabulate
from mocap.quality.seam_measures import jumps, spread
from mocap.quality.standing_feet import plant_slides
from mocap.steering import command_headings, measure_delay, steer
from tests.methods.motion_matching.matched import WALKS, clips, walks

SPEED = 0.8  # of the generated clips


class Walked:
    """A minute of commands: what a character makes of them."""

    def __init__(self, character, speed):
        frames = command_headings(60, character.fps)
        self.motion = steer(character, frames.tolist(), speed).motion
        self.cuts = len(character.cuts) / 60
        self.slide = np.mean([slide.far for slide in plant_slides(self.motion)])
        steps = np.abs(np.diff(self.motion.root_positions[:, [0, 2]] @ [1j, 1]))
        self.speed = steps.mean() * self.motion.fps

    def jolting(self, some):
        limit = np.percentile(spread(some).within(1), 99.9)
        return 100 * float((jumps(self.motion)[0] > limit).mean())


@cache
def walked(**wants):
    return Walked(MotionMatcher(walks(), Wants(**wants)), SPEED)


@cache
def without(*groups):
    return tabulate(walks().clips, weights={**WEIGHTS, **dict.fromkeys(groups, 0.0)})


def delay(table, speed=SPEED, turns=60, **wants):
    return measure_delay(MotionMatcher(table, Wants(**wants)), speed=speed, turns=turns)


def ahead(character, speed, seconds):
    """Walk straight ahead, and give the speed over all but the first three seconds."""
    track = steer(character, [0.0] * round(seconds * 30), speed).motion.root_positions[90:, [0, 2]]
    return float(np.hypot(*(track[-1] - track[0])) / (seconds - 3))


def test_to_search_in_every_frame_gains_nothing_and_a_new_command_searches_at_once():
    usual = delay(walks()).mean
    assert delay(walks(), every=1 / 30).mean == pytest.approx(usual, abs=0.15)
    assert delay(walks(), every=20 / 30).mean == pytest.approx(usual, abs=0.15)


def test_a_short_fade_jolts_and_a_cut_without_the_offset_s_velocity_jolts_further():
    assert walked(fade=0.02).jolting(walks().clips) > 5 * walked().jolting(walks().clips)
    worst = jumps(walked().motion)[0].max()
    table = replace(walks(), speeds=0 * walks().speeds)
    bare = Walked(MotionMatcher(table), SPEED)
    assert jumps(bare.motion)[0].max() > 1.3 * worst
    assert bare.jolting(walks().clips) > 1.2 * walked().jolting(walks().clips)


def test_without_the_feet_they_slide_and_without_their_velocities_it_jolts():
    assert Walked(MotionMatcher(without("feet")), SPEED).slide > 1.15 * walked().slide
    jolting = Walked(MotionMatcher(without("foot velocities")), SPEED).jolting(walks().clips)
    assert jolting > 1.5 * walked().jolting(walks().clips)


def test_without_directions_and_places_ahead_it_is_deaf():
    assert delay(without("places ahead", "directions ahead"), turns=10).mean > 2 * delay(walks()).mean


@pytest.mark.filterwarnings("ignore:0 m/s is outside")
def test_it_stands_where_a_clip_stands_and_shuffles_where_none_does():
    def stopped(table):
        character = MotionMatcher(table)
        steer(character, [0.0] * 90, SPEED)
        return ahead(character, 0.0, 10)

    assert stopped(walks()) > 0.1
    assert stopped(tabulate(clips(*WALKS, "stop_and_go"))) < 0.01
