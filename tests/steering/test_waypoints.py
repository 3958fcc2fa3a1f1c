"""Waypoints are met: where, how and when."""

import math

import pytest

from mocap.editing.bending import LIMIT
from mocap.steering.waypoints_and_crowds import Waypoint, through_waypoints
from tests.bundled import sneaking, walking
from tests.refusals import refusals
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
