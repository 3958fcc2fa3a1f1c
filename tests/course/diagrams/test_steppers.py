"""Each entry of a stepper's legend occurs in at least one of its steps."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import mocap
from mocap import graphs
from mocap.body import GroundPath
from mocap.course import diagrams
from tests.course.diagrams.legends import missing

FEWER = ((1, 2), (2, 1), (2, 3))
"""Arrows of a reader's own: a cycle, and a way out of it."""


def tarjan(*arrows):
    graph = graphs.notes_example(*arrows)
    states = diagrams.tarjan_states({node: sorted(graph.successors(node)) for node in sorted(graph)})
    return diagrams.tarjan_steps(graph), [(step,) for step in range(len(states))]


def branches(*added):
    graph = graphs.notes_example()
    graph.add_edges_from(added)
    events = diagrams.search_events(diagrams.edge_lengths(graph), 6, 2, longest=8)
    return diagrams.search_steps(graph, 6, 2), [(step,) for step in range(len(events) + 1)]


def layers():
    line = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(0.7 * np.arange(7)) @ [1j, 1]
    return diagrams.layer_steps(line, 5), [(step, 4, True) for step in range(27)]


STEPPERS = {
    "tarjan_steps": lambda: tarjan(),
    "tarjan_steps of a reader's graph": lambda: tarjan(FEWER),
    "search_steps": lambda: branches((7, 3)),
    "search_steps without cuts": lambda: branches(),
    "layer_steps": layers,
}


@pytest.mark.parametrize("stepper", STEPPERS.values(), ids=STEPPERS)
def test_each_entry_of_the_legend_occurs_in_a_step(stepper):
    draw, positions = stepper()
    assert missing(draw, positions, plt.gcf) == set()
    plt.close("all")


def test_all_steppers_are_tried():
    steppers = {name for name in dir(diagrams) if name.endswith("_steps")}
    assert steppers == {name.split()[0] for name in STEPPERS}


def test_an_entry_that_never_occurs_is_found():
    figure, ax = plt.subplots()
    (walked,) = ax.plot([], [], color="green", label="walked")
    ax.plot([], [], color="red", label="cut")
    ax.plot([], [], "o", color="blue", label="node")
    dots = ax.scatter([0, 1], [0, 1], color="white")
    ax.legend()

    def draw(step):
        walked.set_data([0, step], [0, step])
        if step:
            dots.set_facecolor(["white", "blue"])

    assert missing(draw, [(0,), (1,)], lambda: figure) == {"cut"}
    plt.close(figure)


def test_the_eight_nodes_take_a_readers_arrows_and_no_other_nodes():
    graph = graphs.notes_example(FEWER)
    assert sorted(graph) == [*range(1, 9)] and sorted(graph.edges()) == [*FEWER]
    with pytest.raises(mocap.MocapError, match="nodes 1 to 8, not 9"):
        graphs.notes_example([(8, 9)])
