"""A deadline ends a search with the best walk so far; tests turn the clock by hand."""

from functools import partial

import numpy as np
import pytest

from mocap._shared import deadlines
from mocap.body import circle
from mocap.body.ground_path import GroundPath, s_curve
from mocap.editing import LIMIT
from mocap.errors import NoWalk
from mocap.graphs import compile_graph
from mocap.steering import PathRequest, Settings, follow_as_2002, follow_path
from mocap.steering.path_search import watching
from tests.bundled import walking
from tests.refusals import quietly, refused, told, unwarned

GRAPH = compile_graph(walking())
TIGHT = s_curve(4)  # nearly as tight as the clips turn: one search is not enough
LONG = 1e6  # seconds


@pytest.fixture
def ticking(monkeypatch):
    """Turn the clock on by a second whenever a search reads it."""
    clock = iter(range(10**9))
    monkeypatch.setattr(deadlines, "monotonic", lambda: float(next(clock)))


def stopped_in_round(number, path, **options):
    """Follow a path, and stop the search by Ctrl-C in one of its rounds, counted from 1."""
    rounds = []

    def stop(search, walks):
        rounds.append(walks)
        if len(rounds) == number:
            raise KeyboardInterrupt

    token = watching.set(stop)
    try:
        return quietly(follow_path, GRAPH, path, **options)
    finally:
        watching.reset(token)


@pytest.mark.parametrize("options", [{}, {"bend": LIMIT}], ids=["as it is", "bent"])
@pytest.mark.parametrize("seconds", [20, 60])
def test_at_the_deadline_the_walk_is_the_best_so_far(ticking, seconds, options):
    """The search looks at the clock after each of its rounds, which Ctrl-C counts as well."""
    path = s_curve()
    settings = Settings(deadline=seconds)
    covered = r"the walk covers \d+ % of the path, \d\.\d of \d+\.\d m\.$"
    words = f"^The deadline of {seconds} s ended the search: {covered}"
    followed = told(words, follow_path, GRAPH, path, settings=settings, **options)
    expected = stopped_in_round(seconds, path, **options)
    assert followed.found.stopped == "out of time"
    assert followed.walk == expected.walk
    assert np.array_equal(followed.track, expected.track)
    assert 0.02 < followed.progress < 0.9
    assert followed.report().endswith("out of time: the best so far")


def test_a_later_deadline_leads_farther(ticking):
    walks = [quietly(follow_path, GRAPH, s_curve(), settings=Settings(deadline=n)) for n in (10, 30, 90)]
    assert walks[0].progress < walks[1].progress < walks[2].progress


def test_the_warning_says_how_much_of_the_path_the_walk_covers(ticking):
    with pytest.warns(UserWarning, match="The deadline") as caught:
        followed = follow_path(GRAPH, s_curve(), settings=Settings(deadline=30))
    [sentence] = [str(one.message) for one in caught if "deadline" in str(one.message)]
    numbers = f"{round(100 * followed.progress)} % of the path, {followed.along[-1]:.1f} of "
    assert f"covers {numbers}{followed.path.length:.1f} m." in sentence


def test_a_deadline_before_the_first_step_is_an_error(ticking):
    words = "^The search was out of time before its first step: give it longer.$"
    refused(words, follow_path, GRAPH, s_curve(), settings=Settings(deadline=0.5), kind=NoWalk)
    request = PathRequest(start=GRAPH.nodes[300])
    refused("out of time before its first step", follow_as_2002, GRAPH, s_curve(), request, deadline=0.5)


def rounds_of(path, settings):
    """Count the rounds of a search."""
    rounds = []
    token = watching.set(lambda search, walks: rounds.append(walks))
    try:
        quietly(follow_path, GRAPH, path, settings=settings)
    finally:
        watching.reset(token)
    return len(rounds)


@pytest.mark.parametrize("late", [1, 2, 40], ids=["before", "in the first round of", "in the middle of"])
def test_a_whole_walk_is_kept_when_the_deadline_ends_the_second_search(ticking, late):
    """Once in each round, and once between two searches, the clock is read."""
    once = quietly(follow_path, GRAPH, TIGHT, settings=Settings(tries=1))
    assert once.excess > 1
    seconds = rounds_of(TIGHT, Settings(tries=1)) + late
    words = r"covers all of the path, \d+\.\d m, but a longer search may find a better one"
    followed = told(words, follow_path, GRAPH, TIGHT, settings=Settings(deadline=seconds))
    assert followed.walk == once.walk
    assert followed.progress == 1.0


def test_a_deadline_that_is_not_reached_changes_nothing(ticking):
    path = GroundPath([[2, 1], [2, 9]])
    free = unwarned(follow_path, GRAPH, path)
    limited = unwarned(follow_path, GRAPH, path, settings=Settings(deadline=LONG))
    assert limited.walk == free.walk and limited.found.stopped == free.found.stopped == ""


@pytest.mark.parametrize("seconds", [0, -1.0, np.nan])
def test_a_deadline_is_in_the_future(seconds):
    words = "^A deadline is more than 0 seconds away, got"
    refused(words, follow_path, GRAPH, circle(2), settings=Settings(deadline=seconds))
    refused(words, follow_as_2002, GRAPH, circle(2), PathRequest(), deadline=seconds)


def test_the_search_of_2002_gives_its_walk_so_far(ticking):
    follow = partial(follow_as_2002, GRAPH, s_curve(), PathRequest(start=GRAPH.nodes[300]), budget=50)
    words = r"^The deadline of 300 s ended the search: the walk covers \d+ % of the path"
    followed = told(words, follow, deadline=300)
    whole = follow()
    assert followed.found.stopped == "out of time" and 0 < followed.progress < 1
    shared = len(followed.walk) - 8  # the last stretch was searched in part
    assert shared > 0 and followed.walk[:shared] == whole.walk[:shared]
