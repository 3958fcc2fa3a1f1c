"""The diagram of a search shows what the search does, and the search finds the shortest walk."""

from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

from mocap import graphs
from mocap.course.diagrams.eight_node_search import FATES, edge_lengths, search_events, search_steps

EIGHT = graphs.notes_example()
LENGTHS = edge_lengths(EIGHT)


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


@pytest.mark.parametrize("seed", range(20))
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


@pytest.mark.parametrize("step", [0, 1, 4, 9, None])
def test_the_tree_shows_each_walk_met_so_far(step):
    events = search_events(LENGTHS, 6, 2, longest=8)
    shown = events[:step]
    figure = search_steps(EIGHT, 6, 2, step=step)
    left, right = figure.axes
    met = {walk for event in shown for _, walk in event.added} | {event.walk for event in shown}
    assert sorted(names_in(right)) == sorted(str(walk[-1]) for walk in met)
    edges = [line for line in right.lines if len(line.get_xdata()) == 2]
    assert len(edges) == sum(len(walk) > 1 for walk in met)
    complete = any(event.fate == "complete" for event in shown)
    assert left.get_title().startswith("best so far") == complete
    assert {text.get_text() for text in right.get_legend().get_texts()} == set(FATES)


def test_the_best_walk_is_marked_in_the_graph_and_the_lengths_stand_beside_the_edges():
    left, _ = search_steps(EIGHT, 6, 2).axes
    thick = [patch for patch in left.patches if patch.get_linewidth() == 3]
    assert len(thick) == 5
    lengths = [length for row in LENGTHS.values() for length in row.values()]
    assert {f"{length:.1f}" for length in lengths} <= set(names_in(left))


def test_in_the_pruned_graph_the_search_has_no_choice():
    pruned = graphs.prune_graph(EIGHT).graph
    fates = [event.fate for event in search_events(edge_lengths(pruned), 6, 2, longest=8)]
    assert fates == ["expanded"] * 5 + ["complete"]
