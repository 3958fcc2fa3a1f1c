"""Characters walk a plan in place and in time, on feet that stand."""

from functools import cache

import numpy as np
import pytest

from mocap.body.ground_path import GroundPath
from mocap.body.motion import resample
from mocap.body.planar import from_ground, heading
from mocap.errors import MocapError
from mocap.files.load_save import load
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.methods.groups.flocking import RATE, Trajectories, nearest_two
from mocap.methods.groups.group_graphs import play_group, random_group_walk
from mocap.methods.groups.group_walkers import walk_group
from mocap.methods.groups.planning import Scene, plan_group
from mocap.quality.standing_feet import ground_slides
from mocap.steering.path_following import follow_path
from tests.bundled import bundled
from tests.methods.groups.built import graph

SCENE = Scene((8 + 0j, 14 + 5j), ((11 - 1.5j, 0.6),))


@cache
def plan():
    group = graph(6, 6)
    found = plan_group(group, SCENE)
    frames = round(found.seconds * RATE) + 1
    return Trajectories(*(part[:frames] for part in play_group(group, found.clips)))


@cache
def walkers():
    return walk_group(bundled("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight"), plan())


def test_each_is_where_it_should_be_by_then():
    """The sway of the hips is part of it."""
    assert walkers().off.mean() <= 0.05 and np.percentile(walkers().off, 95) <= 0.10
    assert walkers().nearest >= 0.75
    assert "6 characters, 13.8 s" in walkers().report()


def test_they_last_as_long_as_the_plan_and_wanted_is_the_plan():
    assert {len(motion) for motion in walkers().motions} == {len(walkers().wanted)}
    np.testing.assert_allclose(walkers().wanted[::3], plan().places, atol=1e-9)


def test_planted_feet_stand():
    for motion in walkers().motions:
        assert ground_slides(motion).max() < 1e-4
        planted = np.mean([mark.mean() for mark in motion.contacts.values()])
        assert planted > 0.3  # of the clips' own 0.35


def test_they_face_where_they_go():
    for motion, way in zip(walkers().motions, walkers().tracks.T, strict=True):
        off = np.angle(np.gradient(way) * np.exp(-1j * heading(motion.rotations[:, 0])))
        assert np.abs(off[15:-15]).mean() < np.radians(15)


def test_the_bare_lines_bring_them_together_and_out_of_time():
    """Without bending, characters of these slow walks come late."""
    two = Trajectories(plan().places[:81, :2], plan().velocities[:81, :2])
    loose = walk_group(bundled("walk_circle", "walk_curve_1"), two, bend=False)
    assert loose.off.mean() > 3 * walkers().off.mean()


def test_a_plan_of_less_than_a_second_is_refused():
    with pytest.raises(MocapError, match=r"lasts a second or more, got 0.4 s: does it lead away"):
        walk_group(bundled("walk_curve_1"), Trajectories(plan().places[:5], plan().velocities[:5]))


def test_a_plan_for_nobody_is_refused():
    with pytest.raises(MocapError, match="one member or more, got none"):
        walk_group(bundled("walk_curve_1"), Trajectories(plan().places[:, :0], plan().velocities[:, :0]))


def test_who_stands_at_the_end_is_carried_on_all_the_same():
    places = plan().places.copy()
    places[-15:] = places[-15]
    walked = walk_group(bundled("walk_circle", "walk_curve_1"), Trajectories(places[:, :2], places[:, :2]))
    assert len(walked.motions[0]) == len(walked.wanted)


def nearest_on(way, track):
    """Mean distance of a track from a way, sampled every centimetre or so."""
    fine = np.interp(np.linspace(0, len(way) - 1, 2000), np.arange(len(way)), way)
    return np.abs(track[:, None] - fine).min(axis=1).mean()


@pytest.mark.exhaustive
def test_people_keep_to_the_plan_in_time_even_without_bending(real_data):
    numbers = (*range(11, 35), 47, 58)
    people = [resample(load(real_data / "cmu/16" / f"16_{n:02}.amc"), 30) for n in numbers]
    motion_graph = prune(build(people, window=10, threshold=0.04))
    assert nearest_two(plan().places).min() >= 0.6
    compiled = compile_graph(motion_graph)
    alone = [follow_path(compiled, GroundPath(from_ground(way))).track @ [1j, 1] for way in plan().places.T]
    late = np.stack([track[np.minimum(np.arange(414), len(track) - 1)] for track in alone], axis=-1)
    loose = walk_group(motion_graph, plan(), bend=False)
    off = np.abs(late - loose.wanted[:414])  # of the bare lines, walked when it suits
    assert off.mean() > 0.3 and nearest_two(late).min() < loose.nearest
    beside = [nearest_on(way, track) for way, track in zip(plan().places.T, loose.tracks.T, strict=True)]
    assert np.mean(beside) <= 0.05
    assert loose.off.mean() <= 0.12 and np.percentile(loose.off, 95) <= 0.30 and loose.nearest >= 0.75
    bent = walk_group(motion_graph, plan())
    assert bent.off.mean() <= 0.05 and bent.nearest >= 0.75


def test_a_way_of_any_length_can_be_walked():
    """Ways whose length rounds below the sum of their steps: a place to pass lies at the path's very end."""
    group = graph(6, 6)
    for seed in range(4):
        played = play_group(group, random_group_walk(group, 1, seed=seed))
        one = Trajectories(played.places[:, :1], played.velocities[:, :1])
        assert walk_group(bundled("walk_circle", "walk_curve_1"), one).off.mean() < 0.1
