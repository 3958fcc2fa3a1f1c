"""Characters turn about their roots, as soon as people do, and their standing feet stay."""

from functools import cache

import numpy as np
import pytest

from mocap import graphs
from mocap._shared.arrays import runs
from mocap.body import joint_positions, on_ground
from mocap.methods.motion_matching import MotionMatcher
from mocap.methods.parametric_graphs import ParametricController
from mocap.quality import foot_sliding, jumps, spread
from mocap.steering import Controller, FootTurner, RootTurner, command_headings, measure_delay, steer
from mocap.steering.tuned import TUNED
from tests.bundled import WALKS, bundled, clips
from tests.methods.motion_matching.matched import walks
from tests.methods.parametric_graphs.built import stepping
from tests.refusals import refusals, told, unwarned

GRAPH = graphs.compile_graph(bundled(*WALKS))
CHARACTERS = {
    "graph": lambda: Controller(GRAPH),
    "steps": lambda: ParametricController(stepping(0.04)),
    "matching": lambda: MotionMatcher(walks()),
}


def far(motion):
    """Return how far each standing foot slides, cm."""
    return [plant.distance for plant in foot_sliding(motion) if plant.stop - plant.start > 2]


@pytest.mark.parametrize("name", CHARACTERS)
def test_every_character_obeys_within_a_second_and_its_feet_stand(name):
    """The bars are 0.95 s and 1 cm; alone they take 1.0 to 1.65 s, and their feet slide by 1.0 to 2.3 cm."""
    make = CHARACTERS[name]
    assert measure_delay(RootTurner(make()), turns=30, speed=1.0, seed=3).mean <= 0.95
    headings = command_headings(20, 30, seed=3)
    turned, alone = (steer(some, headings, 1.0).motion for some in (RootTurner(make()), make()))
    assert np.mean(far(turned)) < 0.3 < 0.8 < np.mean(far(alone))
    assert (jumps(turned) > np.percentile(spread(clips()).within(1), 99.9)).mean() < 0.004
    pace = np.abs(np.diff(on_ground(turned.root_positions))).mean() * 30
    assert pace == pytest.approx(1.0, abs=0.1)


def test_a_foot_whose_ankle_stands_does_not_pivot():
    motion = steer(RootTurner(Controller(GRAPH)), command_headings(20, 30, seed=1), 1.0).motion
    points = joint_positions(motion)
    for ankle, ball in (("lfoot", "ltoes"), ("rfoot", "rtoes")):
        joints = [motion.skeleton.index(name) for name in (ankle, ball)]
        foot = np.unwrap(np.angle(on_ground(np.diff(points[:, joints], axis=1)[:, 0])))
        turned = [np.ptp(foot[start:stop]) for start, stop in runs(motion.contacts[ankle])]
        assert np.degrees(max(turned)) < 1


def test_it_obeys_sooner_than_a_figure_that_turns_about_its_foot():
    about_root, about_foot = (
        measure_delay(make(Controller(GRAPH)), turns=30, seed=1).mean for make in (RootTurner, FootTurner)
    )
    assert about_root < 0.85 * about_foot


def test_the_figure_turns_by_half_more_than_its_rate_at_most_where_its_clip_turns_away():
    turner = RootTurner(Controller(GRAPH), 1.0)
    angles = []
    for heading in command_headings(10, 30, seed=2):
        turner.step(heading, 1.0)
        angles.append(turner.angle)
    assert 0.9 / 30 < np.abs(angles).max() <= 1.5 / 30
    assert np.abs(np.diff(angles)).max() <= 1.0 / (0.15 * 900) + 1e-12  # it rises within 0.15 s


def test_without_turning_and_stretching_the_root_walks_as_the_character_does():
    headings = command_headings(6, 30, seed=2)
    held = steer(RootTurner(Controller(GRAPH), 0.0, stretch=0.0), headings, 1.0).motion
    alone = steer(Controller(GRAPH), headings, 1.0).motion
    np.testing.assert_allclose(on_ground(held.root_positions), on_ground(alone.root_positions), atol=1e-9)
    lowered = alone.root_positions[:, 1] - held.root_positions[:, 1]
    assert (
        lowered.min() > -1e-3 and lowered.max() <= TUNED.lowest_hips
    )  # for legs that are too short in blended poses
    assert np.mean(far(held)) < 0.3 * np.mean(far(alone))


@cache
def circling():
    """Return a graph of a walk on a circle only, which turns by 55° in a second for most of the time."""
    return graphs.compile_graph(bundled("walk_circle"))


def test_it_walks_straight_in_the_direction_asked_for_though_its_clip_turns_all_the_time():
    turner = RootTurner(Controller(circling()))
    track = on_ground(steer(turner, np.full(360, 0.5), 1.0).motion.root_positions)
    assert np.angle(track[-1] - track[120]) == pytest.approx(0.5, abs=np.radians(4))


def test_steps_become_longer_and_shorter_towards_the_speed():
    paces = []
    for speed in (0.9, 1.2):
        walk = graphs.compile_graph(bundled("walk_straight"))
        motion = steer(RootTurner(Controller(walk)), np.zeros(240), speed).motion
        paces.append(np.abs(np.diff(on_ground(motion.root_positions[60:]))).mean() * 30)
    assert paces == pytest.approx([0.99, 1.2], abs=0.05)  # the clip walks at 1.24 m/s, less a fifth


def test_one_who_stands_is_not_turned():
    turner = RootTurner(Controller(graphs.compile_graph(bundled("stop_and_go"))))
    motion = steer(turner, np.full(240, np.pi / 2), speed=0.0).motion
    assert turner.angle == 0 and np.abs(np.diff(motion.root_positions[-30:], axis=0)).max() < 0.01


def test_clips_without_contacts_are_told_of():

    unwarned(RootTurner(Controller(GRAPH)).step, 0.0, 1.0)
    turner = RootTurner(Controller(GRAPH))
    step = turner.character.step
    turner.character.step = lambda *command: step(*command)._replace(contacts={})
    told("mark_plants finds out", turner.step, 0.0, 1.0)


test_nonsense_is_refused = refusals(
    *(("finite rate from 0 on", RootTurner, Controller(GRAPH), rate) for rate in (-0.1, np.nan, np.inf)),
    ("fraction from 0 up to 1", lambda: RootTurner(Controller(GRAPH), stretch=1.0)),
    ("positive number of seconds", lambda: RootTurner(Controller(GRAPH), halflife=0.0)),
)
