"""Waypoints are met: where, how and when; and characters give way to one another."""

import math

import numpy as np
import pytest

from mocap.body.ground_path import GroundPath
from mocap.editing.bending import LIMIT
from mocap.steering import waypoints_and_crowds
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings
from mocap.steering.waypoints_and_crowds import Waypoint, through_waypoints, walk_crowd
from tests.bundled import sneaking, walking
from tests.refusals import quietly, refusals, told
from tests.steering.test_bent_following import straight_walker


@pytest.mark.filterwarnings("ignore:The walk leaves")
def test_places_and_times_are_kept():
    """As in [KGP02, 5.3]."""
    points = [Waypoint(0, 0), Waypoint(0.5, 4, seconds=5.0), Waypoint(-0.5, 8, seconds=10.0)]
    _, arrivals = through_waypoints(walking(), points)
    for point, arrival in zip(points, arrivals, strict=True):
        assert arrival.off < 0.3
        if point.seconds is not None:
            assert arrival.late == pytest.approx(arrival.seconds - point.seconds)
            assert abs(arrival.late) < 1.0
    assert math.isnan(arrivals[0].late)


def test_each_waypoint_sets_the_kind_of_motion():
    """As in [KGP02, 5.3]."""
    points = [Waypoint(0, 0, "walk"), Waypoint(0, 4, "sneak"), Waypoint(0, 8)]
    followed, _ = through_waypoints(sneaking(), points)
    motion, along = followed.motion(), followed.along
    assert motion.labels["walk"][along < 3.5].mean() > 0.9
    assert motion.labels["sneak"][(along > 4.5) & (along < 7.5)].mean() > 0.9


test_impossible_waypoints_are_told = refusals(
    ("two points", through_waypoints, walking(), [Waypoint(0, 0)]),
    ("Times must grow", through_waypoints, walking(), [Waypoint(0, 0), Waypoint(0, 4, seconds=0.0)]),
)


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_bent_walks_meet_waypoints_that_no_clip_turns_to():
    """A straight walk: without bending it misses a waypoint by metres."""
    points = [
        Waypoint(0, 0),
        Waypoint(1.5, 3, seconds=3.2),
        Waypoint(-0.5, 5.5),
        Waypoint(0, 9, seconds=10.0),
    ]
    _, plain = through_waypoints(straight_walker(), points)
    _, bent = through_waypoints(straight_walker(), points, bend=LIMIT)
    assert max(arrival.off for arrival in plain) > 0.5
    assert max(arrival.off for arrival in bent) < 0.08
    late = [abs(arrival.late) for arrival in bent if not math.isnan(arrival.late)]
    assert max(late) < 1.5


GRAPH = walking()
CROSSING = [GroundPath([[0, 0], [0, 6]]), GroundPath([[3, 3], [-3, 3]])]


def apart(a, b):
    """Measure how near two tracks come, a frame at a time; who has arrived, stays."""
    frames = range(max(len(a), len(b)))
    return min(np.hypot(*(a[min(f, len(a) - 1)] - b[min(f, len(b) - 1)])) for f in frames)


def test_who_would_collide_gives_way():
    """As in [KGP02, 5.3]."""
    alone = [follow_path(GRAPH, path, settings=Settings(width=100)) for path in CROSSING]
    crowd = walk_crowd(GRAPH, CROSSING)
    assert apart(*(walk.track for walk in alone)) < 0.3
    assert crowd.nearest[0, 1] >= 0.8
    assert crowd.walks[0].walk == alone[0].walk  # the first keeps to its path
    assert all(walk.progress == 1.0 for walk in crowd.walks)


def test_who_meets_head_on_steps_aside_or_waits():
    paths = [GroundPath([[0, 0], [0, 7]]), GroundPath([[0, 7], [0, 0]]), GroundPath([[3, 3], [-3, 3]])]
    crowd = quietly(walk_crowd, GRAPH, paths)
    assert crowd.nearest.min() > 0.7
    assert crowd.waits[0] == 0.0


@pytest.mark.filterwarnings("ignore:The walk leaves")
def test_what_falls_short_is_told(monkeypatch):
    """Two who start in one place cannot keep apart, whoever waits; it says which, and how near they come."""
    paths = [*CROSSING, GroundPath([[0, 0.1], [0, 6]])]
    monkeypatch.setattr(waypoints_and_crowds, "WIDTH", 30)
    crowd = told(r"Characters 0 and 2 come as near as 0\.\d\d m, though 0\.80 m", walk_crowd, GRAPH, paths)
    tracks = [
        np.concatenate([np.repeat(walk.track[:1], round(30 * wait), axis=0), walk.track])
        for walk, wait in zip(crowd.walks, crowd.waits, strict=True)
    ]
    for a in range(3):
        for b in range(3):
            expected = np.inf if a == b else apart(tracks[a], tracks[b])
            assert crowd.nearest[a, b] == pytest.approx(expected)


def test_who_is_far_apart_walks_as_if_alone():
    paths = [CROSSING[0], GroundPath([[9, 0], [9, 6]])]
    crowd = walk_crowd(GRAPH, paths)
    alone = [follow_path(GRAPH, path, settings=Settings(width=100)).walk for path in paths]
    assert [w.walk for w in crowd.walks] == alone
    assert crowd.waits == [0.0, 0.0]
    assert walk_crowd(GRAPH, paths[:1]).nearest.tolist() == [[np.inf]]
