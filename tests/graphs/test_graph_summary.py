"""A summary counts what a walk meets; a sweep says what each threshold would build; GraphML holds all."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import given

from mocap.body.planar import IDENTITY
from mocap.graphs.graph_summary import summary, write_graphml
from mocap.graphs.motion_graph import build, from_transitions
from mocap.graphs.pruning import prune
from mocap.matching.transitions import Transition
from tests.refusals import refused
from tests.strategies import ends, wave

CLIPS = [wave(90, name="a"), wave(70, phase=1.0, name="b", seed=1)]
WINDOW = 8
MARK = {"walk": np.arange(90) < 60, "stroll": np.arange(90) > 40}
LABELLED = prune(build([replace(CLIPS[0], labels=MARK), CLIPS[1]], window=WINDOW, threshold=0.05))


@given(ends)
def test_waits_are_those_of_a_walk_along_the_clip(rows):
    found = [Transition(*row, 0.01, IDENTITY) for row in rows]
    graph = from_transitions(CLIPS, found, window=WINDOW)
    waits = []
    for clip, motion in enumerate(CLIPS):
        leaves = [t.leave for t in found if t.source == clip]
        for frame in range(len(motion)):
            waits.append(min((leave - frame for leave in leaves if leave >= frame), default=np.inf))
    told = summary(graph.graph, fps=30.0)
    assert told.frames == len(waits) == 160
    assert told.mean_wait == pytest.approx(np.mean(waits) / 30)
    assert told.worst_wait == pytest.approx(np.max(waits) / 30)


def test_a_pruned_graph_is_told_in_a_few_lines():
    graph = prune(build(CLIPS, window=WINDOW, threshold=0.05))
    told = summary(graph.graph, fps=30.0)
    assert (told.nodes, told.edges) == (len(graph.graph), graph.graph.number_of_edges())
    assert (told.transitions, told.frames) == (graph.count("transition"), graph.frames)
    assert told.seconds == pytest.approx(told.frames / 30)
    assert told.out_degree == pytest.approx(np.mean([degree for _, degree in graph.graph.out_degree()]))
    assert 0 < told.mean_wait < told.worst_wait < 3
    assert [line.split()[0] for line in told.table().splitlines()] == ["frames", "nodes", "edges", "turn-off"]
    whole = summary(build(CLIPS, window=WINDOW, threshold=0.05).graph, fps=30.0)
    assert whole.table().endswith("turn-off     none before the end of some clip")


def test_it_tells_which_labels_can_be_reached():
    clips = [
        replace(clip, labels={label: np.ones(len(clip), bool)})
        for clip, label in zip(CLIPS, ("walk", "run"), strict=True)
    ]
    walk, run = frozenset({"walk"}), frozenset({"run"})
    one_way = from_transitions(clips, [Transition(0, 82, 1, 20, 0.01, IDENTITY)], window=WINDOW)
    assert summary(one_way.graph, fps=30.0).reachable == {walk: {run}, run: set()}
    assert "walk         leads to run" in summary(one_way.graph, fps=30.0).table()
    assert "run          leads to nothing else" in summary(one_way.graph, fps=30.0).table()


def test_graphml_holds_every_node_and_edge(tmp_path):
    path = tmp_path / "graph.graphml"
    write_graphml(LABELLED, path)
    back = nx.read_graphml(path, force_multigraph=True)
    assert len(back) == len(LABELLED.graph)
    assert back.number_of_edges() == LABELLED.graph.number_of_edges()
    for (a, leave), (b, enter), edge in LABELLED.graph.edges(data=True):
        found = back[f"{LABELLED.clips[a].name}:{leave}"][f"{LABELLED.clips[b].name}:{enter}"].values()
        match = next(e for e in found if e["kind"] == edge["kind"])
        assert match["frames"] == edge["frames"]
        if edge["kind"] == "transition":
            assert match["cost"] == edge["cost"]
            assert (match["angle"], match["x"], match["z"]) == edge["transform"]
    assert ET.parse(path).getroot().tag.endswith("graphml")
    refused(r"written as .graphml, got", write_graphml, LABELLED, tmp_path / "graph.xml")
