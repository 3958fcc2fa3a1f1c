"""Checks of exercises: the right answer passes, and each typical mistake gets its own hint."""

import ast
import inspect
import re
import tomllib
from copy import copy

import numpy as np
import pytest

from mocap.course import checks
from mocap.course.check import Answers, Check, Texts
from mocap.course.common_mistakes import Attempt, name_mistake
from mocap.course.comparisons import altered, close, close_angles, close_rotations
from mocap.course.failing_inputs import failing_input, smallest
from tests.course.told import frozen, told

ALL = checks.all_checks()
HINTS = checks.FOLDER / "hints"


def test_every_function_of_a_notebook_belongs_to_one_exercise_and_every_hint_has_its_mistake():
    modules = {f"nb{file.stem.replace('-', '_')}": file for file in HINTS.glob("*.toml")}
    assert {file.stem for file in checks.ANSWERS.glob("nb*.py")} == {*modules}
    for module, file in modules.items():
        exercises = tomllib.loads(file.read_text("utf-8"))
        wanted = {f"{kind}_{name}" for name in exercises for kind in ("draw", "right")}
        mistakes = [f"mistake_{key}" for table in exercises.values() for key in table["mistakes"]]
        assert len(mistakes) == len({*mistakes})
        tree = ast.parse((checks.ANSWERS / f"{module}.py").read_text("utf-8"))
        defined = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
        kinds = ("draw_", "right_", "mistake_")
        assert {name for name in defined if name.startswith(kinds)} == wanted | {*mistakes}
        assert {name.removeprefix("same_") for name in defined if name.startswith("same_")} <= {*exercises}
    assert all(getattr(checks, name) is check for name, check in ALL.items())
    assert len(ALL) == sum(len(tomllib.loads(file.read_text("utf-8"))) for file in modules.values())


def test_every_function_of_an_exercise_says_what_it_does():
    for file in checks.ANSWERS.glob("nb*.py"):
        tree = ast.parse(file.read_text("utf-8"))
        functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
        assert functions, file
        assert [node.name for node in functions if not ast.get_docstring(node)] == [], file


def test_a_package_function_that_a_right_answer_calls_is_its_oracle():
    assert ALL["hamilton"].oracles == ["multiply"]
    assert ALL["inner_minima"].oracles == ["local_minima"]
    assert ALL["speed"].oracles == ALL["climb"].oracles == []


@pytest.mark.parametrize("name", ALL)
def test_the_right_answer_passes_and_each_mistake_gets_its_own_hint(name):
    check = ALL[name]
    said = told(check)
    assert said == frozen()[name]
    assert said[0] == f"✓ {name}: right on {check.trials} random inputs."
    assert said[1:] == [f"✗ {name}: {hint}" for _, hint in check.mistakes]
    assert len({hint for _, hint in check.mistakes}) >= 3
    assert re.match(r"[a-z].*[^.]$", check.asks)


def test_an_unknown_check_names_those_there_are():
    with pytest.raises(AttributeError, match=r"no check 'spede'; it has: .*speed.*; write `speed`$"):
        checks.spede  # noqa: B018


ANSWERS = Answers(
    draw=lambda rng: (rng.normal(size=3),),
    right=lambda x: 2 * x,
    mistakes={
        "square": lambda x: x * x,
        "added": lambda x: 2 * x + 1,
        "never_positive": lambda x: -2 * np.abs(x),
    },
)
HINTS_OF_DOUBLE = {
    "square": "That is the square.",
    "added": "One too many.",
    "never_positive": "That is never above 0.",
}
TEXTS = Texts("twice the numbers", "What is 2 x?", HINTS_OF_DOUBLE)
DOUBLE = Check("double", TEXTS, lambda: ANSWERS, "00")


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
        (lambda x: x + x + 1, "✗ double: One too many."),
        (lambda x: -2 * np.abs(x), "✗ double: That is never above 0."),
        (lambda x: ..., "✗ double: not there yet. It must return twice the numbers. Hint: What is 2 x?"),
        (unfinished, "✗ double: not there yet"),
        (lambda x: None, "returns None; does it end in `return`?"),
        (lambda x: x[:2], r"has the shape (2,); it should be (3,)"),
        (lambda x: 3 * x, "your values are 1.5 times the right ones"),
        (
            lambda x: 2 * x * np.nan,
            "For x = [0.1257, -0.1321, 0.6404], you return [nan, nan, nan]; it should be",
        ),
        (in_place, "changes its arguments"),
        (broken, 'raises IndexError in `return x["y"]`'),
        ("no function", "raises TypeError"),
        (lambda: 0, "raises TypeError"),
        (lambda x: "two", "has the shape ()"),
    ],
)
def test_what_a_check_says_when_a_function_fails_again(answer, message, capsys):
    check = copy(DOUBLE)
    check.has_failed = True
    assert check(answer) is None
    assert message in capsys.readouterr().out


