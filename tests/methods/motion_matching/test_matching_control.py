"""A character by motion matching: it obeys sooner than a graph, and its cuts do not jolt."""

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.errors import NoWalk
from mocap.methods.motion_matching.matching_control import MotionMatcher
from mocap.methods.motion_matching.nearest_frames import Wants
from mocap.methods.motion_matching.pose_database import tabulate
from mocap.steering import command_headings, steer
from tests.bundled import clips
from tests.methods.motion_matching.matched import walks
from tests.refusals import refused, told, unwarned

SPEED = 0.8
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
        matcher = MotionMatcher(walks(), Wants(bonus=bonus))
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
    assert len(matcher.cuts) == 1 and table.usable[matcher.frame]


def test_what_makes_no_sense_is_refused():
    for heading, speed in ((np.nan, 1.0), (0.0, np.inf), (0.0, -1.0)):
        refused("A command is a finite heading", MotionMatcher(walks()).step, heading, speed)


def test_a_speed_that_no_clip_has_is_warned_of_once():
    matcher = MotionMatcher(walks())
    told(r"3 m/s is outside the clips' 0.\d to \d.\d m/s: the nearest", matcher.step, 0.0, 3.0)
    unwarned(matcher.step, 0.5, 3.0)
