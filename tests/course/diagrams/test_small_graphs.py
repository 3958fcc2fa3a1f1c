"""Small graphs, step by step: which boxes and lines, and what each step of Tarjan's search shows."""

import networkx as nx
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb

from mocap import graphs
from mocap.course.diagrams.small_graphs import (
    BOX,
    EIGHT_PLACES,
    ON_STACK,
    UNSEEN,
    segments_in_rows,
    tarjan_states,
    tarjan_step,
)
from mocap.graphs import Segment
from mocap.plotting.style import SOURCES


@pytest.fixture
def segments():
    """Two clips of three and two segments; nothing follows segment 2."""
    parts = [Segment(0, 0, 200), Segment(0, 200, 400), Segment(0, 400, 650), Segment(1, 0, 200)]
    parts.append(Segment(1, 200, 400))
    graph = nx.DiGraph()
    graph.add_nodes_from((node, part._asdict()) for node, part in enumerate(parts))
    graph.add_edges_from([(0, 1), (1, 2), (3, 4)], kind="clip")
    graph.add_edges_from([(0, 4), (4, 1)], kind="transition")
    return graph


def lines(figure):
    (drawn,) = [c for c in figure.axes[0].collections if isinstance(c, LineCollection)]
    return [(tuple(line[0].round(2)), tuple(line[-1].round(2))) for line in drawn.get_segments()]


def test_each_segment_is_a_box_in_the_row_of_its_clip(segments):
    ax = segments_in_rows(segments, ["a", "b"]).axes[0]
    assert [text.get_text() for text in ax.texts] == ["0", "1", "2", "3", "4"]
    assert [box.get_x() for box in ax.patches] == [0, 1, 2, 0, 1]
    assert len({box.get_facecolor() for box in ax.patches[:3]}) == 1
    assert ax.patches[0].get_facecolor() != ax.patches[3].get_facecolor()
    assert [box.get_linewidth() > 1 for box in ax.patches] == [False, False, True, False, False]


def test_a_transition_leaves_the_end_of_a_box_and_enters_the_start_of_another(segments):
    (leave, enter), (leave_back, enter_back) = lines(segments_in_rows(segments, ["a", "b"]))
    assert leave[0] == BOX
    assert leave[1] > enter[1]  # downwards, from the first clip to the second
    assert enter[0] == pytest.approx(1.1)
    assert leave_back[0] == pytest.approx(1 + BOX)
    assert leave_back[1] < enter_back[1]


def test_one_segment_alone_shows_its_own_transitions(segments):
    assert len(lines(segments_in_rows(segments, ["a", "b"], step=4))) == 1
    assert lines(segments_in_rows(segments, ["a", "b"], step=1)) == []


def faces(figure):
    return {tuple(np.round(face[:3], 6)) for face in figure.axes[0].collections[0].get_facecolors()}


def rgb(*colours):
    return {tuple(np.round(to_rgb(colour), 6)) for colour in colours}


@pytest.mark.parametrize("seed", range(40))
def test_the_last_state_holds_the_strongly_connected_components(seed):
    graph = nx.gnp_random_graph(9, 0.15, seed=seed, directed=True)
    last = tarjan_states({node: list(graph[node]) for node in graph})[-1]
    expected = set(map(frozenset, nx.strongly_connected_components(graph)))
    assert set(map(frozenset, last.components)) == expected
    assert last.stack == []


def test_a_low_link_is_never_above_the_index_nor_below_what_the_stack_holds():
    graph = graphs.notes_example()
    for state in tarjan_states({node: sorted(graph.successors(node)) for node in graph}):
        assert all(state.low[node] <= state.number[node] for node in state.number)
        assert all(state.low[node] >= state.number[state.stack[0]] for node in state.stack)


def test_the_picture_shows_numbers_stack_and_complete_components():
    figure = tarjan_step(graphs.notes_example(), step=15)
    left, right = figure.axes
    assert left.get_title() == "step 15: 8 → 3 closes a cycle"
    assert {"7 / 2", "6 / 6", "2 / 0"} <= {text.get_text() for text in left.texts}
    assert [text.get_text() for text in right.texts] == ["1", "2", "3", "6", "7", "8"]
    assert faces(figure) == rgb(ON_STACK, SOURCES[0], SOURCES[1])
    (thick,) = np.flatnonzero(np.array(left.collections[0].get_linewidths()) > 2)
    assert list(graphs.notes_example())[thick] == 8


def test_at_first_nothing_else_is_seen_and_at_last_the_stack_is_empty():
    assert faces(tarjan_step(graphs.notes_example())) == rgb(ON_STACK, UNSEEN)
    last = tarjan_step(graphs.notes_example(), step=99)
    assert last.axes[1].get_title() == "stack: empty"
    assert faces(last) == rgb(*SOURCES[:3])
    assert last.axes[0].get_title().startswith("step 20:")


def test_each_node_of_the_example_has_a_place_of_its_own():
    assert sorted(EIGHT_PLACES) == sorted(graphs.notes_example())
    assert len(set(EIGHT_PLACES.values())) == 8
