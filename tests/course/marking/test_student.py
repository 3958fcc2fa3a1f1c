"""The way of a call: arguments to the student, an answer back, and the same sentence as in the notebook."""

import json
import pickle
from copy import copy
from functools import partial
from types import SimpleNamespace

import pytest

from mocap.course import lab
from mocap.course.checks import all_checks
from mocap.course.marking.marks import call
from mocap.course.marking.student import Student
from tests.course.test_checks import DOUBLE, in_place, unfinished
from tests.loops import for_each


def over_the_channel(function):
    """Give a function as the marker sees it, without the process between."""
    here = SimpleNamespace(shell=SimpleNamespace(user_ns={"f": function}))

    def ask(method, *arguments):
        arguments = pickle.loads(pickle.dumps(arguments))
        return json.loads(json.dumps(getattr(Student, method)(here, *arguments)))

    return partial(call, SimpleNamespace(ask=ask), "f")


@for_each(all_checks())
def test_a_check_says_the_same_as_in_the_notebook(name):
    check = copy(all_checks()[name])
    check.trials = 3
    for answer in (check.truth, *(answer for answer, _ in check.mistakes)):
        assert check.verdict(over_the_channel(answer)) == check.verdict(answer)


@pytest.mark.parametrize(
    "answer", [in_place, unfinished, lambda x: ..., lambda x: None, lambda x: (2 * x).tolist(), lambda x: len]
)
def test_what_students_do_is_said_as_in_the_notebook(answer):
    assert DOUBLE.verdict(over_the_channel(answer)) == DOUBLE.verdict(answer)


def test_an_error_is_said_with_its_line():
    def fails(x):
        return x[7]

    assert DOUBLE.verdict(over_the_channel(fails)).message == (
        "double: your function raises IndexError: "
        "index 7 is out of bounds for axis 0 with size 3 (in `return x[7]`)"
    )


@pytest.mark.parametrize("ending", [SystemExit, KeyboardInterrupt, GeneratorExit])
def test_a_function_that_ends_python_only_raises(ending):
    def ends(x):
        raise ending("now")

    assert f"your function raises {ending.__name__}: now" in DOUBLE.verdict(over_the_channel(ends)).message


def test_a_reply_that_is_none_is_no_answer():
    changes = [
        [[0, ["array", "<f8", [1, 1], "AAAAAAAAAAA="]]],
        [[7, 1]],
        [3],
        [["a", None]],
    ]  # of another shape
    for reply in ([["eval", "1"], [], "", ""], [1, [], "\0", ""], *([1, one, "", ""] for one in changes)):
        answer = partial(call, SimpleNamespace(ask=lambda *_, reply=reply: reply), "f")
        assert not DOUBLE.verdict(answer).right


def test_a_search_that_asks_for_the_edges_of_a_walk_twice_is_seen():
    check = copy(all_checks()["cheapest_walk"])
    check.trials = 3
    asks_twice = check.answers.mistakes["asked_twice"]
    assert "call it once for each" in check.verdict(over_the_channel(asks_twice)).message


def test_what_stands_in_for_a_wrong_function_gets_no_mark(tmp_path, monkeypatch):
    """The notebook goes on with the package's function; the marker judges what the student wrote."""
    monkeypatch.chdir(tmp_path)
    hamilton = lab.mine(multiplied_number_by_number)
    assert all_checks()["hamilton"].verdict(hamilton.stand_in).right
    verdict = all_checks()["hamilton"].verdict(over_the_channel(hamilton))
    assert not verdict.right
    assert "multiplies number by number" in verdict.message
    assert list(tmp_path.iterdir()) == []


def multiplied_number_by_number(a, b):
    return a * b


multiplied_number_by_number.__name__ = "hamilton"
