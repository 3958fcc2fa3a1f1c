"""The diagrams of graphs and of searches show what these do, and they find components and the best walks."""

from functools import cache, partial
from itertools import pairwise, product

import networkx as nx
import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb
from matplotlib.text import Annotation

from mocap import graphs
from mocap.body import GroundPath
from mocap.course.diagrams import small_graphs
from mocap.course.diagrams.branching import (
    FATES,
    edge_lengths,
    from_above,
    laid_in_turn,
    search_events,
    search_steps,
)
from mocap.course.diagrams.layers import PROGRAM as LAYER_PROGRAM
from mocap.course.diagrams.layers import STRIDE, TURNS, Steps, layer_states, layer_steps, lengthened
from mocap.course.diagrams.small_graphs import (
    ON_STACK,
    PROGRAM,
    UNSEEN,
    eight_node_graph,
    tarjan_states,
    tarjan_steps,
)
from mocap.plotting.style import MARK, PATH, QUIET, SOURCES

EIGHT = graphs.notes_example()
STATES = tarjan_states({node: sorted(EIGHT.successors(node)) for node in sorted(EIGHT)})
LENGTHS = edge_lengths(EIGHT)


TARJAN, SEARCH = cache(partial(tarjan_steps, EIGHT)), cache(partial(search_steps, EIGHT, 6, 2))


def at(step):
    return TARJAN()(step)[0].figure


def faces(figure):
    return {tuple(np.round(face[:3], 6)) for face in figure.axes[0].collections[0].get_facecolors()}


def rgb(*colours):
    return {tuple(np.round(to_rgb(colour), 6)) for colour in colours}


@pytest.mark.parametrize("seed", range(10))
def test_the_last_state_holds_the_strongly_connected_components(seed):
    graph = nx.gnp_random_graph(9, 0.15, seed=seed, directed=True)
    last = tarjan_states({node: list(graph[node]) for node in graph})[-1]
    expected = set(map(frozenset, nx.strongly_connected_components(graph)))
    assert set(map(frozenset, last.components)) == expected
    assert last.stack == []


def test_the_picture_shows_numbers_stack_and_complete_components():
    figure = at(16)
    left, right, _ = figure.axes
    assert left.get_title() == "step 16: 8 → 3 closes a cycle"
    assert {"7 / 2", "6 / 6", "2 / 0"} <= {text.get_text() for text in left.texts}
    assert [text.get_text() for text in right.texts if text.get_text()] == ["1", "2", "3", "6", "7", "8"]
    assert faces(figure) == rgb(ON_STACK, SOURCES[0], SOURCES[1])
    (thick,) = np.flatnonzero(np.array(left.collections[0].get_linewidths()) > 2)
    assert list(EIGHT)[thick] == 8


def test_the_line_that_has_just_run_is_marked():
    """The line is that of the case: a new successor, one on the stack, one that has left it, or none."""
    words = {1: "enter", 4: "back in", 6: "closes", 8: "has left", 10: "is the first"}
    assert len(STATES) == 22
    for step, state in enumerate(STATES):
        _, _, code = at(step).axes
        (mark,) = code.patches
        assert mark.get_y() + mark.get_height() / 2 == state.line
        assert words[state.line] in state.message
        assert [text.get_text() for text in code.texts] == PROGRAM


def test_edges_are_thick_words_stand_beside_nodes_and_parts_have_colours():
    ax = eight_node_graph(EIGHT, beside={1: "one"}, thick=[(3, 1)], parts=[{4}, {5}])
    assert [patch.get_linewidth() for patch in ax.patches].count(3) == 1
    assert "one" in names_in(ax)
    assert faces(ax.figure) == rgb(UNSEEN, SOURCES[0], SOURCES[1])


def test_at_first_nothing_else_is_seen_and_at_last_the_stack_is_empty():
    assert faces(at(0)) == rgb(ON_STACK, UNSEEN)
    last = at(99)
    assert last.axes[1].get_title() == "empty"
    assert faces(last) == rgb(*SOURCES[:3])
    assert last.axes[0].get_title().startswith("step 21:")


def names_in(ax):
    return [text.get_text() for text in ax.texts]


def test_the_search_finds_the_walk_of_the_notes():
    events = search_events(LENGTHS, 6, 2, longest=8)
    (found,) = [event for event in events if event.fate == "complete"]
    assert found.walk == (6, 7, 8, 3, 1, 2)
    assert found.cost == pytest.approx(sum(LENGTHS[a][b] for a, b in pairwise(found.walk)))
    taken = [event.walk for event in events]
    assert taken.index((6, 7, 8, 3, 4)) < taken.index((6, 7, 8, 3, 1))  # into the sink first
    assert len(max(taken, key=len)) == 9


@pytest.mark.parametrize("seed", range(8))
def test_it_finds_what_an_exhaustive_search_finds(seed):
    rng = np.random.default_rng(seed)
    lengths = {
        a: {int(b): float(rng.uniform(0.1, 1)) for b in rng.choice(6, 2, replace=False)} for a in range(6)
    }
    events = search_events(lengths, 0, 5, longest=5)
    whole = nx.DiGraph([(a, b, {"weight": w}) for a, row in lengths.items() for b, w in row.items()])
    complete = [event.cost for event in events if event.fate == "complete"]
    if 5 in whole and nx.has_path(whole, 0, 5):
        assert min(complete) == pytest.approx(nx.shortest_path_length(whole, 0, 5, weight="weight"))
    else:
        assert not complete
    assert complete == sorted(complete, reverse=True)


