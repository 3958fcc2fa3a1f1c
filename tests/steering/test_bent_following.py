"""Any line with any walk: laid on it as it turns by itself, with few seams, feet that stand, and no jolt."""

from dataclasses import replace
from functools import cache
from itertools import product
from unittest.mock import patch

import numpy as np
import pytest
from asked_lines import LINES, random_line

from mocap.body import SHAPES, GroundPath, circle, on_ground, resample
from mocap.datasets import samples
from mocap.editing import LIMIT, moving_frames, plants_kept, ride_of
from mocap.errors import NoWalk
from mocap.files.load_save import load
from mocap.graphs import build, prune
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.steering import PathRequest, Settings, follow_path, path_following
from mocap.steering.bent_following import plan_bending
from mocap.steering.smooth_paths import path_of_walk, smooth_graph
from mocap.synthesis import random_walk, to_motion
from tests.bundled import sneaking, walking
from tests.editing.test_path_editing import slide
from tests.editing.wishes import smoothness
from tests.refusals import quietly, refusals, refused, told

SOME = {
    "sine": LINES["sine"](),
    "letter S": SHAPES["letter S"](1.2),
    "circle": circle(1.2),
    "heart": LINES["heart"](),
    "random": random_line(501),
}


def bent_walk(graph, path, **options):
    return quietly(follow_path, graph, path, bend=LIMIT, **options)


@cache
def straight_walker() -> CompiledGraph:
    """One straight walk, again and again: no line can be followed with it unless it is bent."""
    clips = [resample(samples.sample("walk_straight"), 30)]
    return compile_graph(prune(build(clips, window=10, threshold=0.06)))


def require_kept_to(followed):
    """Hold a walk against every bar."""
    bent = followed.bent
    as_asked = bent.off[~bent.rounded]
    if len(as_asked):
        assert as_asked.mean() <= 0.025
        assert as_asked.max() <= 0.08
    assert followed.seams_per_second <= 0.7
    assert slide(bent.motion) <= 1e-4
    assert plants_kept(bent.motion, bent.laid) >= 0.95
    assert bent.along[-1] > 0.97 * bent.path.length
    # Clips differ, and a walk plays some of them more: so it is measured against itself before it was bent.
    assert smoothness(bent.motion, to_motion(followed.graph, followed.walk)) <= 1.25


WALKERS_AND_LINES = [
    (walking, "random"),
    (straight_walker, "heart"),
    *(
        pytest.param(graph, line, marks=pytest.mark.sweep)
        for graph, line in product([walking, straight_walker], SOME)
    ),
]


@pytest.mark.parametrize(("graph", "line"), WALKERS_AND_LINES)
def test_any_line_with_any_walk(graph, line):
    require_kept_to(bent_walk(graph(), SOME[line]))


def test_without_bending_a_straight_walk_stays_straight():
    """The naive way: 6 m off an S on average, and nothing that the search could do about it."""
    path = SHAPES["letter S"](1.6)
    off = r"The nearest walk is \d\.\d m off the line on average; no clips turn as it does: add clips"
    require_refused(straight_walker(), path, off, bend=0.0)
    assert bent_walk(straight_walker(), path).off.mean() < 0.025
    leaves = "no clips turn as it does there; add clips that turn, or bend the walk onto the path"
    assert told(leaves, follow_path, straight_walker(), GroundPath([[0, 0], [0, 4], [2.4, 8]])).bent is None


def test_the_search_asks_for_little_bending():
    """A walk found by its distance and bent afterwards is turned as much, or has more seams."""
    path = SOME["sine"]
    bent = bent_walk(walking(), path)
    careless = bent_walk(walking(), path, settings=Settings(bend=0))
    assert np.square(bent.bent.turned).sum() < 0.6 * np.square(careless.bent.turned).sum()
    plain = quietly(follow_path, walking(), path)
    assert bent.seams_per_second < plain.seams_per_second
    assert bent.off.mean() < plain.off.mean()


