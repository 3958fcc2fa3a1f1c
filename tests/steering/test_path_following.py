"""Walks keep to their paths, do what is asked for, meet waypoints and give way; and the paper's search."""

import math
from dataclasses import replace

import numpy as np
import pytest
from asked_lines import random_line
from scipy.spatial import cKDTree

from mocap.body import GroundPath, ground_path, on_ground, resample, s_curve
from mocap.datasets.samples import sample
from mocap.editing.bending import LIMIT
from mocap.errors import MocapWarning, NoWalk, warn
from mocap.graphs import build, prune
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering import followed as following
from mocap.steering import path_following, waypoints_and_crowds
from mocap.steering.followed import measure_walk
from mocap.steering.path_following import follow_as_2002, follow_path, path_problem
from mocap.steering.path_objective import PathRequest, Settings, make_route
from mocap.steering.path_search import find_walk
from mocap.steering.tuned import TUNED
from mocap.steering.waypoints_and_crowds import Waypoint, through_waypoints, walk_crowd
from mocap.synthesis.ground_walks import GroundWalks, Stand
from tests.bundled import bundled, captured, sneaking, walking
from tests.refusals import quietly, refusals, refused, told
from tests.steering.test_bent_following import straight_walker
from tests.tuning import tune

GRAPH = walking()
BOUNDS = ("mean_distance", "leaves_path", "seam_rate")  # of `Tuned`, as `followed` reads them


def walked(path, *request, **how):
    """Follow a path, whatever is warned of."""
    return quietly(follow_path, GRAPH, path, *request, **how)


def shapes(first, without=()):
    """List one shape, and the others for a sweep."""
    others = sorted(set(ground_path.SHAPES) - {first, *without})
    return [first, *(pytest.param(shape, marks=pytest.mark.sweep) for shape in others)]


STRAIGHT, START = GroundPath([[2, 1], [2, 9]]), PathRequest(start=GRAPH.nodes[300])


@pytest.mark.parametrize("shape", shapes("square", without={"letter S"}))  # two clips turn only so far
def test_walks_stay_on_their_paths(shape):
    followed = walked(ground_path.SHAPES[shape]())
    assert followed.off.mean() < 0.06
    assert followed.off.max() < 0.3
    assert followed.progress == 1.0
    assert followed.seams_per_second < 1.6


def test_what_it_tells_is_what_the_motion_does():
    followed = walked(s_curve())
    motion = followed.motion(name="s")
    body = on_ground(motion.root_positions)
    assert followed.track == pytest.approx(np.stack([body.imag, body.real], axis=1), abs=1e-9)
    fine = followed.path.resampled(0.001).points
    assert followed.off == pytest.approx(cKDTree(fine).query(followed.track)[0], abs=2e-3)
    assert len(motion) == len(followed.off) == len(followed.along)
    assert (np.diff(followed.along) > -0.3).all()
    assert f"{100 * followed.off.mean():.1f} cm off on average" in followed.report()
    assert f"({100 * followed.off_at_length.mean():.1f} cm at equal arc length)" in followed.report()


def test_distance_at_equal_arc_length_is_that_of_eq_9():
    """As in [KGP02, Eq. 9]: s grows by a step, or by γ where that is more."""
    path = s_curve()
    followed = walked(path)
    steps = np.hypot(*np.diff(followed.track, axis=0).T)
    s = np.cumsum(np.maximum(steps, GRAPH_TUNED.least_speed / GRAPH.fps))
    expected = np.hypot(*(followed.track[1:] - path.at(s)).T)
    # Where a blend begins, the root's step is measured in the clip, which is off by millimetres.
    assert followed.off_at_length[1:] == pytest.approx(expected, abs=0.06)
    assert (followed.off <= followed.off_at_length + 0.5).all()


