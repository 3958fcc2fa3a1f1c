"""One's own motion graph against the package's: with the package's functions in all places they are one."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

import mocap
from mocap import body, datasets, graphs, matching, synthesis
from mocap.blending.weights import cubic_weights
from mocap.course.lab import own
from mocap.course.lab.own import building, walking
from mocap.course.lab.own.building import find_matches, joint_cloud, packages, window_distances
from mocap.errors import MocapError, NoWalk
from mocap.graphs import compile_graph
from mocap.steering.paper_search import PathCost
from mocap.steering.path_objective import Wishes, make_route
from mocap.synthesis.ground_walks import Stand

WINDOW, THRESHOLD = 10, 0.05
PATH = body.arcs((0, 0), heading=0.0, pieces=[(2.0, 1.0), (2.0, -1.0)])


def replaced(some, by):
    return SimpleNamespace(**vars(some) | by)


@pytest.fixture(scope="module")
def clips():
    names = "walk_straight", "walk_curve_2"
    straight, curve = (mocap.resample(datasets.sample(name), 30) for name in names)
    return [straight[:150], curve[100:400]]


@pytest.fixture(scope="module")
def by():
    return packages()


@pytest.fixture(scope="module")
def graph(clips, by):
    return own.build_own(clips, WINDOW, THRESHOLD, by)


@pytest.fixture(scope="module")
def cubic(by):
    """The weights of the paper in place of the exercise's, which the package blends with."""
    return replaced(by, {"quintic": cubic_weights})


@pytest.fixture(scope="module")
def cubic_graph(clips, cubic):
    return own.build_own(clips, WINDOW, THRESHOLD, cubic)


@pytest.fixture(scope="module")
def theirs(clips, by):
    """The package's graph with the transitions of one's own: those on the borders of grids are missing."""
    clouds = [matching.point_cloud(clip) for clip in clips]
    found = {tuple(match)[:4] for match in find_matches(clouds, WINDOW, THRESHOLD, by)}
    all_found = matching.find_transitions(clips, window=WINDOW, below=THRESHOLD)
    kept = [t for t in all_found if (t.source, t.leave, t.target, t.enter) in found]
    return graphs.prune(graphs.from_transitions(clips, kept, window=WINDOW))


def test_climbing_gives_the_points_of_the_package(clips, by):
    assert np.allclose(joint_cloud(clips[0][:9], by), matching.point_cloud(clips[0][:9]), atol=1e-12)


def test_the_grid_is_the_packages(clips, by):
    clouds = [matching.point_cloud(clip) for clip in clips]
    ours = window_distances(*clouds, WINDOW, by)
    assert np.allclose(ours, matching.distance_grid(*clouds, window=WINDOW), atol=1e-12)
    moved = [cloud + np.array([300.0, 0, -200.0]) for cloud in clouds]
    assert np.allclose(window_distances(*moved, WINDOW, by), ours, atol=1e-9)


def test_transitions_are_the_packages_but_for_those_on_the_borders_of_grids(clips, by):
    ours = find_matches([matching.point_cloud(clip) for clip in clips], WINDOW, THRESHOLD, by)
    theirs = {tuple(t)[:4]: t for t in matching.find_transitions(clips, window=WINDOW, below=THRESHOLD)}
    assert {tuple(match)[:4] for match in ours} <= {*theirs}
    for missing in {*theirs} - {tuple(match)[:4] for match in ours}:
        source, leave, target, enter = missing
        ends = [len(clips[clip]) - WINDOW for clip in (source, target)]
        assert leave in (0, ends[0]) or enter in (0, ends[1])
    for match in ours:
        there = theirs[tuple(match)[:4]]
        assert match.cost == pytest.approx(there.cost, abs=1e-9)
        turn = np.exp(1j * (match.transform.angle - there.transform.angle))
        assert abs(turn - 1) < 1e-9
        assert match.transform[1:] == pytest.approx(there.transform[1:], abs=1e-9)


def test_nodes_and_edges_are_the_packages(graph, theirs):
    ours = {
        (edge.start, edge.end, "transition" if edge.match else "clip", len(edge.track) - 1)
        for edges in graph.edges.values()
        for edge in edges
    }
    edges = theirs.graph.edges(data=True)
    assert ours == {(start, end, data["kind"], data["frames"]) for start, end, data in edges}
    assert {*graph.edges} == {*theirs.graph}
    assert (
        repr(graph)
        == f"OwnGraph(2 clips, {len(theirs.graph)} nodes, {theirs.count('transition')} transitions)"
    )


@pytest.fixture(scope="module")
def walk(graph, by):
    return own.follow_own(graph, PATH.points, by)


def keys(walk, theirs):
    """Give a walk as the package's edges: of two edges between the same nodes the one of the same kind."""
    found = []
    for edge in walk.edges:
        kind = "transition" if edge.match else "clip"
        between = theirs.graph.get_edge_data(edge.start, edge.end)
        found.append(
            (edge.start, edge.end, next(key for key, data in between.items() if data["kind"] == kind))
        )
    return found


def test_with_the_same_weights_the_walk_is_the_packages_motion(graph, theirs, walk, by, cubic):
    place = body.PlanarTransform.from_complex(walk.turn, walk.move)
    package = synthesis.to_motion(theirs, keys(walk, theirs), place=place)
    ours = own.play_own(graph, walk, cubic)
    assert np.allclose(ours.root_positions, package.root_positions, atol=1e-9)
    dots = np.abs((ours.rotations * package.rotations).sum(-1))
    assert dots.min() > 1 - 1e-12
    quintic = own.play_own(graph, walk, by)  # the exercise's weights: other poses within the windows alone
    assert 1e-4 < np.abs(quintic.root_positions - package.root_positions).max() < 0.02