def test_what_it_says_is_what_the_motion_does():
    path = GroundPath([[0, 0], [0, 5], [0.9, 0]])
    followed = told("it turns too fast there", follow_path, walking(), path, bend=np.radians(60))
    motion = followed.motion(name="corner")
    assert motion.name == "corner"
    assert followed.track == pytest.approx(motion.root_positions[:, [0, 2]])
    assert len(motion) == len(followed.off) == len(followed.along) == len(followed.unlabelled)
    assert followed.progress > 0.98
    assert motion.root_positions[-1, [0, 2]] == pytest.approx([0.9, 0], abs=0.1)
    assert slide(followed.motion(clean=False)) > slide(motion)
    assert "rounded at" in followed.report()
    assert f"{followed.seams_per_second:.2f} seams per second" in followed.report()


def test_a_line_that_is_not_rounded_is_not_blamed_for_turning():
    followed = bent_walk(walking(), GroundPath([[0, 0], [0, 4]]))
    given = replace(followed, off=followed.off + 0.15), LIMIT
    told("the clips sway so far", path_following._warn_of_departures, *given)


def test_labels_and_times_are_kept_on_the_line():
    path = SOME["sine"]
    followed = bent_walk(
        sneaking(), path, request=PathRequest(labels=[(0, "walk"), (6, "sneak"), (12, "walk")])
    )
    sneaks = followed.bent.motion.labels["sneak"]
    assert sneaks[(followed.along > 7.5) & (followed.along < 11)].mean() > 0.9
    assert not sneaks[followed.along < 5].any()
    assert "without the label asked for" in followed.report()
    late = PathRequest(times=[(0, 0), (8, 14)])
    slow = bent_walk(sneaking(), path, request=late)
    arrival = np.searchsorted(slow.along, 8) / 30
    assert abs(arrival - 14) < 1.0


def asked(bend=LIMIT, **request):
    return follow_path(walking(), circle(2.0), PathRequest(**request), bend=bend)


test_what_cannot_be_asked_is_told = refusals(
    ("got bend=-1", asked, -1.0),
    ("got bend=nan", asked, np.nan),
    (NoWalk, "bears the label 'swim'", lambda: asked(labels=[(0, "swim")])),
    (r"asked for 99 m along a path of 12\.6 m", lambda: asked(labels=[(99, "walk")])),
)


def require_refused(graph, path, match, bend=LIMIT):
    with patch.object(path_following, "find_walk", wraps=path_following.find_walk) as searched:
        refused(match, follow_path, graph, path, bend=bend, kind=NoWalk)
    assert searched.call_count <= 5  # no more than the tries and a last one: it does not search for minutes


def test_clips_that_stand_cannot_follow_a_line():
    stop = samples.sample("stop_and_go")
    speed = np.hypot(*np.gradient(stop.root_positions[:, [0, 2]], axis=0).T) * stop.fps
    first = int(np.flatnonzero(speed < 0.01)[0])
    assert (speed[first : first + 200] < 0.1).all()
    one = stop[first : first + 200]
    clips = [one, replace(one[np.arange(199, -1, -1)], name="back")]
    standing = prune(build(clips, window=20, threshold=0.2))
    add = "; no clip goes faster than 0.5 m/s: add some"
    require_refused(standing, circle(2.0), f"No walk goes along the line at 0.3 m/s{add}")
    off = r"The nearest walk is \d\.\d m off the line on average, and goes at 0\.\d\d m/s"
    require_refused(standing, circle(2.0), off + add, bend=0.0)


def test_jumps_that_do_not_turn_as_a_circle_does_are_told_of_bend(real_data):
    clips = [resample(load(real_data / "cmu" / "16" / f"16_{n:02}.amc"), 30) for n in (1, 5)]
    jumps = compile_graph(prune(build(clips, window=10, threshold=0.06)))
    require_refused(jumps, circle(2.0), "1 of 2 clips go .*, more walks, or bend=", bend=0.0)
    bent = bent_walk(jumps, circle(2.0))
    assert bent.progress > 0.97 and bent.off.mean() < 0.05


