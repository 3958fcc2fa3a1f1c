"""Merging moves transitions in one direction only, keeps every one of them, and tells its costs true."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.graphs.components import reached
from mocap.graphs.motion_graph import build, from_transitions, merge_choice_points
from mocap.graphs.pruning import prune
from mocap.matching.point_clouds import align, point_cloud
from mocap.matching.transitions import Transition
from tests.refusals import refused
from tests.strategies import wave

CLIPS = [wave(90, name="a"), wave(70, phase=1.0, name="b", seed=1)]
WINDOW = 8


def transitions_of(motion_graph):
    rows = motion_graph.graph.edges(data=True)
    return [(a, b, edge) for a, b, edge in rows if edge["kind"] == "transition"]


@pytest.fixture(scope="module")
def graphs():
    whole = build(CLIPS, window=WINDOW, threshold=0.06)
    return whole, merge_choice_points(whole, within=4, threshold=0.06)


def test_there_are_fewer_nodes_and_no_fewer_frames(graphs):
    whole, merged = graphs
    assert merged.graph.number_of_nodes() < whole.graph.number_of_nodes()
    assert prune(merged).frames >= prune(whole).frames


def test_every_transition_has_its_counterpart(graphs):
    whole, merged = graphs
    found = [(a, b) for a, b, _ in transitions_of(merged)]
    for (source, leave), (target, enter), _ in transitions_of(whole):
        assert any(
            (a[0], b[0]) == (source, target) and leave <= a[1] <= leave + 4 and enter - 4 <= b[1] <= enter
            for a, b in found
        )


def test_costs_are_measured_anew(graphs):
    clouds = [point_cloud(clip) for clip in CLIPS]
    for (source, leave), (target, enter), edge in transitions_of(graphs[1]):
        a = clouds[source][leave : leave + WINDOW].reshape(-1, 3)
        b = clouds[target][enter - WINDOW : enter].reshape(-1, 3)
        best = align(a, b)
        np.testing.assert_allclose(edge["transform"], best, atol=1e-5)
        rms = np.sqrt(((a - PlanarTransform(*best).apply_points(b)) ** 2).sum(-1).mean())
        assert edge["cost"] == pytest.approx(rms, abs=2e-6)
        assert edge["cost"] < 0.06


def test_within_no_frames_nothing_changes(graphs):
    whole, _ = graphs
    same = merge_choice_points(whole, within=0, threshold=0.06)
    assert nx.utils.graphs_equal(whole.graph, same.graph)


@given(
    st.lists(
        st.tuples(st.integers(0, 1), st.integers(0, 62), st.integers(0, 1), st.integers(0, 62)), max_size=9
    ),
    st.integers(0, 12),
    st.sampled_from([0.05, 0.2, 1.0]),
)
def test_what_was_reached_still_is(rows, within, threshold):
    found = [Transition(*row, 0.01, IDENTITY) for row in rows]
    whole = from_transitions(CLIPS, found, window=WINDOW)
    merged = merge_choice_points(whole, within=within, threshold=threshold)
    for clip, motion in enumerate(CLIPS):  # from the start of a clip, the ends of the same clips
        ends = {(other, len(m)) for other, m in enumerate(CLIPS)}
        before, after = (reached(graph.graph, [(clip, 0)]) & ends for graph in (whole, merged))
        assert before <= after
        assert (clip, len(motion)) in after
    for _, (_, enter), edge in transitions_of(merged):
        assert enter >= WINDOW
        assert edge["cost"] < max(threshold, 0.02)


def test_a_threshold_is_a_distance(graphs):
    for threshold in (0, -1, np.nan):
        refused("above 0 m", merge_choice_points, graphs[0], within=4, threshold=threshold)
