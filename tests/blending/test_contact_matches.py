"""Which plants belong together: whole, lacking, and split ones."""

import numpy as np

from mocap.blending.clocks import match_contacts
from mocap.blending.timewarps import Curve
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton

FPS, SPAN = 100.0, (0.0, 3.0)
BODY = Skeleton(["foot", "other"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
SAME = Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
TWICE = Curve(0.0, 1.0, np.array([-1.0, 1.0, 3.0]))


def standing(*plants, joint="foot"):
    """A body that stands from some times to others, seconds."""
    times = np.arange(601) / FPS
    marks = np.any([(times >= start - 1e-9) & (times < stop - 1e-9) for start, stop in plants], axis=0)
    still = np.tile([1.0, 0, 0, 0], (601, 2, 1))
    return Motion(BODY, np.zeros((601, 3)), still, FPS, contacts={joint: marks})


def matched(*clips, curves=None):
    found = match_contacts(clips, curves or [SAME] * len(clips), SPAN)
    return [(match.starts.round(3).tolist(), match.stops.round(3).tolist()) for match in found]


def test_times_are_those_of_the_common_clock():
    found = matched(standing((1.0, 2.0)), standing((2.2, 4.2)), curves=[SAME, TWICE])
    assert found == [([1.0, 1.1], [2.0, 2.1])]


def test_a_plant_that_a_clip_lacks_is_dropped():
    """As in [KG03, constraint matches]."""
    assert matched(standing((0.2, 0.8), (2, 2.5)), standing((0.3, 0.9))) == [([0.2, 0.3], [0.8, 0.9])]
    assert matched(standing((0.2, 0.8)), standing((1.0, 1.5))) == []
    assert matched(standing((0.2, 0.8)), standing((0.3, 0.9), joint="other")) == []


def test_a_plant_beside_two_is_split_where_the_two_pause():
    """As in [KG03, constraint matches]."""
    one, two = standing((0.2, 1.9)), standing((0.1, 0.9), (1.1, 2.0))
    assert matched(one, two) == [([0.2, 0.1], [1.0, 0.9]), ([1.0, 1.1], [1.9, 2.0])]
    assert matched(one, two, one) == [([0.2, 0.1, 0.2], [1.0, 0.9, 1.0]), ([1.0, 1.1, 1.0], [1.9, 2.0, 1.9])]


def test_a_part_of_a_split_group_that_a_clip_lacks_is_dropped():
    assert matched(standing((0.2, 0.92)), standing((0.1, 0.9), (0.91, 2.0))) == [([0.2, 0.1], [0.905, 0.9])]


def test_plants_end_with_the_span_and_slivers_do_not_count():
    assert matched(standing((2.5, 4.0)), standing((2.6, 3.5))) == [([2.5, 2.6], [3.0, 3.0])]
    assert matched(standing((0.2, 0.21)), standing((0.2, 0.21))) == []