def test_a_hint_comes_when_a_function_fails_for_the_second_time(capsys):
    check = Check("double", TEXTS, lambda: ANSWERS)
    asks = "It must return twice the numbers."
    for answer in (lambda x: ..., lambda x: ..., lambda x: x**2):
        check(answer)
    stub, stub_again, square = capsys.readouterr().out.splitlines()
    assert stub == f"✗ double: not there yet. {asks}"
    assert stub_again == f"{stub} Hint: What is 2 x?"
    assert square == "✗ double: That is the square."
    other = Check("double", TEXTS, lambda: ANSWERS)
    other(lambda x: x**2)
    assert capsys.readouterr().out == f"✗ double: not right yet. {asks} A hint comes when it fails again.\n"
    with pytest.raises(AssertionError, match="That is the square"):  # nbgrader gets it at once
        Check("double", TEXTS, lambda: ANSWERS).require(lambda x: x**2)


def test_a_wrong_type_is_told_at_once(capsys):
    Check("double", TEXTS, lambda: ANSWERS)(broken)
    assert "raises IndexError" in capsys.readouterr().out


def test_a_function_that_never_ends_is_stopped_and_counts_the_inputs_that_were_done():
    check = copy(ALL["hamilton"])
    check.seconds = 0.2

    def forever(a, b):
        while True:
            pass

    said = "✗ hamilton: stopped after 0.2 s, when 0 of 40 inputs were done. Does a loop never end?"
    assert str(check.verdict(forever)) == said


def test_items_in_another_form_are_not_judged_by_their_shape():
    given = checks.inner_minima.verdict(lambda grid, below: np.zeros((7, 2))).message
    assert "is missing and (0, 0) does not belong to the answer" in given


def test_a_wrong_number_is_told_beside_the_right_one():
    answers = Answers(draw=lambda rng: (2.0,), right=lambda x: x, mistakes={})
    check = Check("f", Texts("x", "", {}, trials=1), lambda: answers)
    assert "For x = 2, you return 3; it should be 2." in check.verdict(lambda x: 3.0).message


@pytest.mark.parametrize(
    ("same", "given", "wanted", "right"),
    [
        (close, [1, 2.0], np.array([1.0, 2]), True),
        (close, [(1, 2), (3, 4)], [(1, 2)], False),
        (close, {1, 2}, {2, 1}, True),
        (close, "ab", "ab", True),
        (close, [[1], [2, 3]], [[1], [2, 3]], True),
        (close, (1, [2j]), (1.0, [2j]), True),
        (close, (1, 2 + 1j), (1.0, 2j), False),
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


def test_a_wrong_function_is_refused_for_nbgrader_also_without_assertions():
    """`python -O` leaves out assertions."""
    assert DOUBLE.require(lambda x: 2 * x) is None
    with pytest.raises(AssertionError, match="✗ double: That is the square"):
        DOUBLE.require(lambda x: x * x)
    assert "assert " not in inspect.getsource(Check.require)


class Walker:
    """An object with attributes, one of which is a cache."""

    def __init__(self):
        self.steps = [np.zeros(3), {"left": 1.0}]


def test_a_change_deep_in_an_argument_is_found_and_a_cache_is_none():
    old, new = Walker(), Walker()
    assert not altered((old, np.nan, {1}), (new, np.nan, {1}))
    new.cache = 3
    assert not altered(old, new)
    new.steps[1]["left"] = 2.0
    assert altered([old], [new])
    assert altered({"a": np.zeros(2)}, {"a": np.ones(2)}) and altered({1: 2}, {1: 2, 3: 4})


def test_a_function_that_writes_into_a_motion_is_told_so():
    def mix(a, b, alpha):
        a.root_positions[:] = 0
        return checks.mix.truth(a, b, alpha)

    assert "changes its arguments" in checks.mix.verdict(mix).message


def test_the_number_and_the_vector_of_a_product_beside_each_other_are_named():
    def hamilton(a, b):
        return a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])

    assert "nested: join them into one flat array" in checks.hamilton.verdict(hamilton).message