def test_with_every_term_off_the_cost_is_eq_9():
    """Then the search sums the squares of the distance at equal arc length, and nothing else.

    As in [KGP02, Eq. 9].
    """
    plain = Settings(seam=0, match=0, stray=0, width=30, rescue=0, tries=1)
    followed = walked(s_curve(10), PathRequest(correction=0), settings=plain)
    assert followed.found.cost == pytest.approx((followed.off_at_length**2).sum(), rel=1e-6)
    slid = walked(s_curve(10), settings=plain)
    assert slid.found.cost != pytest.approx((slid.off_at_length**2).sum(), rel=0.01)


TIGHT = s_curve(4)  # nearly as tight as the clips turn: the first search finds no walk within all bounds


def test_what_is_out_of_bounds_is_searched_for_again(monkeypatch):
    """By a second and a third, wider search, at another price; the best walk is taken."""
    tried, walks = [], []

    def search(graph, route, starts, settings, deadline):
        tried.append(settings)
        return find_walk(graph, route, starts, settings, deadline)

    def measure(*args):
        walks.append(measure_walk(*args))
        return walks[-1]

    monkeypatch.setattr(path_following, "find_walk", search)
    monkeypatch.setattr(path_following, "measure_walk", measure)
    once = walked(TIGHT, settings=Settings(tries=1))
    assert once.excess > 1 and len(tried) == 1
    better = walked(TIGHT)
    assert better.excess == min(walk.excess for walk in walks)
    assert (tried[2].seam > Settings.seam) == (once.seams_per_second > 1)
    for factor, widths in ((1 / 9, [50, 75, 100]), (9, [50])):
        bounds = {bound: factor * getattr(TUNED, bound) for bound in BOUNDS}
        tune(monkeypatch, following, **bounds)
        tried.clear()
        walk = walked(TIGHT)
        assert [settings.width for settings in tried] == widths
        assert (walk.excess > 1) == (factor < 1)
    assert walk.walk == once.walk


def test_a_second_search_that_is_stopped_is_the_last():
    searches = []

    def progress(layers):
        searches.append(layers)
        yield from layers[: 20 if len(searches) == 2 else None]
        if len(searches) == 2:
            raise KeyboardInterrupt

    assert walked(TIGHT, settings=Settings(progress=progress)).progress == 1.0
    assert len(searches) == 2


def test_it_starts_where_asked_in_the_direction_of_the_path():
    followed = walked(STRAIGHT, START)
    assert followed.walk[0][0] == START.start
    assert followed.track[0] == pytest.approx([2, 1], abs=0.06)
    way = followed.track[10] - followed.track[0]
    assert np.arctan2(*way) == pytest.approx(0.0, abs=0.25)


def test_labels_are_had_where_they_are_asked_for():
    """As in [KGP02, labels]."""
    graph = sneaking()
    request = PathRequest(labels=[(0, "walk"), (4, "sneak"), (7, "walk")])
    followed = follow_path(graph, GroundPath([[0, 0], [0, 10]]), request)
    motion = followed.motion()
    middle = (followed.along > 4.5) & (followed.along < 6.5)
    assert motion.labels["sneak"][middle].mean() > 0.9
    assert motion.labels["walk"][followed.along < 3.5].mean() > 0.9
    assert followed.unlabelled.mean() < 0.15
    assert "without the label asked for" in followed.report() or not followed.unlabelled.any()


def test_a_corner_that_no_clip_can_turn_is_cut_and_told(monkeypatch):
    zigzag = GroundPath([[0, 0], [0, 4], [0.5, 0], [1, 4], [1, 8]])
    monkeypatch.setattr(path_following, "measure_walk", lambda *given: warn("seen") or measure_walk(*given))
    leaves = r"leaves the path (once|\d+ times), the furthest by \d+ cm at"
    with pytest.warns(MocapWarning, match=leaves) as caught:
        followed = follow_path(GRAPH, zigzag)
    assert len(caught) == 2 and str(caught[0].message) == "seen" and followed.progress == 1.0
    assert caught[1].filename == __file__  # who called the package, however deep it warns
    assert (len(followed.departures) == 1) == ("leaves the path once" in str(caught[1].message))
    assert max(worst for _, _, worst in followed.departures) == pytest.approx(followed.off.max())


