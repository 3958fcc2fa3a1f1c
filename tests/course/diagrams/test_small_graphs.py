"""What nodes and edges are, read back from the artists."""

from itertools import pairwise

import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Annotation

from mocap.course.diagrams import small_graphs
from mocap.plotting.style import MARK, PATH, QUIET, SOURCES


def bars(ax):
    return [line for line in ax.lines if line.get_linewidth() == 9]


def nodes(ax):
    return sorted(
        (-line.get_ydata()[0], line.get_xdata()[0]) for line in ax.lines if line.get_marker() == "o"
    )


def arrows(ax, colour):
    found = [text for text in ax.texts if isinstance(text, Annotation) and text.arrow_patch]
    return [arrow for arrow in found if to_hex(arrow.arrow_patch.get_edgecolor()) == to_hex(colour)]


def drawn(step):
    return small_graphs.nodes_and_edges(step).axes[0]


@pytest.mark.parametrize(("step", "leaps"), [(0, 0), (1, 0), (2, 1), (3, 3), (4, 3)])
def test_each_transition_adds_an_arrow_and_two_nodes(step, leaps):
    ax = drawn(step)
    assert len(arrows(ax, MARK)) == leaps
    assert len(nodes(ax)) == 4 + 2 * leaps
    assert len(bars(ax)) == 2 + 2 * leaps  # each node within a clip cuts it


def test_an_arrow_leads_from_a_node_to_a_node():
    ax = drawn(3)
    for arrow in arrows(ax, MARK):
        for time, row in (arrow.xyann, arrow.xy):
            assert (-row, time) in nodes(ax)


def test_a_match_is_a_window_in_each_clip_of_which_one_ends_where_the_transition_enters():
    windows = [line for line in drawn(1).lines if line.get_color() == MARK]
    assert [line.get_ydata()[0] for line in windows] == [0, -1]
    source, leaves, target, enters = small_graphs.LEAPS[0]
    assert (source, target) == (0, 1)
    assert windows[0].get_xdata()[0] == leaves
    assert windows[1].get_xdata()[1] == pytest.approx(enters)


def test_pruning_removes_what_no_transition_enters_or_leaves():
    pale = {tuple(bar.get_xdata()) for bar in bars(drawn(4)) if bar.get_color() not in SOURCES}
    assert pale == {(0.0, 1.0), (4.8, 6.0), (0.0, 1.4), (3.2, 5.0)}
    ends = [line for line in drawn(4).lines if line.get_markeredgecolor() == QUIET]
    assert len(ends) == 4


def test_each_edge_of_the_walk_begins_where_the_one_before_ends():
    ax = drawn(5)
    assert len(arrows(ax, PATH)) == len(small_graphs.WALK) + len(small_graphs.LEAPS)
    assert {"1", "2", "3", "4"} < {text.get_text() for text in ax.texts}
    ends = [(leap[1], leap[3]) for leap in small_graphs.LEAPS]
    for (_, _, end), (_, start, _) in pairwise(small_graphs.WALK):
        assert (end, start) in ends
