"""Nodes and edges under names: seven kinds of strides in one graph, and refusals that help."""

from dataclasses import replace

import pytest

from mocap.errors import MocapError, NoWalk
from mocap.methods.parametric_graphs.parametric_edges import build_parametric
from tests.methods.parametric_graphs.built import (
    SMALL,
    by_turn_and_speed,
    space,
    stepping,
    walk_and_jog,
    walking,
)


def test_by_default_all_edges_that_can_be_had_are_there():
    """As in [HG07, graph]."""
    some = {name: walk_and_jog().space(name) for name in ("walk", "jog")}
    graph = build_parametric(some, good=0.05, sampling=SMALL)
    assert set(graph.graph.edges) == {("walk", "walk"), ("jog", "jog")} and graph.fps == 30


def test_the_report_names_each_edge_and_its_boxes():
    assert walking().report().startswith("walk → walk: boxes of ")
    assert "of turn, from 1." in walking().report()
    assert len(stepping().report().splitlines()) == 2
    both = build_parametric({"walk": by_turn_and_speed()}, good=0.06, sampling=SMALL)
    assert "m/s of speed" in both.report()


@pytest.mark.parametrize(
    ("spaces", "edges", "good", "error", "sentence"),
    [
        (["walk"], [("walk", "run")], 0.03, MocapError, "There is no space 'run'; there are: walk"),
        (
            ["walk"],
            [("walk", "walk")],
            0.005,
            NoWalk,
            r"walk → walk: Nothing follows turn .* raise T_GOOD to 1.\d cm",
        ),
        (["walk"], None, 0.005, NoWalk, "Nothing follows 'walk' below 0.5 cm"),
    ],
)
def test_what_cannot_be_built_is_refused(spaces, edges, good, error, sentence):
    with pytest.raises(error, match=sentence) as caught:
        build_parametric({name: space() for name in spaces}, edges, good=good, sampling=SMALL)
    assert len(str(caught.value)) <= 200


def test_spaces_of_two_rates_are_no_graph_even_without_an_edge_between_them():
    slow = replace(space(), examples=replace(space().examples, fps=60.0))
    with pytest.raises(MocapError, match="one rate, got 30 and 60 Hz"):
        build_parametric({"a": space(), "b": slow}, [("a", "a"), ("b", "b")], good=0.05, sampling=SMALL)