@pytest.mark.parametrize(("part", "said"), [(0, "part 1 of 2 alone"), (1, "part 2 of 2 alone")])
def test_one_part_of_a_pair_is_told_which_it_is(part, said):
    assert said in checks.mix.verdict(lambda *given: checks.mix.truth(*given)[part]).message


@pytest.mark.parametrize(
    ("wrong", "wanted", "said"),
    [
        (lambda w: np.degrees(w), 0.5, "that is in degrees"),
        (lambda w: w + 0.1j, 0.5, "your answer is complex"),
        (lambda w: w[::-1], np.arange(3.0), "in reverse order"),
        (lambda w: w.T, np.arange(6.0).reshape(2, 3), "transposed"),
        (lambda w: [w], [1.0, 2.0], "inside another list"),
        (lambda w: sum(w), [1.0, 2.0], "that is the sum of the right values"),
        (lambda w: [*w, *w], [1, 2], "more than once"),
        (lambda w: np.roll(w, 1), np.array([3.0, 1, 2]), "in the wrong order"),
        (lambda w: w - 1, np.array([3, 5]), "one too small"),
        (lambda w: np.isin(np.arange(9), w), np.array([3, 5]), "that is a mask"),
        (lambda w: np.flatnonzero(w), np.arange(9) > 6, "those are indices"),
        (lambda w: w[::-1], (1.0, [2.0, 3.0]), "in reverse order"),
        (lambda w: w[:2], (1.0, [2.0], 3), "2 parts; it should have 3"),
        (lambda w: w + 1.234, 0.5, ""),
    ],
)
def test_mistakes_of_any_exercise_are_named(wrong, wanted, said):
    named = name_mistake([Attempt((), wanted, wrong(wanted))], close)
    assert said in named and bool(said) == bool(named)


def test_values_at_the_right_places_are_not_the_places():
    costs = np.array([3.0, 1.0, 2.0])
    attempt = Attempt((costs,), np.array([1, 2]), np.array([1.0, 2.0]))
    assert "values at the right places" in name_mistake([attempt], close)


@pytest.mark.parametrize("name", ALL)
def test_an_unnamed_wrong_answer_shows_a_small_failing_input_in_few_words(name):
    check = ALL[name]

    def nonsense(*arguments):
        return check.truth(*arguments), "nonsense", 7

    message = check.verdict(nonsense).message
    assert len(message) <= 460 and "\n" not in message


def test_the_smallest_failing_input_is_shown():
    big, small = {1: [2], 2: [3], 3: []}, {1: []}
    trials = [((big,), 0, 1), ((small,), 0, 1), ((big,), 2, 1)]
    assert smallest(trials) == trials[1]
    assert failing_input(len, ([0.5] * 99,), {"a": [1]}, {"a": [2]}).endswith(
        "at a you return [2]; it should be [1]."
    )


def test_equal_numbers_tell_lower_from_lower_or_equal():
    def minima(grid, below):
        inner = [(i, j) for i in range(1, len(grid) - 1) for j in range(1, len(grid[0]) - 1)]
        return [
            p
            for p in inner
            if grid[p] < below and grid[p] <= grid[p[0] - 1 : p[0] + 2, p[1] - 1 : p[1] + 2].min()
        ]

    assert "equal ones do not count" in checks.inner_minima.verdict(minima).message


def test_a_search_that_asks_twice_for_the_edges_is_told_so():
    def search(ways, start, done):
        found = checks.cheapest_walk.truth(ways, start, done)
        for state in 20 * [start]:
            ways(state)
        return found

    assert "more often than you expand" in checks.cheapest_walk.verdict(search).message
