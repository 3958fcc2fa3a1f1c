"""Characters walk a plan in place and in time, on feet that stand."""

from functools import cache

import numpy as np
import pytest

from mocap.body.planar import heading
from mocap.errors import MocapError
from mocap.methods.groups.flocking import RATE, Configuration
from mocap.methods.groups.group_graphs import play_group, random_group_walk
from mocap.methods.groups.group_walkers import walk_group
from mocap.methods.groups.planning import Scene, plan_group
from mocap.quality.standing_feet import ground_slides
from tests.bundled import bundled
from tests.methods.groups.built import graph

SCENE = Scene((8 + 0j, 14 + 5j), ((11 - 1.5j, 0.6),))


@cache
def plan():
    group = graph(6, 6)
    found = plan_group(group, SCENE)
    frames = round(found.seconds * RATE) + 1
    return Configuration(*(part[:frames] for part in play_group(group, found.clips)))


@cache
def walkers():
    return walk_group(bundled("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight"), plan())


def test_each_is_where_it_should_be_by_then():
    """The sway of the hips is part of it."""
    assert walkers().off.mean() <= 0.05 and np.percentile(walkers().off, 95) <= 0.10
    assert walkers().nearest >= 0.75
    assert "6 characters, 13.7 s" in walkers().report()


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
    two = Configuration(plan().places[:81, :2], plan().velocities[:81, :2])
    loose = walk_group(bundled("walk_circle", "walk_curve_1"), two, bend=False)
    assert loose.off.mean() > 3 * walkers().off.mean()


@pytest.mark.parametrize(("some", "got"), [(np.s_[:5, :], "6 and 0.4 s"), (np.s_[:, :0], "0 and 13.7 s")])
def test_a_plan_for_nobody_or_of_less_than_a_second_is_refused(some, got):
    with pytest.raises(MocapError, match=f"a member or more and lasts 1 s or more, got {got}: does it lead"):
        walk_group(bundled("walk_curve_1"), Configuration(*(part[some] for part in plan())))


def test_who_stands_at_the_end_is_carried_on_all_the_same():
    places = plan().places.copy()
    places[-15:] = places[-15]
    walked = walk_group(bundled("walk_circle", "walk_curve_1"), Configuration(places[:, :2], places[:, :2]))
    assert len(walked.motions[0]) == len(walked.wanted)


def test_a_way_of_any_length_can_be_walked():
    """Ways whose length rounds below the sum of their steps: a place to pass lies at the path's very end."""
    group = graph(6, 6)
    for seed in range(4):
        played = play_group(group, random_group_walk(group, 1, seed=seed))
        one = Configuration(played.places[:, :1], played.velocities[:, :1])
        assert walk_group(bundled("walk_circle", "walk_curve_1"), one).off.mean() < 0.1