@pytest.mark.parametrize("threshold", [0.05, 0.12])
def test_dancers_walk_a_line_as_quickly_as_people_or_are_refused_at_once(real_data, threshold):
    """At 0.05 the dancers' graph holds loops on the spot alone: walks took 366 s for ten metres."""
    files = sorted((real_data / "cmu" / "49").glob("*.amc"))[:20]
    clips = [resample(load(file), 30) for file in files]
    graph, path = compile_graph(prune(build(clips, window=10, threshold=threshold))), LINES["sine"]()
    if threshold < 0.1:
        require_refused(graph, path, "No walk goes along the line at 0.3 m/s; 7 of 20 clips go faster")
        return
    followed = bent_walk(graph, path)
    assert followed.progress > 0.99
    assert followed.seconds < path.length / 0.3
    assert followed.off.mean() < 0.05
    assert plants_kept(followed.bent.motion, followed.bent.laid) > 0.98


GRAPH = walking()
OWN, TURNS = smooth_graph(GRAPH)


def rows_of(edges):
    return np.concatenate([np.arange(GRAPH.frames[e]) + GRAPH.first[e] for e in edges])


def test_along_a_clip_it_is_the_clips_own_path():
    clip = GRAPH.source.clips[0]
    ride = ride_of(clip)
    heads = np.asarray(moving_frames(ride.path, ride.along).angle)
    edges = np.array([n for n, (s, *_) in enumerate(GRAPH.edges) if s[0] == 0 and not GRAPH.blended[n]])
    first, last = GRAPH.edges[edges[0]][0][1], GRAPH.edges[edges[-1]][1][1]
    rows = rows_of(edges)
    assert len(rows) == last - first
    far = ride.along[last - 1] - ride.along[max(first - 1, 0)]
    assert OWN.step[rows].sum() == pytest.approx(far, abs=1e-9)
    assert TURNS[rows].sum() == pytest.approx(heads[last - 1] - heads[max(first - 1, 0)], abs=1e-9)
    joined = path_of_walk(OWN, edges)
    assert joined.path.points == pytest.approx(ride.path.points[first:last], abs=1e-9)


def test_a_seam_leads_smoothly_from_path_to_path():
    walk = random_walk(GRAPH.source, seconds=30, seed=2)
    edges = np.array([GRAPH.edges.index(edge) for edge in walk])
    assert GRAPH.blended[edges].sum() > 3
    ride, ground = path_of_walk(OWN, edges), on_ground(to_motion(GRAPH.source, walk).root_positions)
    away = np.abs(ground - on_ground(ride.path.at(ride.along)))
    assert away.max() < 0.1  # the sway: the clips themselves are up to 9 cm off their paths
    assert OWN.step[rows_of(edges)].sum() == pytest.approx(ride.along[-1], rel=0.02)
    turned = np.ptp(np.asarray(moving_frames(ride.path, ride.along).angle)[[0, -1]])
    assert abs(TURNS[rows_of(edges)].sum()) == pytest.approx(turned, abs=0.5)  # ends go straight on
    assert np.abs(np.diff(np.abs(np.diff(on_ground(ride.path.points))))).max() < 0.01  # no jump at a seam


def test_a_route_of_a_circle_asks_for_its_curvature():
    route, _ = plan_bending(GRAPH, circle(2.0), PathRequest(), 1.0)
    assert np.array_equal(route.rotations, TURNS) and len(route.curvature) == len(route.points)
    steps = np.sqrt(
        (1 + (1.2 * 0.5) ** 2) ** -0.25
    )  # a slowed walk takes shorter steps: more of its own metres
    assert route.curvature[50:550] == pytest.approx(0.5 * steps, abs=0.01)
    assert route.length == pytest.approx((circle(2.0).length * 1.02 + 0.5) / steps, rel=0.01)