@pytest.mark.parametrize("step", [0, 1, 4, 9, 99])
def test_the_tree_shows_each_walk_met_so_far(step):
    events = search_events(LENGTHS, 6, 2, longest=8)
    shown = events[:step]
    left, right = SEARCH()(step)[0].figure.axes
    met = {walk for event in shown for _, walk in event.added} | {event.walk for event in shown}
    assert sorted(text.get_text() for text in right.texts if text.get_visible()) == sorted(
        str(walk[-1]) for walk in met
    )
    edges = [line for line in right.lines if line.get_visible() and np.ptp(line.get_ydata()) == 1]
    assert len(edges) == sum(len(walk) > 1 for walk in met)
    complete = any(event.fate == "complete" for event in shown)
    assert left.get_title().startswith("best so far") == complete
    assert {text.get_text() for text in right.get_legend().get_texts()} == set(FATES)


def test_the_best_walk_is_marked_in_the_graph_and_the_lengths_stand_beside_the_edges():
    left, _ = SEARCH()(99)[0].figure.axes
    thick = [patch for patch in left.patches if patch.get_linewidth() == 3]
    assert len(thick) == 5
    lengths = [length for row in LENGTHS.values() for length in row.values()]
    assert {f"{length:.1f}" for length in lengths} <= set(names_in(left))


def test_a_walk_from_above_lies_over_what_was_tried_and_left_is_left():
    """A point z + ix is drawn at x to the left and z up."""
    ax = from_above([np.array([0, 1 + 2j])], tried=[np.array([0, 1]), np.array([0, 1j])], goal=3j)
    tried, walk = ax.collections
    assert len(tried.get_segments()) == 2
    assert walk.get_segments()[0].tolist() == [[0, 0], [2, 1]]
    assert ax.lines[0].get_xydata().tolist() == [[3, 0]]
    assert ax.xaxis.get_inverted()


def test_pieces_laid_by_the_product_of_all_transforms_make_one_line():
    """A clip of three frames is left after two of them, by a transition that turns left, and entered anew."""
    graph, a, b = nx.MultiDiGraph(), ((0, 0), (0, 2), 0), ((0, 2), (0, 0), 0)
    graph.add_edge(*a, lay=(1, 0))
    graph.add_edge(*b, lay=(1j, 2 + 0j))
    tracks = {a: np.array([0, 1, 2]), b: np.array([2, 2 + 0.01j])}

    def product_of(rows):
        turn, move = 1, 0
        for angle, x, z in rows:
            turn, move = turn * np.exp(1j * angle), move + turn * (z + 1j * x)
        return np.angle(turn), move.imag, move.real

    figure = laid_in_turn(graph, [a, b, a, b, a], tracks, product_of)
    assert [len(ax.collections[0].get_segments()) for ax in figure.axes] == [3, 2, 1]
    assert [ax.get_title() for ax in figure.axes] == [
        "as captured",
        "by the last transform",
        "by the product",
    ]


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


LINE = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(STRIDE * np.arange(8)) @ [1j, 1]


def every_walk(line, count):
    for turns in product(TURNS, repeat=count):
        walk = Steps((0j,), 0.0, 0.0)
        for turn in turns:
            walk = lengthened(walk, turn, line)
        yield walk


@pytest.mark.parametrize("seed", range(5))
def test_a_beam_that_holds_all_walks_finds_the_best_of_all(seed):
    line = np.cumsum(0.7 * np.exp(1j * np.random.default_rng(seed).normal(size=6).cumsum()))
    best = min(walk.cost for walk in every_walk(line, 4))
    for look in (False, True):
        assert [*layer_states(line, 4, width=99, look=look)][-1].best.cost == pytest.approx(best)


def test_the_look_ahead_needs_a_narrower_beam():
    def narrowest(look):
        costs = [[*layer_states(LINE, 5, width=width, look=look)][-1].best.cost for width in range(1, 10)]
        return 1 + costs.index(min(costs))

    assert (narrowest(True), narrowest(False)) == (2, 6)


def test_of_walks_that_stand_alike_the_best_stays_and_no_more_than_the_beam_go_on():
    for state in layer_states(LINE, 5, width=4):
        ends = [(np.round(walk.places[-1], 6), round(walk.heading, 6)) for walk in state.kept]
        if state.line in (5, 6):
            assert len(set(ends)) == len(ends)
            assert all(
                any(
                    abs(walk.places[-1] - other.places[-1]) < 1e-6 and state.score[other] <= state.score[walk]
                    for other in state.kept
                )
                for walk in (state.crossed if state.line == 5 else ())
            )
        assert state.line != 6 or len(state.kept) <= 4


def test_the_line_that_ran_is_marked_and_crossed_walks_are_drawn():
    figure = layer_steps(LINE, 5)(18, 4, True)[0].figure
    ground, code = figure.axes
    assert [text.get_text() for text in code.texts] == LAYER_PROGRAM
    marked = code.patches[0].get_extents().transformed(code.transData.inverted())
    assert (marked.y0 + marked.y1) / 2 == pytest.approx(
        LAYER_PROGRAM.index("    kept = the K best of apart, by score")
    )
    (crosses,) = (line for line in ground.lines if line.get_marker() == "x")
    ends = [walk.places[-1] for walk in [*layer_states(LINE, 5)][18].crossed]
    assert crosses.get_xydata()[crosses.get_markevery()] @ [1j, 1] == pytest.approx(ends)
    assert len(ends) > 0
