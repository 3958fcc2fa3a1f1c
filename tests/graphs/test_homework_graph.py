"""The homework's numbers to the last digit told, and its walks without its slips."""

from dataclasses import replace
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mocap
from mocap.editing.retiming import at_frames
from mocap.errors import NoWalk
from mocap.graphs import homework_graph as hw3
from mocap.matching.distance_grids import distance_grid
from mocap.matching.other_metrics import euler_grid, root_grid
from tests.refusals import refusals
from tests.strategies import wave

CLIPS = [wave(90, name="a"), wave(75, phase=1.0, name="b", seed=1), wave(60, phase=2.0, name="c", seed=2)]


def small(**settings):
    return hw3.segment_graph(CLIPS, 20, 6, **{"threshold": 0.5, "metric": root_grid} | settings)


@pytest.fixture(scope="module")
def homework(real_data):
    names = ["walk_fwd_circle", "walk_fwd_curve1", "walk_fwd_curve2"]
    return [mocap.load(real_data / f"hw3/{name}.AMC") for name in names]


@pytest.fixture(scope="module")
def homework_grid(homework):
    return hw3.segment_distances(homework)


@pytest.fixture(scope="module")
def homework_graph(homework, homework_grid):
    graph = hw3.connect(hw3.segments(homework, 200), homework_grid, 185, "distance")
    graph.graph["window"] = 50
    return graph


@given(st.integers(1, 3000), st.integers(1, 500))
def test_segments_take_every_frame_once(frames, length):
    cuts = hw3.segments([range(7), range(frames)], length)[max(7 // length, 1) :]
    assert [n for cut in cuts for n in range(cut.start, cut.end)] == list(range(frames))
    assert len(cuts) == max(frames // length, 1)
    assert all(cut.clip == 1 for cut in cuts)
    assert all(cut.end - cut.start == length for cut in cuts[:-1])


@pytest.mark.parametrize("metric", [root_grid, distance_grid])
def test_segment_distances_lay_heads_on_tails(metric):
    a, b = wave(25), wave(20, phase=1.0, name="b", seed=1)
    grid = hw3.segment_distances([a, b], segment=10, window=4, metric=metric)
    pieces = [a[:10], a[10:], b[:10], b[10:]]
    assert grid.shape == (4, 4)
    for i, j in np.ndindex(4, 4):
        assert grid[i, j] == pytest.approx(metric(pieces[i][-4:], pieces[j][:4], window=4)[0, 0], abs=1e-6)


def test_the_homeworks_numbers(homework_grid):
    grid = homework_grid
    assert grid.shape == (74, 74)
    assert grid[0, 1:6] == pytest.approx([609.7033, 532.5454, 168.3574, 599.2567, 624.7405], abs=1e-3)
    off = grid[~np.eye(74, dtype=bool)]
    assert np.median(off) == pytest.approx(473.735, abs=1e-3)
    assert grid.max() == pytest.approx(786.775, abs=1e-3)
    assert off.min() == pytest.approx(87.407, abs=1e-3)
    assert grid[36, 27] == off.min()


def test_the_homeworks_graph(homework_graph):
    assert (homework_graph.number_of_nodes(), homework_graph.number_of_edges()) == (74, 164)
    assert [node for node in homework_graph if not homework_graph.has_edge(node, node + 1)] == [25, 49, 73]
    for here, following in homework_graph.adjacency():
        shared = [e for e in following.values() if e["kind"] == "transition"]
        half = 0.5 if homework_graph.has_edge(here, here + 1) and shared else 1.0
        for edge in shared:
            total = sum(e["cost"] for e in shared)
            assert edge["probability"] == pytest.approx(half * edge["cost"] / total)


def test_a_long_homework_walk(homework, homework_graph):
    core = max(nx.strongly_connected_components(homework_graph), key=len)
    graph = homework_graph.subgraph(core)
    walk = [min(core), *nx.shortest_path(graph, min(core), max(core))[1:]]
    motion = hw3.segment_motion(homework, homework_graph, walk)
    steps = np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=-1)
    usual = (np.linalg.norm(np.diff(clip.root_positions, axis=0), axis=-1).max() for clip in homework)
    assert steps.max() < 2 * max(usual)


@pytest.mark.parametrize("weighting", ["inverse", "distance"])
def test_probabilities_add_up_also_where_the_distance_is_0(weighting):
    still = at_frames(CLIPS[0], np.zeros(90))
    twins = [still, replace(still, name="twin")]
    same = hw3.segment_graph(twins, 20, 6, 1e-3, weighting, metric=root_grid)
    for graph in (small(weighting=weighting), same):
        assert any(kind == "transition" for _, _, kind in graph.edges(data="kind"))
        for _, following in graph.adjacency():
            assert not following or sum(e["probability"] for e in following.values()) == pytest.approx(1)
            edges = [e for e in following.values() if e["kind"] == "transition"]
            sign = -1 if weighting == "inverse" else 1  # the better match is likelier, but for the slip
            by_cost = sorted(edges, key=lambda e: sign * e["cost"])
            assert [e["probability"] for e in by_cost] == sorted(e["probability"] for e in edges)


def test_successors_are_the_clip_bit_for_bit():
    graph = small()
    motion = hw3.segment_motion(CLIPS, graph, [0, 1, 2, 3])
    walk = hw3.segment_walk(graph, 3, seed=4)
    assert walk == hw3.segment_walk(graph, 3, seed=4)
    assert all(graph.has_edge(*pair) for pair in pairwise(walk))
    np.testing.assert_array_equal(motion.rotations, CLIPS[0].rotations)
    np.testing.assert_array_equal(motion.root_positions, CLIPS[0].root_positions)


def test_a_transition_goes_from_one_segment_to_the_other_and_on_without_a_stutter():
    graph = small()
    kinds = graph.edges(data="kind")
    here, there = next((a, b) for a, b, k in kinds if k == "transition" and b + 1 in graph[b])
    motion = hw3.segment_motion(CLIPS, graph, [here, there, there + 1])
    nodes = (graph.nodes[i] for i in (here, there, there + 1))
    parts = [CLIPS[n["clip"]][n["start"] : n["end"]] for n in nodes]
    leave = len(parts[0]) - 6
    assert len(motion) == sum(map(len, parts)) - 6
    np.testing.assert_array_equal(motion.rotations[:leave], parts[0].rotations[:leave])
    np.testing.assert_allclose(motion.rotations[leave], parts[0].rotations[leave], atol=1e-12)
    np.testing.assert_allclose(motion.root_positions[leave], parts[0].root_positions[leave], atol=1e-12)
    rest = motion[leave + 6 :]
    source = np.concatenate([parts[1].root_positions[6:], parts[2].root_positions])
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(rest.root_positions, axis=0), axis=-1),
        np.linalg.norm(np.diff(source, axis=0), axis=-1),
        atol=1e-12,
    )
    np.testing.assert_allclose(rest.root_positions[:, 1], source[:, 1], atol=1e-12)


