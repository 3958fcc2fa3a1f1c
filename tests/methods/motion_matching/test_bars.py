"""What motion matching is worth beside the motion graph of the same clips, by one protocol."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from mocap.feet.footplants import mark_plants
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.methods.motion_matching.matching_control import MotionMatcher
from mocap.methods.motion_matching.nearest_frames import Wants
from mocap.methods.motion_matching.pose_database import WEIGHTS, tabulate
from mocap.quality.seam_measures import jumps, spread
from mocap.quality.standing_feet import plant_slides
from mocap.steering import Controller, command_headings, judge_control, measure_delay, steer
from tests.methods.motion_matching.matched import WALKS, clips, walks
from tests.methods.motion_matching.people import HOMEWORK, WALKER, captured

SPEEDS = {"bundled": 0.8, HOMEWORK: 0.8, WALKER: 1.1}  # m/s, what most of their clips walk
# Metres: of 2.5 to 8 cm the threshold whose graph slides most nearly as matching does with a future of 0.25.
ALIKE = {"bundled": 0.08, HOMEWORK: 0.05, WALKER: 0.08}


class Judged:
    """The clips of one set, and the reports of characters that move by them."""

    def __init__(self, name, some):
        self.clips = [clip if clip.contacts else mark_plants(clip) for clip in some]
        self.speed, self.alike, self.runs = SPEEDS[name], ALIKE[name], 1 if name == "bundled" else 4
        self.usual, self.table = spread(self.clips), tabulate(self.clips)

    @cache  # noqa: B019 (the sets live as long as the tests)
    def matching(self, future=1.0, fade=0.1, seed=0):
        wants = Wants(future=future, fade=fade)
        return judge_control(
            lambda: MotionMatcher(self.table, wants), self.usual, speed=self.speed, seed=seed
        )

    @cache  # noqa: B019
    def graph(self, threshold=0.04):
        compiled = compile_graph(prune(build(self.clips, window=10, threshold=threshold)))
        return judge_control(lambda: Controller(compiled), self.usual, speed=self.speed)


@pytest.fixture(
    scope="module",
    params=["bundled", *(pytest.param(name, marks=pytest.mark.exhaustive) for name in (HOMEWORK, WALKER))],
)
def judged(request):
    if request.param == "bundled":
        return Judged("bundled", clips(*WALKS))
    return Judged(request.param, captured(request.getfixturevalue("real_data"), request.param))


def test_it_obeys_in_three_quarters_of_the_graph_s_time_and_always(judged):
    assert judged.matching().delay.mean <= 0.75 * judged.graph().delay.mean
    assert judged.matching().delay.never == 0


@pytest.mark.sweep
def test_at_the_slide_of_a_graph_it_still_obeys_sooner(judged):
    """A quarter of the future's weight, beside the denser graph that slides as much."""
    gentle, alike = judged.matching(future=0.25), judged.graph(judged.alike)
    assert gentle.slide == pytest.approx(alike.slide, abs=0.3)
    assert gentle.delay.mean <= 0.95 * alike.delay.mean


def test_its_feet_slide_further_than_the_graph_s_and_can_be_cleaned(judged):
    assert judged.graph().slide < judged.matching().slide <= 3 * judged.graph().slide
    assert judged.matching().cleaned < 0.01
    assert judged.matching().kept >= 0.95


@pytest.mark.parametrize(("future", "least"), [(1.0, 0.94), (0.5, 0.97)])
def test_to_clean_its_feet_keeps_nearly_all_plants(judged, future, least):
    """On average over four runs: single ones of CMU 16's walks keep from 93 to 96 % of them."""
    runs = [judged.matching(future, seed=seed) for seed in range(judged.runs)]
    assert np.mean([run.kept for run in runs]) >= least


def test_its_cuts_do_not_jolt_and_hard_ones_would(judged):
    assert judged.matching().jolting <= 0.015
    assert judged.matching(fade=0.001).jolting > 0.05


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
