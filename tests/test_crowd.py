"""Characters give way to one another."""

import numpy as np
import pytest

from mocap.crowd import clearance, walk_crowd
from mocap.errors import MocapError
from mocap.follow import follow_path
from mocap.paths import GroundPath
from tests.graphs import walking

GRAPH = walking()
CROSSING = [GroundPath([[0, 0], [0, 6]]), GroundPath([[3, 3], [-3, 3]])]


def test_who_would_collide_gives_way():
    alone = [follow_path(GRAPH, path) for path in CROSSING]
    crowd = walk_crowd(GRAPH, CROSSING)
    assert clearance(alone) < 0.3
    assert clearance(crowd) > clearance(alone) + 0.15
    assert crowd[0].walk == alone[0].walk  # the first keeps to its path
    assert all(walk.progress == 1.0 for walk in crowd)


def test_who_is_far_apart_walks_as_if_alone():
    paths = [CROSSING[0], GroundPath([[9, 0], [9, 6]])]
    assert [w.walk for w in walk_crowd(GRAPH, paths)] == [follow_path(GRAPH, path).walk for path in paths]


def test_clearance_is_the_least_distance_of_all_pairs():
    walks = [follow_path(GRAPH, path) for path in CROSSING]
    a, b = (walk.track for walk in walks)
    last = max(len(a), len(b))
    apart = [np.hypot(*(a[min(f, len(a) - 1)] - b[min(f, len(b) - 1)])) for f in range(last)]
    assert clearance(walks) == pytest.approx(min(apart))
    assert clearance(walks[:1]) == np.inf


def test_no_distance_is_told():
    with pytest.raises(MocapError, match="more than 0 m apart"):
        walk_crowd(GRAPH, CROSSING, apart=0.0)