def test_no_walk_dawdles():
    clips = [resample(replace(sample(name), fps=20), 15) for name in ("walk_circle", "walk_curve_1")]
    graph = prune(build(clips, window=20, threshold=0.08))
    slow = told("leaves the path", follow_path, graph, GroundPath([[0, 0], [0, 3]]))
    assert slow.seconds <= slow.along[-1] / 0.3 + 1


def asked(path=STRAIGHT, **request):
    return follow_path(GRAPH, path, PathRequest(**request))


test_bad_wishes_are_told = refusals(
    (NoWalk, "bears the label 'fly'; there are: walk", lambda: asked(labels=[(0, "fly")])),
    ("'walk' is asked for 99 m along", lambda: asked(labels=[(99, "walk")])),
    (NoWalk, r"no node \(0, 99999\); the nearest", lambda: asked(start=(0, 99999))),
    ("must grow along the path", lambda: asked(times=[(4, 3), (8, 2)])),
    ("in one place", lambda: asked(times=[(4, 3), (4, 5)])),
    (NoWalk, "out of nodes before its first step", lambda: follow_as_2002(GRAPH, STRAIGHT, START, budget=0)),
    (r"hour, at \d\.\d\d m/s .*: is it in metres", asked, GroundPath([[0, 0], [0, 8000]])),
)


def test_a_label_out_of_reach_is_told_with_those_in_reach():
    graph = sneaking()
    source = graph.source.graph.copy()
    source.remove_edges_from([(a, b, k) for a, b, k in source.edges(keys=True) if b[0] == 2 != a[0]])
    cut = type(graph.source)(graph.source.clips, graph.source.window, source)
    start = next(node for node in sorted(source) if node[0] == 0)
    with pytest.raises(NoWalk, match="No walk comes to the label 'sneak' from there; it can reach: walk"):
        follow_path(cut, STRAIGHT, PathRequest(labels=[(0, "sneak")], start=start))


@pytest.mark.parametrize("shape", shapes("S-curve"))
def test_real_walks_stay_on_their_paths(real_data, shape):
    followed = follow_path(captured(real_data), ground_path.SHAPES[shape]())
    assert followed.off.mean() <= 0.04
    assert followed.off.max() <= 0.15
    assert followed.seams_per_second <= 1.0


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_layers_keep_to_the_path_where_depth_first_does_not():
    """It counts squares of distances at equal arc length [KGP02, Eq. 9]."""
    ours = follow_path(GRAPH, s_curve(10))
    theirs = follow_as_2002(GRAPH, s_curve(10), PathRequest(start=ours.walk[0][0]), budget=300)
    assert theirs.progress == 1.0
    assert theirs.found.expanded > 300
    assert theirs.found.cut > 0 and theirs.found.cost == pytest.approx((theirs.off_at_length**2).sum())
    assert "out of nodes: the best so far" in theirs.report()
    assert ours.off.mean() < theirs.off.mean()


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_what_the_papers_search_gains_at_its_best_it_pays_in_seams(real_data):
    """As in [KGP02, 5.1]. Where they are free in layers, too, walks in layers are nearer on these lines."""
    graph, found = captured(real_data), []
    free, best = Settings(seam=0, match=0, width=200, tries=1), 30_000
    for seed in (500, 502, 507):
        path = GroundPath(random_line(seed).at(np.linspace(0, 7, 141)))
        usual = follow_path(graph, path)
        request = PathRequest(start=usual.walk[0][0], correction=0)
        theirs = follow_as_2002(graph, path, request, look=(45, 15), budget=best)
        found.append((follow_path(graph, path, settings=free), theirs, usual))
    off = np.array([[walk.off.mean() for walk in walks] for walks in found])
    seams = np.array([[walk.seams_per_second for walk in walks] for walks in found])
    assert (np.diff(off) > 0).all() and (np.diff(off)[:, 1] < 0.02).all()
    assert np.median(seams[:, 0]) < 1.3 * np.median(seams[:, 1]) and (2 * seams[:, 2] < seams[:, 1]).all()


