"""Each known mistake of 00 to 07 changes what the notebook shows next, in pictures and players."""

from itertools import zip_longest

import pytest

from mocap.course import checks
from tests.course.lab.shown import NOTHING, OUTSIDE, Rest, Stage, cells_of, rests, written
from tests.course.stored_notebooks import NAMES

WAY = [name for name in NAMES if name[:3] in {f"0{number}-" for number in range(8)}]

SAME_ROTATION = "q and -q are the same rotation"
ROOT_AT_ZERO = "the offset of the root is 0 in all skeletons of the course"
GLOBAL_MINIMUM = "the smallest entry of a whole grid is one of its minima"
NO_EQUAL_VALUES = "measured distances are never equal, to each other or to the threshold"
GOOD_SEAM = "at a good seam slerp and a straight line differ by less than a millimetre, as 04 explains"
BOTH_WAYS = "each match gives a transition both ways, whose frames are the same with the window at either end"
NO_PARALLEL_EDGES = "no transition of the page leads to the node that follows anyway"
ENDS_ARE_ADDED = "networkx adds the nodes to which edges lead"
LARGEST_BY_ALL = "the component that plays most is the largest by these measures too"
UNSEEN = {
    "hamilton": {"negated": SAME_ROTATION},
    "climb": {"root_offset_included": ROOT_AT_ZERO},
    "cheapest": {"of_whole_grid": GLOBAL_MINIMUM},
    "inner_minima": dict.fromkeys(
        ["equal_neighbours_allowed", "at_threshold", "plain_minima_inside"], NO_EQUAL_VALUES
    ),
    "mix": dict.fromkeys(["scaled_straight_lines", "scaled_shorter_lines"], GOOD_SEAM),
    "choice_points": {"window_at_leaves": BOTH_WAYS},
    "successors_of": {"without_last_nodes": ENDS_ARE_ADDED, "each_successor_once": NO_PARALLEL_EDGES},
    "component_to_keep": dict.fromkeys(
        ["nodes_counted", "leaving_edges", "entering_edges", "edges_counted", "either_end", "longest_edge"],
        LARGEST_BY_ALL,
    ),
}
"""The mistakes that change nothing on their page, with the reasons."""

QUICK = ("00-quickstart", "03-transforms")
"""The notebooks in which each exercise feeds a picture that is drawn in a moment."""


SOME = {
    "cheapest_walk": [
        *("first_complete_walk", "no_bound", "dearest_first", "unsorted", "oldest_first"),
        *("cheapest_edge_alone", "places_met", "pops_counted", "start_missing"),
    ]
}
"""Of these exercises, the mistakes that are tried: each searches for seconds."""


@pytest.fixture
def stage(monkeypatch):
    monkeypatch.setenv("MOCAP_MINE", "")
    made = Stage()
    made.replace(monkeypatch)
    return made


def unseen(exercise, rest, some=None):
    """Return the mistakes of an exercise, or those of some, that change nothing that is shown."""
    known = checks.all_checks()[exercise].answers.mistakes
    wrong = {mistake: {exercise: written(exercise, known[mistake])} for mistake in some or known}
    return {mistake for mistake, functions in wrong.items() if not any(rest.differences(functions))}


def players_changed(name, stage, function):
    """Return how many players of a notebook show something else if `hamilton` is another function."""
    cells = [cell for cell in cells_of(name) if cell.exercise != "hamilton"]
    right = checks.all_checks()["hamilton"].truth
    rest = Rest(stage, OUTSIDE, cells, {"hamilton": written("hamilton", right)})
    changed = 0
    for shown, expected in rest.differences({"hamilton": written("hamilton", function)}):
        pairs = zip_longest(shown, expected, fillvalue=NOTHING)
        changed += sum(wanted.kind == "play" and not item.looks_like(wanted) for item, wanted in pairs)
    return changed


@pytest.mark.parametrize("name", QUICK)
def test_some_mistakes_change_what_is_shown_next(name, stage):
    for exercise, rest in rests(name, stage):
        known = checks.all_checks()[exercise].answers.mistakes
        some = [mistake for mistake in known if mistake not in UNSEEN.get(exercise, ())][::3]
        assert unseen(exercise, rest, some) == set(), exercise


@pytest.mark.sweep
@pytest.mark.parametrize("name", WAY)
def test_each_mistake_changes_what_is_shown_next(name, stage):
    """Those that do not are listed with their reasons, and no others."""
    found = {exercise: unseen(exercise, rest, SOME.get(exercise)) for exercise, rest in rests(name, stage)}
    assert found == {exercise: {*UNSEEN.get(exercise, ())} for exercise in found}


@pytest.mark.sweep
@pytest.mark.parametrize("mistake", ["reversed_order", "number_by_number", "conjugated_second"])
def test_a_wrong_product_changes_eight_players_up_to_notebook_07(mistake, stage):
    function = checks.all_checks()["hamilton"].answers.mistakes[mistake]
    assert sum(players_changed(name, stage, function) for name in WAY) >= 8
