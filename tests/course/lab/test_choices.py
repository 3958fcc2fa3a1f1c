"""Which windows are looked at: the cheapest, the chosen, and one clear sentence for all others."""

import numpy as np
import pytest

from mocap.body.motion import resample
from mocap.course import lab
from mocap.course.lab.choices import EACH, around, of_clips, of_graph, of_walk
from mocap.course.lab.scenes import scene
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.graphs.motion_graph import from_transitions
from mocap.matching.distance_grids import distance_grid
from mocap.synthesis.random_walks import random_walk
from mocap.synthesis.walk_to_motion import seams
from tests.bundled import bundled
from tests.course.lab.students import written

NOWHERE = np.zeros((0, 2))
WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]


@pytest.fixture(scope="module")
def graph():
    return bundled("walk_circle", "walk_curve_1")


def test_of_two_clips_the_lowest_minimum_comes_first():
    choices = of_clips(WALKS, 10, None)
    grid = distance_grid(*WALKS, window=10)
    assert grid[choices.pick.i, choices.pick.j] == grid.min()
    assert list(choices.minima) == sorted(choices.minima, key=lambda place: grid[place])


def test_the_readers_functions_make_the_grid_and_its_minima_and_it_is_said():
    theirs = of_clips(WALKS, 10, None)
    assert theirs.by == "" and "The grid by" not in scene(theirs, ["windows"], NOWHERE, NOWHERE, "")["key"]
    sums, inner = lab.mine(written("window_sums")), lab.mine(written("inner_minima"))
    ours = of_clips(WALKS, 10, None)
    assert sums.yours and inner.yours
    assert np.allclose(ours.grid, theirs.grid, atol=1e-6)
    assert ours.pick == theirs.pick and {*ours.minima} - {*theirs.minima} == set()
    said = scene(ours, ["windows"], NOWHERE, NOWHERE, "")["key"]
    assert said.endswith(" The grid by window_sums, inner_minima: yours.")


def test_where_the_readers_function_fails_the_packages_makes_the_grid(capsys):
    lab.mine(written("window_sums")).own = lambda numbers, window: 1 / 0
    assert np.allclose(of_clips(WALKS, 10, None).grid, distance_grid(*WALKS, window=10), atol=1e-6)
    assert "window_sums: yours raised ZeroDivisionError" in capsys.readouterr().out
    assert of_clips(WALKS, 10, None).by == ""


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ((0, 111), "Windows start at frames 0 to 110 and 0 to 110, not 0 and 111."),
        ((-1, 0), "not -1 and 0"),
        ("here", "at=(i, j), not by 'here'"),
        (7, "at=(i, j), not by 7"),
        ((1, 2, 3), "at=(i, j)"),
        ((1.5, 2), "at=(i, j)"),
    ],
)
def test_a_cell_that_is_not_there(at, said):
    with pytest.raises(MocapError) as refused:
        of_clips(WALKS, 10, at)
    assert said in str(refused.value) and len(str(refused.value)) < 200


def test_of_a_graph_the_cheapest_from_each_clip_to_each_clip_can_be_pointed_at(graph):
    choices = of_graph(graph)
    assert choices.costs[0] == min(cost for *_, cost in graph.graph.edges(data="cost") if cost)
    pairs = [(pick.first, pick.second) for pick in choices.transitions]
    assert max(map(pairs.count, pairs)) == EACH


def test_a_graph_without_transitions_has_nothing_to_inspect():
    with pytest.raises(MocapError, match="no transitions"):
        of_graph(from_transitions(WALKS[:1], [], window=10))


def test_seams_of_a_walk_come_with_the_frames_that_the_walk_has_around_them(graph):
    walk = random_walk(graph, seconds=15, seed=3)
    found = seams(graph, walk)
    choices = of_walk(graph, walk)
    assert [pick.frame for pick in choices.seams] == [seam.frame for seam in found]
    assert choices.pick.seam == np.argmax([seam.cost for seam in found])
    for one, after in zip(choices.seams, choices.seams[1:], strict=False):
        assert one.frame + graph.window + one.after <= after.frame
        assert after.before <= min(around(30), after.frame - one.frame - graph.window)
    for seam, taken in enumerate(choices.seams):
        assert taken.seam == seam and choices.transitions[taken.number][:4] == taken[:4]


def test_a_walk_without_seams_has_nothing_to_inspect(graph):
    walk = random_walk(graph, seconds=8, seed=3)
    clip = [edge for edge in walk if graph.graph.edges[edge]["kind"] == "clip"][:1]
    with pytest.raises(MocapError, match="no transition"):
        of_walk(graph, clip)