def test_who_stands_gets_on_by_a_little():
    """As in [KGP02, least progress]: else a walk that stands would never end."""
    graph, path = compile_graph(bundled("stop_and_go")), GroundPath([[0, 0], [0, 3]])
    walks = GroundWalks(graph)
    problem = path_problem(walks, make_route(graph, path, PathRequest()))
    own, counted = [], []
    for edge in walks.number:
        own.append(graph.step[walks.step(Stand(1 + 0j, 0j), edge)[0]])
        counted.append(problem.step(Stand(1 + 0j, 0j), edge)[1].along)
    least = [np.maximum(steps, 0.3 / graph.fps).sum() for steps in own]
    assert counted == pytest.approx(least)
    assert min(steps.sum() / len(steps) for steps in own) * graph.fps < 0.1


@pytest.mark.filterwarnings("ignore:The walk leaves")
def test_places_and_times_are_kept():
    """As in [KGP02, 5.3]."""
    points = [Waypoint(0, 0), Waypoint(0.5, 4, seconds=4.0), Waypoint(-0.5, 8, seconds=8.0)]
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
    """A straight walk: without bending it misses the waypoints by metres."""
    points = [
        Waypoint(0, 0),
        Waypoint(1.5, 3, seconds=2.8),
        Waypoint(-0.5, 5.5),
        Waypoint(0, 9, seconds=8.5),
    ]
    refused("clips that turn, or try bend=", through_waypoints, straight_walker(), points, kind=NoWalk)
    _, bent = through_waypoints(straight_walker(), points, bend=LIMIT)
    assert max(arrival.off for arrival in bent) < 0.08
    late = [abs(arrival.late) for arrival in bent if not math.isnan(arrival.late)]
    assert max(late) < 1.5


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


def test_who_may_not_search_again_waits_until_the_way_is_clear(monkeypatch):
    tune(monkeypatch, waypoints_and_crowds, detours=0, crowd_beam=30)
    crowd = walk_crowd(GRAPH, CROSSING)
    assert crowd.nearest[0, 1] >= 0.8
    assert crowd.waits[0] == 0
    assert 0 < crowd.waits[1] < 8
    assert crowd.walks[1].walk == follow_path(GRAPH, CROSSING[1], settings=Settings(width=30)).walk


def test_of_waits_that_keep_as_far_apart_the_shortest_is_taken(monkeypatch):
    """Who starts too near is as near after each wait, but for rounding."""
    distances = iter([0.6, 0.6 + 1e-12, 0.6 + 2e-12, 0.6 - 1e-12])
    monkeypatch.setattr(waypoints_and_crowds, "_distance", lambda *_: next(distances))
    path = GroundPath([[0, 0], [0, 1]])
    _, wait, _ = quietly(waypoints_and_crowds._give_way, GRAPH, path, [np.zeros((5, 2))], 0.8)
    assert wait == 0
    assert not list(distances)


def test_who_is_as_far_apart_as_asked_but_for_rounding_gives_no_way(monkeypatch):
    monkeypatch.setattr(waypoints_and_crowds, "_distance", lambda *_: 0.8 - 1e-12)
    monkeypatch.setattr(waypoints_and_crowds, "_give_way", None)  # it is not called
    crowd = walk_crowd(GRAPH, [GroundPath([[0, 0], [0, 1]])] * 2)
    assert crowd.waits == [0.0, 0.0]


@pytest.mark.filterwarnings("ignore:The walk leaves")
def test_what_falls_short_is_told(monkeypatch):
    """Two who start in one place cannot keep apart, whoever waits; it says which, and how near they come."""
    paths = [*CROSSING, GroundPath([[0, 0.1], [0, 6]])]
    tune(monkeypatch, waypoints_and_crowds, crowd_beam=30)
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