def test_what_a_walk_costs_is_eq_9_and_a_price_for_each_seam(cubic_graph, theirs, cubic):
    """On a straight line, which the package's evenly spaced points do not change."""
    line = body.GroundPath([[0, 0], [0.6, 2]])
    walk = own.follow_own(cubic_graph, line.points, cubic, seam=0.2)
    compiled = compile_graph(theirs)
    cost = PathCost(compiled, make_route(compiled, line, Wishes()))
    state, total = Stand(walk.turn, walk.move), 0.0
    for key in keys(walk, theirs):
        more, state = cost.cost(state, key)
        total += more
    seams = sum(edge.match is not None for edge in walk.edges)
    assert walk.cost == pytest.approx(total + 0.2 * seams, rel=1e-9)
    assert cost.done(state)


def test_the_walk_stays_on_its_path(graph, walk, by):
    ground = own.play_own(graph, walk, by).root_positions[:, None, [0, 2]]
    off = np.linalg.norm(ground - PATH.points, axis=-1).min(axis=1)
    assert off.mean() < 0.06
    assert off.max() < 0.2


def test_a_wide_beam_that_merges_nothing_finds_the_cheapest_walk_of_all(
    cubic_graph, theirs, cubic, monkeypatch
):
    monkeypatch.setattr(walking, "PLACE", 1e-6)
    monkeypatch.setattr(walking, "TURN", 1e-6)
    line = body.GroundPath([[0, 0], [0, 0.5]])
    found = own.follow_own(cubic_graph, line.points, cubic, width=10**6, seam=0.0)
    compiled = compile_graph(theirs)
    cost = PathCost(compiled, make_route(compiled, line, Wishes()))
    problem = synthesis.Problem(theirs.graph, cost.cost, cost.done)
    best = min(
        synthesis.branch_and_bound(problem, start.node, Stand(start.turn, start.move)).cost
        for start in walking.starts(cubic_graph, line, cubic)
    )
    assert found.cost == pytest.approx(best, rel=1e-9)


def test_a_steered_walk_takes_the_edges_that_were_chosen_and_knows_where_they_would_lead(graph, by):
    asked = []

    def last(turn, tracks, heading, speed, fps):
        asked.append((turn, len(tracks), tracks[0][0], heading))
        return len(tracks) - 1

    command = {True: (0.5, 1.0), False: (-0.5, 1.0)}
    walk = own.steer_own(graph, lambda second: command[second < 1], 2.0, replaced(by, {"next_edge": last}))
    assert all(there.start == here.end for here, there in pairwise(walk.edges))
    assert [graph.edges[edge.start][-1] is edge for edge in walk.edges] == [True] * len(asked)
    assert {asked[0][3], asked[-1][3]} == {0.5, -0.5}
    assert asked[-1][0] == pytest.approx(np.prod([edge.turn for edge in walk.edges[:-1]]))
    assert 60 <= sum(len(edge.track) - 1 for edge in walk.edges) < 90


@pytest.mark.exhaustive
def test_commands_are_obeyed_better_than_by_chance(by, monkeypatch):
    monkeypatch.setattr(building, "joint_cloud", lambda clip, by: matching.point_cloud(clip))
    straight, circle = (
        mocap.resample(datasets.sample(f"walk_{name}"), 30) for name in ("straight", "circle")
    )
    graph = own.build_own([straight, circle[350:750]], WINDOW, THRESHOLD, by)
    rng = np.random.default_rng(0)
    chance = replaced(by, {"next_edge": lambda turn, tracks, *command: rng.integers(len(tracks))})

    def off(heading, tools):
        walk = own.steer_own(graph, lambda second: (heading, 1.2), 12.0, tools)
        ground = own.play_own(graph, walk, by).root_positions[:, [2, 0]] @ [1, 1j]
        steps = np.diff(ground[120:360:15])  # from four seconds after the command on
        return np.abs(np.angle(steps / np.exp(1j * heading))).mean()

    headings = [-3.0, -1.5, 0.0, 1.5, 3.0]
    obeyed, random = (np.mean([off(heading, tools) for heading in headings]) for tools in (by, chance))
    assert obeyed < np.radians(30)
    assert obeyed < random / 3


def test_a_threshold_that_leaves_no_loop_is_refused(clips, by):
    with pytest.raises(MocapError, match=r"below 0.001 m: allow more\.$"):
        own.build_own([clips[0][:40]], WINDOW, 0.001, by)


def test_clips_that_hold_no_window_are_refused(clips, by):
    for some, window in (([], WINDOW), ([clips[0], clips[0][: WINDOW - 1]], WINDOW), (clips, 0), (clips, 1)):
        with pytest.raises(MocapError, match=f"a window of 2 frames up to the shortest, got {window}"):
            own.build_own(some, window, 0.05, by)
    with pytest.raises(MocapError, match="resample one first"):
        own.build_own([clips[0], mocap.resample(clips[0], 10)], WINDOW, 0.05, by)


def test_a_path_that_no_walk_reaches_is_refused(graph, by):
    nowhere = replace(graph, edges={node: [] for node in graph.edges})
    with pytest.raises(NoWalk, match=r"No walk of this graph reaches the end of a path of 3\.0 m"):
        own.follow_own(nowhere, [[0, 0], [0, 3]], by)
