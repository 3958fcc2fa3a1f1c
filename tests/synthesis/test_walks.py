"""Walks as arrays say what walks as lists say."""

import pytest

from mocap.errors import NoWalk
from mocap.graphs.edge_tables import edge_table, frame_table, require_node
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.synthesis.random_walks import random_walk
from tests.strategies import wave

WINDOW = 8
GRAPH = prune(
    build([wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)], window=WINDOW, threshold=0.05)
)


def test_every_frame_is_told_as_the_edges_tell_it():
    walk = random_walk(GRAPH, seconds=20, seed=3, settle=0.0)
    table = frame_table(edge_table(GRAPH, walk), WINDOW)
    frame = 0
    for start, end, key in walk:
        edge = GRAPH.graph.edges[start, end, key]
        for step in range(edge["frames"]):
            assert table.here[frame].tolist() == [start[0], start[1] + step]
            assert table.there[frame].tolist() == [end[0], end[1] - edge["frames"] + step]
            assert (table.alpha[frame] < 1) == (edge["kind"] == "transition")
            frame += 1
    assert frame == len(table.edge)


def test_a_node_that_is_not_there_is_told_with_the_nearest():
    with pytest.raises(NoWalk, match=r"no node \(0, 999\); the nearest is \(0, "):
        require_node(GRAPH, (0, 999))
    with pytest.raises(NoWalk, match="none in that clip"):
        require_node(GRAPH, (9, 0))
