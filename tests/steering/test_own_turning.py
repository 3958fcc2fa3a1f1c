"""How walks turn by themselves: along a clip as its path does, through a seam from one path to the other."""

import numpy as np
import pytest

from mocap.body import circle, on_ground
from mocap.editing.path_editing import moving_frames, ride_of
from mocap.steering.bent_following import own_paths, own_ride, plan_bending
from mocap.steering.path_objective import Wishes
from mocap.synthesis import random_walk, to_motion
from tests.bundled import walking

GRAPH = walking()
OWN, TURNS = own_paths(GRAPH)


def ride_edges(clip):
    """Give the numbers of the edges that play a clip from its first node to its last."""
    return np.array([n for n, (s, _, _) in enumerate(GRAPH.edges) if s[0] == clip and not GRAPH.blended[n]])


def rows_of(edges):
    return np.concatenate([np.arange(GRAPH.frames[e]) + GRAPH.first[e] for e in edges])


def test_along_a_clip_it_is_the_clips_own_path():
    clip = GRAPH.source.clips[0]
    ride = ride_of(clip)
    heads = np.asarray(moving_frames(ride.path, ride.along).angle)
    edges = ride_edges(0)
    first, last = GRAPH.edges[edges[0]][0][1], GRAPH.edges[edges[-1]][1][1]
    rows = rows_of(edges)
    assert len(rows) == last - first
    far = ride.along[last - 1] - ride.along[max(first - 1, 0)]
    assert OWN.step[rows].sum() == pytest.approx(far, abs=1e-9)
    assert TURNS[rows].sum() == pytest.approx(heads[last - 1] - heads[max(first - 1, 0)], abs=1e-9)
    joined = own_ride(OWN, edges)
    assert joined.path.points == pytest.approx(ride.path.points[first:last], abs=1e-9)


def test_a_seam_leads_smoothly_from_path_to_path():
    walk = random_walk(GRAPH.source, seconds=30, seed=2)
    edges = np.array([GRAPH.edges.index(edge) for edge in walk])
    assert GRAPH.blended[edges].sum() > 3
    ride, ground = own_ride(OWN, edges), on_ground(to_motion(GRAPH.source, walk).root_positions)
    away = np.abs(ground - on_ground(ride.path.at(ride.along)))
    assert away.max() < 0.08  # the sway
    assert OWN.step[rows_of(edges)].sum() == pytest.approx(ride.along[-1], rel=0.02)
    turned = np.ptp(np.asarray(moving_frames(ride.path, ride.along).angle)[[0, -1]])
    assert abs(TURNS[rows_of(edges)].sum()) == pytest.approx(turned, abs=0.5)  # ends go straight on
    assert np.abs(np.diff(np.abs(np.diff(on_ground(ride.path.points))))).max() < 0.01  # no jump at a seam


def test_a_route_of_a_circle_asks_for_its_curvature():
    route, _ = plan_bending(GRAPH, circle(2.0), Wishes(), 1.0)
    assert np.array_equal(route.turns, TURNS) and len(route.curvature) == len(route.points)
    steps = np.sqrt(
        (1 + (1.2 * 0.5) ** 2) ** -0.25
    )  # a slowed walk takes shorter steps: more of its own metres
    assert route.curvature[50:550] == pytest.approx(0.5 * steps, abs=0.01)
    assert route.length == pytest.approx((circle(2.0).length * 1.02 + 0.5) / steps, rel=0.01)
