"""Pictures of graphs, and storyboards, read back from their artists."""

import networkx as nx
import numpy as np
import pytest
from matplotlib.colors import to_rgba

from mocap.body.motion import Motion, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.graphs.motion_graph import build
from mocap.matching.distance_grids import distance_grid
from mocap.plotting import graph_drawing
from mocap.plotting.storyboards import Shot, storyboard
from mocap.plotting.style import COLOURS, SOURCES
from tests.strategies import wave


@pytest.fixture(scope="module")
def graph():
    return build([wave(90, name="a"), wave(70, phase=1, name="b", seed=1)], window=8, threshold=0.05)


def test_the_timeline_has_one_arc_per_transition(graph):
    arcs = graph_drawing.timeline(graph)
    edges = [edge for edge in graph.graph.edges(data="kind") if edge[2] == "transition"]
    expected = {(start[1] / 30, -start[0], end[1] / 30, -end[0]) for start, end, _ in edges}
    assert {(*arc[0].round(9), *arc[-1].round(9)) for arc in arcs.get_segments()} == {
        tuple(np.round(ends, 9)) for ends in expected
    }
    assert [label.get_text() for label in arcs.axes.get_yticklabels()] == ["a", "b"]


def test_only_arcs_within_a_clip_are_bent(graph):
    lines = graph_drawing.timeline(graph).get_segments()
    within = [line[0, 1] == line[-1, 1] for line in lines]
    assert any(within) and not all(within)
    for line, same in zip(lines, within, strict=True):
        straight = np.linspace(line[0], line[-1], len(line))
        assert np.abs(line - straight).max() == pytest.approx(0.45 if same else 0.0)


def test_the_timeline_has_one_bar_per_piece_of_a_clip_in_its_colour(graph):
    bars = graph_drawing.timeline(graph).axes.collections[1]
    lines = bars.get_segments()
    assert len(lines) == graph.count("clip")
    assert sum(bar[1, 0] - bar[0, 0] for bar in lines) * 30 == pytest.approx(graph.frames)
    assert [tuple(c) for c in bars.get_colors()] == [to_rgba(SOURCES[-int(bar[0, 1])]) for bar in lines]


def test_where_arcs_are_many_the_cheapest_are_shown_and_the_rest_counted(graph):
    arcs = graph_drawing.timeline(graph, most=3)
    edges = [e for e in graph.graph.edges(data=True) if e[2]["kind"] == "transition"]
    cheapest = sorted(edges, key=lambda edge: edge[2]["cost"])[:3]
    expected = sorted((start[1] / 30, -start[0]) for start, _, _ in cheapest)
    assert np.array(sorted(tuple(arc[0]) for arc in arcs.get_segments())) == pytest.approx(np.array(expected))
    assert arcs.axes.texts[0].get_text() == f"drawn: the cheapest, 3 of {len(edges)} transitions"
    assert not graph_drawing.timeline(graph).axes.texts


def test_from_each_clip_to_each_the_cheapest_are_shown_with_their_nodes(graph):
    arcs = graph_drawing.timeline(graph, each=2)
    costs = {}
    for start, end, edge in graph.graph.edges(data=True):
        if edge["kind"] == "transition":
            costs.setdefault((start[0], end[0]), []).append((edge["cost"], start[1] / 30, end[1] / 30))
    expected = sorted(times[1:] for found in costs.values() for times in sorted(found)[:2])
    drawn = sorted((arc[0, 0], arc[-1, 0]) for arc in arcs.get_segments())
    assert np.array(drawn) == pytest.approx(np.array(expected))
    leaves, enters = arcs.axes.lines[-2:]
    assert sorted(leaves.get_xdata()) == pytest.approx(sorted(start for start, _ in expected))
    assert sorted(enters.get_xdata()) == pytest.approx(sorted(end for _, end in expected))
    assert "the 2 cheapest from each clip to each clip" in arcs.axes.texts[0].get_text()


def test_a_small_graph_has_one_disc_per_node_and_one_arrow_per_edge():
    graph = nx.DiGraph([(1, 2), (2, 1), (2, 3), (3, 3)])
    places = {1: (0, 0), 2: (1, 0), 3: (1, 1)}
    discs, arrows = graph_drawing.node_link(graph, places=places, kept=graph.subgraph([1, 2]))
    assert discs.get_offsets().tolist() == [[0, 0], [1, 0], [1, 1]]
    assert [text.get_text() for text in discs.axes.texts] == ["1", "2", "3"]
    assert len(arrows) == 4
    assert [arrow.get_linestyle() for arrow in arrows] == ["-", "-", "--", "--"]
    solid = to_rgba(COLOURS["middle"])
    assert [tuple(face) == solid for face in discs.get_facecolors()] == [True, True, False]


@pytest.mark.parametrize("nodes", [0, 101])
def test_node_link_says_where_large_graphs_are_drawn(nodes):
    with pytest.raises(MocapError, match=r"1 to 100 nodes, this one has \d+: `plotting.timeline`"):
        graph_drawing.node_link(nx.empty_graph(nodes, create_using=nx.DiGraph))


WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]
SHOT = Shot(WALKS[0], 56, WALKS[1], 20, 10, 20, 20, lambda ax: ax.plot(0, 0))


def test_the_distance_is_that_of_the_grid():
    assert SHOT.distance == pytest.approx(np.sqrt(distance_grid(*WALKS, window=10)[56, 20]))


@pytest.mark.parametrize("depth", [1, 2, 3, 4])
def test_panels_with_labels(depth):
    show = ["windows", "turn", "weights", "seam"][:depth]
    labels = [ax.get_title(loc="left") for ax in storyboard(SHOT, show).axes]
    assert labels[:2] == ["1  which two windows", "2  aligned, RMS distance 1.9 cm"]
    assert labels[2:] == ["3  the seam; its window is shaded"] * (depth > 2)


def test_a_body_without_legs_is_drawn():
    pair = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    turns = np.tile([1.0, 0, 0, 0], (30, 2, 1))
    pole = Motion(pair, np.linspace(0, [0, 1, 2], 30), turns, 30.0, "pole")
    shot = Shot(pole, 0, pole, 5, 2, 0, 0, lambda ax: None)
    assert len(storyboard(shot, ["windows", "turn", "weights"]).axes) == 3
