"""Waypoints are met: where, how and when."""

import math

import pytest

from mocap.errors import MocapError
from mocap.steering.waypoints import Waypoint, through_waypoints
from tests.bundled import sneaking, walking


@pytest.mark.filterwarnings("ignore:The walk leaves")
def test_places_and_times_are_kept():
    points = [Waypoint(0, 0), Waypoint(0.5, 4, seconds=5.0), Waypoint(-0.5, 8, seconds=10.0)]
    found = through_waypoints(walking(), points)
    for point, arrival in zip(points, found.arrivals, strict=True):
        assert arrival.off < 0.3
        if point.seconds is not None:
            assert arrival.late == pytest.approx(arrival.seconds - point.seconds)
            assert abs(arrival.late) < 1.0
    assert math.isnan(found.arrivals[0].late)


def test_each_waypoint_sets_the_kind_of_motion():
    points = [Waypoint(0, 0, "walk"), Waypoint(0, 4, "sneak"), Waypoint(0, 8)]
    found = through_waypoints(sneaking(), points)
    motion, along = found.followed.motion(), found.followed.along
    assert motion.labels["walk"][along < 3.5].mean() > 0.9
    assert motion.labels["sneak"][(along > 4.5) & (along < 7.5)].mean() > 0.9


def test_impossible_waypoints_are_told():
    with pytest.raises(MocapError, match="two points"):
        through_waypoints(walking(), [Waypoint(0, 0)])
    with pytest.raises(MocapError, match="Only the first waypoint"):
        through_waypoints(walking(), [Waypoint(0, 0), Waypoint(0, 4, seconds=0.0)])