def lonely():
    return hw3.segment_graph(CLIPS[:1], 20, 6, metric=root_grid)


test_bad_input_is_named = refusals(
    (
        "of 'wave' has 5 frames, too few for a window of 6",
        lambda: hw3.segment_distances([wave(20)], segment=5, window=6),
    ),
    (
        "of 'wave' has 4 frames, too few for a window of 5",
        lambda: hw3.segment_distances([wave(4)], segment=10, window=5),
    ),
    ("one clip or more, got none", hw3.segment_distances, []),
    ("no bone with a weight", lambda: small(metric=euler_grid)),
    ("above 0, got 0", lambda: small(threshold=0)),
    ("above 0, got nan", lambda: small(threshold=np.nan)),
    ("not 'equal'", lambda: small(weighting="equal")),
    ("too short for windows of 10", lambda: hw3.segment_graph(CLIPS, 20, 10, metric=root_grid)),
    (NoWalk, "Nothing follows segment 3", lambda: hw3.segment_walk(lonely(), 9)),
    (NoWalk, "no segment 99", lambda: hw3.segment_walk(lonely(), 9, start=99)),
    ("at least one segment", lambda: hw3.segment_walk(lonely(), 0)),
    (NoWalk, "no segment", lambda: hw3.segment_motion(CLIPS, lonely(), [])),
    (NoWalk, "jumps from segment 0 to segment 2", lambda: hw3.segment_motion(CLIPS, lonely(), [0, 2])),
)
