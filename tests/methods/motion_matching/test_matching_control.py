"""A character by motion matching: it obeys sooner than on a graph, and its cuts do not jolt."""

from functools import cache

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.errors import NoWalk
from mocap.graphs import build, compile_graph, prune
from mocap.methods.motion_matching import MotionMatcher, Wants, tabulate
from mocap.quality.seam_measures import foot_sliding, spread
from mocap.steering import Controller, RootTurner, command_headings, judge_control, measure_delay, steer
from tests.bundled import WALKS, clips
from tests.methods.motion_matching.matched import walks
from tests.refusals import refused, told, unwarned

SPEED = 1.0
HEADINGS = command_headings(20, 30, seed=1)


def test_offsets_die_away_so_that_it_plays_the_clips_own_poses():
    """Asked for what the clip does, it does not cut, and moves as the clip."""
    table = tabulate(clips("walk_straight"))
    matcher = MotionMatcher(table, Wants(bonus=1e9), start=40)
    walked = steer(matcher, [0.0] * 60, 1.0).motion
    assert matcher.cuts == []
    np.testing.assert_allclose(walked.rotations[:, 1:], table.motion.rotations[40:100, 1:], atol=1e-12)


def test_a_cut_keeps_place_and_velocity():
    """In a stream with 20 cuts no joint moves further per frame than in the clips, by a fifth at most."""
    matcher = MotionMatcher(walks())
    walked = steer(matcher, HEADINGS, SPEED).motion
    assert len(matcher.cuts) > 20
    fastest = max(np.linalg.norm(np.diff(joint_positions(c), axis=0), axis=-1).max() for c in walks().clips)
    assert np.linalg.norm(np.diff(joint_positions(walked), axis=0), axis=-1).max() < 1.2 * fastest


def test_it_plays_on_unless_another_frame_is_better_by_the_bonus():
    """Without a bonus it cuts wherever a frame costs less; with a large one never."""
    cuts = []
    for bonus in (0.0, 3.0, 1e9):
        matcher = MotionMatcher(walks(), Wants(bonus=bonus, guarded=False))
        for heading in HEADINGS[:200]:
            matcher.step(heading, SPEED)
        cuts.append(len(matcher.cuts))
    assert cuts[0] > 1.2 * cuts[1] > 0 == cuts[2]


def test_it_goes_where_it_is_asked_to_go():
    walked = steer(MotionMatcher(walks()), [1.0] * 300, SPEED).motion
    way = walked.root_positions[-1] - walked.root_positions[90]
    assert np.arctan2(way[0], way[2]) == pytest.approx(1.0, abs=0.15)


def test_a_label_keeps_it_among_its_frames():
    table = tabulate(clips("walk_curve_1", "sneak"))
    assert {"walk", "sneak"} <= set(table.motion.labels)
    matcher = MotionMatcher(table)
    for _ in range(90):
        matcher.step(0.0, 0.7, "sneak")
    assert table.motion.labels["sneak"][matcher.frame]
    refused("No clip has the label 'fly'; there are: walk", matcher.step, 0.0, 0.7, "fly", kind=NoWalk)


def test_at_the_end_of_a_clip_it_must_cut():
    """A start in the last second, which no search finds, plays to the end and goes on elsewhere."""
    table = walks()
    matcher = MotionMatcher(table, Wants(bonus=1e9), start=int(table.last[0]) - 2)
    for _ in range(10):
        matcher.step(0.0, SPEED)
    assert matcher.cuts == [2] and table.usable[matcher.frame]


def test_what_makes_no_sense_is_refused():
    for heading, speed in ((np.nan, 1.0), (0.0, np.inf), (0.0, -1.0)):
        refused("A command is a finite heading", MotionMatcher(walks()).step, heading, speed)


def test_a_speed_that_no_clip_has_is_warned_of_once():
    matcher = MotionMatcher(tabulate(clips("jog")))
    told(r"2\.79 m/s is outside the clips' 1\.1 to 2\.8 m/s: the nearest", matcher.step, 0.0, 2.79)
    unwarned(matcher.step, 0.5, 2.79)


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
    """A quarter of the future's weight, beside the graph of 4 or 8 cm that slides most nearly as much."""
    gentle, alike = matching(future=0.25), graph(0.04)
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
        return np.hypot(*np.diff(track, axis=0).T).sum() / 7  # m/s, also of one who walks in circles

    assert stopped(walks()) > 0.1
    assert stopped(tabulate(clips(*WALKS, "stop_and_go"))) < 0.01


@cache
def straight():
    """Return two straight walks of 8 s, which turn by a few degrees in a second."""
    (walk,) = clips("walk_straight")
    return tabulate([walk[:240], walk[120:360]])


def played(character, seconds=20):
    """Return the frames that a character plays, told to turn every two seconds."""
    frames = []
    for heading in command_headings(seconds, 30, seed=1):
        character.step(heading, 1.2)
        frames.append(character.frame)
    return np.array(frames)


@pytest.mark.filterwarnings("ignore:The clips turn by")
def test_it_never_glides_on_one_pose_though_no_clip_turns():
    """Strides follow one another. A character that returns to one pose slides by 40 cm and more."""
    walked = steer(MotionMatcher(straight()), command_headings(20, 30, seed=1), 1.2).motion
    ground = joint_positions(walked)[:, [walked.skeleton.index("lfoot"), walked.skeleton.index("rfoot")], 1]
    lifts = np.diff((ground > ground.mean(axis=0)).astype(int), axis=0) > 0
    assert lifts.sum(axis=0).min() >= 15  # a step of each foot every 1.1 s
    assert np.mean([plant.distance for plant in foot_sliding(walked)]) < 15
    assert len(set(played(MotionMatcher(straight())).tolist())) > 50


def test_clips_that_hardly_turn_are_told_of_once_unless_the_figure_is_turned():
    matcher = MotionMatcher(straight())
    unwarned(matcher.step, 0.0, 1.2)
    told(r"turn by \d+° in a second at most, and a command asks for 90°", matcher.step, np.pi / 2, 1.2)
    unwarned(matcher.step, -np.pi / 2, 1.2)
    turner = RootTurner(MotionMatcher(straight()))
    for heading in (0.0, np.pi / 2):
        unwarned(turner.step, heading, 1.2)


def test_a_turned_character_needs_no_clip_that_turns():
    delay = measure_delay(RootTurner(MotionMatcher(straight())), speed=1.2, turns=10)
    assert delay.mean < 0.95 and delay.never == 0
