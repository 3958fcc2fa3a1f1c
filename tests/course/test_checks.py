"""Checks of exercises: each typical wrong answer gets the hint meant for it."""

import pkgutil
import re
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from mocap.course import checks
from mocap.course.check import Check, Mistake, close, close_angles, close_rotations
from tests import wrong_answers

ALL = checks.all_checks()
WRONG = {
    name: answers
    for module in pkgutil.iter_modules(wrong_answers.__path__)
    for name, answers in import_module(f"tests.wrong_answers.{module.name}").WRONG.items()
}


def test_no_file_of_checks_hides_a_check_of_its_name():
    assert not {file.name for file in pkgutil.iter_modules(checks.__path__)} & {*ALL}
    assert all(getattr(checks, name) is check for name, check in ALL.items())


@pytest.mark.parametrize("name", ALL)
def test_three_wrong_answers_at_least_get_their_own_hints(name):
    assert len(WRONG[name]) >= 3
    hints = set()
    for answer, piece in WRONG[name]:
        verdict = ALL[name].verdict(answer)
        assert not verdict.right, answer.__name__
        assert piece in verdict.message, f"{answer.__name__}: {verdict.message}"
        hints.add(verdict.message)
    assert len(hints) >= 3


@pytest.mark.parametrize("name", ALL)
def test_the_oracle_passes_and_its_mistakes_do_not(name):
    check = ALL[name]
    assert check.verdict(check.truth).right
    for mistake in check.mistakes:
        assert not check.verdict(mistake.answer).right, mistake.hint
    assert re.match(r"[a-z]", check.asks)
    assert not check.asks.endswith(".")


def test_names_are_unique():
    modules = [
        import_module(f"mocap.course.checks.{module.name}")
        for module in pkgutil.iter_modules(checks.__path__)
    ]
    names = [value.name for module in modules for value in vars(module).values() if isinstance(value, Check)]
    assert sorted(names) == sorted(ALL)


def test_an_unknown_check_names_those_there_are():
    with pytest.raises(AttributeError, match=r"no check 'spede'; it has: .*speed"):
        checks.spede  # noqa: B018


DOUBLE = Check(
    name="double",
    asks="twice the numbers",
    start="What is 2 x?",
    draw=lambda rng: (rng.normal(size=3),),
    truth=lambda x: 2 * x,
    mistakes=[Mistake(lambda x: x * x, "That is the square.")],
)


def in_place(x):
    x *= 2
    return x


def broken(x):
    return x["y"]


def unfinished(x):
    raise NotImplementedError


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (lambda x: 2 * x, "✓ double: right on 40 random inputs."),
        (lambda x: x**2, "✗ double: That is the square."),
        (lambda x: ..., "✗ double: not there yet. It must return twice the numbers. Hint: What is 2 x?"),
        (unfinished, "✗ double: not there yet"),
        (lambda x: None, "returns None; does it end in `return`?"),
        (lambda x: x[:2], r"has the shape (2,); it should be (3,)"),
        (lambda x: 3 * x, "the shape is right, the values are wrong"),
        (lambda x: 2 * x * np.nan, "the values are wrong"),
        (in_place, "changes its arguments"),
        (broken, 'raises IndexError in `return x["y"]`'),
        ("no function", "raises TypeError"),
        (lambda: 0, "raises TypeError"),
        (lambda x: "two", "has the shape ()"),
    ],
)
def test_what_a_check_says(answer, message, capsys):
    assert DOUBLE(answer) is None
    assert message in capsys.readouterr().out


def test_a_function_that_never_ends_is_stopped_and_counts_the_inputs_that_were_done():
    check = replace(ALL["hamilton"], seconds=0.2)

    def forever(a, b):
        while True:
            pass

    said = "✗ hamilton: stopped after 0.2 s, when 0 of 40 inputs were done. Does a loop never end?"
    assert str(check.verdict(forever)) == said


def test_a_wrong_number_is_told_beside_the_right_one():
    check = Check(
        name="f", asks="x", start="", draw=lambda rng: (2.0,), truth=lambda x: x, mistakes=[], trials=1
    )
    assert "you return 3 where it should be 2." in check.verdict(lambda x: 3.0).message


@pytest.mark.parametrize(
    ("same", "given", "wanted", "right"),
    [
        (close, [1, 2.0], np.array([1.0, 2]), True),
        (close, [(1, 2), (3, 4)], [(1, 2)], False),
        (close, {1, 2}, {2, 1}, True),
        (close, "ab", "ab", True),
        (close, [[1], [2, 3]], [[1], [2, 3]], True),
        (close, [[1], [2, 4]], [[1], [2, 3]], False),
        (close_angles, np.pi, -np.pi, True),
        (close_angles, [0.1, 7], [0.1, 7 - 2 * np.pi], True),
        (close_angles, 0.1, -0.1, False),
        (close_rotations, [[-1, 0, 0, 0.0]], [[1, 0, 0, 0.0]], True),
        (close_rotations, [1, 0, 0, 0.0], [0.6, 0.8, 0, 0], False),
        (close_rotations, [1.0, 0], [1, 0, 0, 0.0], False),
    ],
)
def test_what_counts_as_the_same(same, given, wanted, right):
    assert same(given, wanted) is right
