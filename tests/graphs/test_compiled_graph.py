"""A compiled graph says of every edge and hop what the graph itself says."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import AHEAD, compile_graph, walk_track
from mocap.graphs.motion_graph import from_transitions
from mocap.synthesis import random_walk, to_motion
from tests.bundled import sneaking, walking
from tests.refusals import refused
from tests.strategies import wave

GRAPH = walking()


def test_every_edge_is_there_once():
    source = GRAPH.source.graph
    assert sorted(GRAPH.edges) == sorted(source.edges(keys=True))
    for number in range(0, len(GRAPH.edges), 97):
        edge = source.edges[GRAPH.edges[number]]
        assert GRAPH.nodes[GRAPH.target[number]] == GRAPH.edges[number][1]
        assert GRAPH.frames[number] == edge["frames"]
        assert GRAPH.blended[number] == (edge["kind"] == "transition")
        assert GRAPH.cost[number] == edge.get("cost", 0)


def test_the_track_is_the_root_of_the_motion():
    walk = random_walk(GRAPH.source, seconds=60, seed=1, settle=0.2)
    number = {edge: n for n, edge in enumerate(GRAPH.edges)}
    edges = np.array([number[edge] for edge in walk])
    turn, move = np.exp(0.7j), 3 + 4j
    track, rows = walk_track(GRAPH, edges, complex(turn), move)
    motion = to_motion(GRAPH.source, walk, place=PlanarTransform(0.7, 4.0, 3.0))
    assert track == pytest.approx(on_ground(motion.root_positions), abs=1e-9)
    assert np.abs(np.diff(track)) == pytest.approx(GRAPH.step[rows][1:], abs=1e-9)


def test_labels_are_those_of_the_motion():
    graph = sneaking()
    walk = random_walk(graph.source, seconds=60, seed=4)
    number = {edge: n for n, edge in enumerate(graph.edges)}
    _, rows = walk_track(graph, np.array([number[edge] for edge in walk]), 1 + 0j, 0j)
    motion = to_motion(graph.source, walk)
    for label, bears in zip(graph.label_names, graph.bears, strict=True):
        assert np.array_equal(bears[rows], motion.labels.get(label, np.zeros(len(rows), bool)))


def test_hops_are_all_ways_on_from_a_node():
    """Against rides and transitions followed in the graph itself."""
    source = GRAPH.source.graph
    least = np.ceil(GRAPH.fps / 6)

    def ways(node, ridden=0, taken=()):
        leaving = source.out_edges(node, keys=True)
        found = [(*taken, e) for e in leaving if source.edges[e]["kind"] == "transition"]
        for edge in source.out_edges(node, keys=True):
            if source.edges[edge]["kind"] == "clip":
                frames, longer = ridden + source.edges[edge]["frames"], (*taken, edge)
                over = frames >= least or not source.out_degree(edge[1])
                found += [longer] if over else ways(edge[1], frames, longer)
        return found

    for n in range(0, len(GRAPH.nodes), 53):
        of, hops = GRAPH.hops.leaving(np.array([n]))
        assert not of.any()
        told = [GRAPH.hops.edges(np.array([hop])) for hop in hops]
        assert sorted(tuple(GRAPH.edges[e] for e in hop) for hop in told) == sorted(ways(GRAPH.nodes[n]))


def test_a_hop_plays_the_frames_of_its_edges():
    hops = np.arange(0, len(GRAPH.hops.last), 371)
    rows, of = GRAPH.hops.rows(hops)
    assert np.array_equal(np.bincount(of), GRAPH.hops.frames[hops])
    for number, hop in enumerate(hops):
        edges = GRAPH.hops.edges(np.array([hop]))
        _, expected = walk_track(GRAPH, edges, 1 + 0j, 0j)
        assert np.array_equal(rows[of == number], expected)


def test_a_label_has_a_number():
    graph = sneaking()
    assert [graph.label_names[graph.label_number(name)] for name in ("sneak", "walk")] == ["sneak", "walk"]
    assert graph.label_number("") == -1
    refused("bears the label 'fly'; there are: sneak, walk", graph.label_number, "fly", kind=NoWalk)


def test_it_is_compiled_once_and_never_empty():
    assert compile_graph(GRAPH) is GRAPH
    empty = from_transitions([wave(20)], [], window=5)
    empty.graph.remove_edges_from(list(empty.graph.edges))
    refused("no edges", compile_graph, empty, kind=NoWalk)


def test_ahead_of_a_node_the_root_goes_on_as_it_went_past_the_end_too():
    speed = np.array([0.3, 0.0, 1.2])  # x, y, z in metres per second
    glide = replace(wave(50), root_positions=np.arange(50)[:, None] / 40 * speed, fps=40.0)
    graph = compile_graph(from_transitions([glide], [], window=5))
    seconds = np.array([[0.0], [50 / 40]]) + AHEAD  # the clip's start and its end
    assert graph.ahead == pytest.approx(seconds * (1.2 + 0.3j))
    assert graph.going == pytest.approx(np.arctan2(0.3, 1.2))
