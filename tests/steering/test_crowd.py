"""Characters give way to one another."""

import numpy as np
import pytest

from mocap.body.ground_path import GroundPath
from mocap.errors import MocapWarning
from mocap.steering import waypoints_and_crowds
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings
from mocap.steering.waypoints_and_crowds import walk_crowd
from tests.bundled import walking
from tests.refusals import quietly

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
    with pytest.warns(MocapWarning, match=r"Characters 0 and 2 come as near as 0\.\d\d m, though 0\.80 m"):
        crowd = walk_crowd(GRAPH, paths)
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
