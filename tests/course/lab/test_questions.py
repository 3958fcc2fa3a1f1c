"""Quizzes and bets: their data, what they show, and where they stand in the notebooks."""

import ast
import base64
import json
import re
from types import SimpleNamespace
from typing import get_args, get_origin, get_type_hints

import numpy as np
import pytest

from mocap.course import lab
from mocap.course.lab.computed import computed, filled
from mocap.course.lab.kept_bets import asked_before, summed_up
from mocap.course.lab.page import to_html, to_text
from mocap.course.lab.quizzes import asked
from mocap.course.lab.reading import TEXTS, Choice, Number, Order, file_of, read_questions
from mocap.errors import MocapError
from tests.course.stored_notebooks import FOLDER, every_notebook, read
from tests.course.test_prose import PER, UNUSUAL

FILES = sorted(TEXTS.glob("*.toml"))

GOOD = """
[quiz.more]
kind = "choice"
question = "Is `D < 4` *always* {{limit:.0f}}?"
right = "yes"
because = "It is."
wrong = { no = "Look again.", "at times" = "Not at times." }

[quiz.height]
kind = "number"
question = "How high?"
answer = "2 * limit"
tolerance = 0.5
unit = "cm"
too_low = "Higher."
too_high = "Lower."
because = "Twice."
slips = [["limit", "Twice that."], [1, "No."]]

[quiz.steps]
kind = "order"
question = "Put in order."
steps = ["first", "second", "third"]
hints = ["first before second", "second before third"]
because = "So."

[bet.share]
ask = "Share"
unit = "%"
low = 0
high = 100
came_out = "100 / limit"

[bet.which]
ask = "Which?"
choices = ["this", "that"]
came_out = "that"
holds = "limit > 3"
"""


def questions(tmp_path, text=GOOD):
    file = tmp_path / "99-test.toml"
    file.write_text(text)
    return read_questions(file)


def data(shown):
    return json.loads(base64.b64decode(re.search(r'data-spec="([^"]*)"', shown.html)[1]))


def seen(shown):
    """Give what is read where no script runs."""
    return re.sub(r"(?s)<(script|style)>.*?</\1>|<[^>]*>", " ", shown.html)


# What they show


def test_a_choice_shows_its_choices_and_hides_which_is_right(tmp_path):
    shown = asked("99-more", questions(tmp_path).quizzes["more"], {"limit": 4.2})
    spec = data(shown)
    choices = re.findall(r"^[a-z]\) (.*)$", shown.text, re.MULTILINE)
    assert sorted(choices) == ["at times", "no", "yes"]
    assert spec["hints"][choices.index("yes")] == ""
    assert spec["hints"][choices.index("no")] == "Look again."
    assert "Is <code>D &lt; 4</code> <em>always</em> 4?" in shown.html
    assert repr(shown).startswith("Is D < 4 always 4?\n")
    for form in (shown.text, seen(shown)):
        assert "It is." not in form
        assert "Look again" not in form
    assert shown._repr_mimebundle_() == {"text/html": shown.html, "text/plain": shown.text}


@pytest.mark.parametrize("place", [1, 2, 3])
def test_the_right_choice_stands_where_it_is_asked_to(place):
    quiz = Choice("?", "yes", {"no": "x", "never": "y"}, "so", place=place)
    assert data(asked("99-more", quiz, {}))["hints"].index("") == place - 1


def test_the_right_choices_do_not_stand_all_at_one_place():
    quiz = Choice("?", "yes", {"no": "x", "never": "y"}, "so")
    places = [data(asked(f"99-{number}", quiz, {}))["hints"].index("") for number in range(30)]
    assert set(places) == {0, 1, 2}


def test_a_number_is_computed_with_the_names_of_the_notebook(tmp_path):
    shown = asked("99-height", questions(tmp_path).quizzes["height"], {"limit": 1 / 3})
    spec = data(shown)
    assert spec["answer"] == 0.666667  # to six digits, the same on every machine
    assert spec["slips"] == [[0.333333, "Twice that."], [1, "No."]]
    assert shown.text == "How high?\n- ______ cm"
    assert "0.66" not in seen(shown)


def test_steps_are_mixed_the_same_way_each_time_and_never_in_order():
    quiz = Order("?", ["a", "b", "c"], ["x", "y"], "so")
    for key in map(str, range(20)):
        shown = asked(key, quiz, {})
        spec = data(shown)
        assert spec == data(asked(key, quiz, {}))
        assert sorted(spec["order"]) == [0, 1, 2]
        assert spec["order"] != [0, 1, 2]
        assert shown.text.splitlines()[1:] == [f"- {quiz.steps[number]}" for number in spec["order"]]


def test_a_bet_asks_and_the_summary_says_what_came_out(tmp_path):
    bets = {f"99-{name}": bet for name, bet in questions(tmp_path).bets.items()}
    shown = asked_before(bets, {})
    assert shown.text == "Share: ______ %\nWhich? this / that"
    assert [one["key"] for one in data(shown)["bets"]] == ["99-share", "99-which"]
    assert "25" not in seen(shown) and "<li>Which? this / that</li>" in shown.html
    summary = summed_up(bets, {"limit": 4})
    assert summary.text == "Share: 25 %\nWhich? that"
    assert [row["value"] for row in data(summary)["rows"]] == [25, None]
    with pytest.raises(MocapError, match="Bet 99-which: the answer is no longer right: 'limit > 3' is false"):
        summed_up(bets, {"limit": 2})


def test_what_needs_captured_clips_is_left_open_without_them(tmp_path):
    bets = questions(tmp_path).bets
    bets = {"99-share": bets["share"]._replace(real=True)}
    assert summed_up(bets, {}).text == "Share: "
    assert data(summed_up(bets, {}))["rows"][0]["value"] is None
    with pytest.raises(MocapError, match="Bet 99-share: '100 / limit' fails with ZeroDivisionError"):
        summed_up(bets, {"limit": 0})


def test_an_answer_that_is_no_longer_right_is_an_error(tmp_path):
    quiz = questions(tmp_path).quizzes["more"]._replace(holds="limit > 3")
    assert asked("99-more", quiz, {"limit": np.float64(4)})
    for names, said in [({"limit": 2}, "no longer right"), ({}, "name 'limit' is not defined")]:
        with pytest.raises(MocapError, match=said):
            asked("99-more", quiz, names)


def test_marks_of_text():
    assert to_html("`a*b*c` and *so* 2 * 3 * 4 <x>") == (
        "<code>a*b*c</code> and <em>so</em> 2 * 3 * 4 &lt;x&gt;"
    )
    assert to_text("`a*b*c` and *so* 2 * 3") == "a*b*c and so 2 * 3"
    assert filled("{{x[0:2][1]:.1f}} and {{x[0]}} {y}", {"x": [1, 2]}) == "2.0 and 1 {y}"
    assert computed("x", {"x": np.float32(2)}) == 2


# Data that are not whole


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('kind = "choice"', 'kind = "essay"'),
        ('right = "yes"\n', ""),
        ('ask = "Share"', 'ask = "Share"\nanswer = 3'),
        ("[bet.which]", "[bet.share]"),
        ("[quiz.more]", "[quiz.more"),
    ],
)
def test_what_is_not_whole_is_said_in_a_sentence(old, new, tmp_path):
    assert GOOD.count(old) == 1
    with pytest.raises(MocapError, match=r"^99-test\.toml: .{4,180}$"):
        questions(tmp_path, GOOD.replace(old, new))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: lab.quiz("09-none"), "No quiz 'none' in 09-discussion.toml."),
        (lambda: lab.quiz("none"), "There are no questions for a notebook 'none'."),
        (lambda: lab.quiz("*-none"), r"There are no questions for a notebook '\*'."),
        (lambda: lab.bet("09-none"), "No bet 'none' in 09-discussion.toml."),
        (lambda: lab.bet(), "A bet needs a key"),
        (lambda: lab.bets("99"), "There are no questions for a notebook '99'."),
        (lambda: lab.bets("09"), "Bet 09-transitions-per-step: .* fails with NameError"),
    ],
)
def test_what_is_not_there_is_said(call, said):
    with pytest.raises(MocapError, match=said):
        call()


def test_names_are_those_of_the_caller():
    space = {}
    exec("from mocap.course import lab\ndied, exact = {185: 0.59}, {185: 0.55}\nimport numpy as np", space)
    assert "59 % die; the matrix gives 55 %" in eval("lab.quiz('09-exact-or-sample')", space).text
    assert eval("lab.bet('09-die-at-185')", space).text == "Share of the walks that die at 185: ______ %"


# All files, and the notebooks


def faults(one):  # noqa: C901 (a rule after the other)
    """Say what is wrong with a question: no hint for a wrong answer, no answer, the same choice twice."""
    for field, types in get_type_hints(type(one)).items():
        allowed = [
            kind.__origin__ if hasattr(kind, "__origin__") else kind for kind in get_args(types) or [types]
        ]
        allowed = [get_origin(types)] if get_origin(types) in (list, dict) else allowed
        value = getattr(one, field)
        if type(value) not in [*allowed, *[int] * (float in allowed)] or (value == "" and field != "unit"):
            yield f"{field} cannot be {value!r}"
    texts, different = [], []
    if isinstance(one, Choice):
        texts, different = [*one.wrong, *one.wrong.values()], [one.right, *one.wrong]
        if not one.wrong or not 0 <= one.place <= 1 + len(one.wrong):
            yield "it needs a wrong choice, and a place among the choices"
    elif isinstance(one, Number):
        texts = [hint for _, hint in one.slips]
        if not one.tolerance > 0 or any(type(number) not in (int, float, str) for number, _ in one.slips):
            yield "its tolerance is above 0, and a slip is a number and its hint"
    elif isinstance(one, Order):
        texts, different = [*one.steps, *one.hints], one.steps
        if len(one.steps) < 3 or len(one.hints) != len(one.steps) - 1:
            yield "it needs at least 3 steps, and a hint for each two that follow each other"
    else:
        texts = different = one.choices
        if one.choices and (len(one.choices) < 2 or one.came_out not in one.choices):
            yield "it needs at least 2 choices, of which one came out"
        if not one.step > 0 or (one.low is None) != (one.high is None) or (one.high or 1) <= (one.low or 0):
            yield "a slider goes from low to high, in steps above 0"
    if not all(isinstance(text, str) and text.strip() for text in texts) or len({*different}) < len(
        different
    ):
        yield "something is empty, or there twice"


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_file_is_whole_and_belongs_to_a_notebook(file):
    found = read_questions(file)
    assert found.quizzes or found.bets
    for name, one in {**found.quizzes, **found.bets}.items():
        assert list(faults(one)) == [], name
    assert (FOLDER / f"{file.stem}.ipynb").exists()
    assert file_of(file.stem.partition("-")[0]) == file
    assert re.findall(rf"(?i)\b(?:{UNUSUAL}|{PER})\b", file.read_text("utf-8")) == []  # plain words


def test_the_right_choice_is_not_the_longest_more_often_than_by_chance():
    quizzes = [quiz for file in FILES for quiz in read_questions(file).quizzes.values()]
    choices = [quiz for quiz in quizzes if isinstance(quiz, Choice)]
    longest = sum(len(quiz.right) > max(map(len, quiz.wrong)) for quiz in choices)
    assert longest < sum(1 / (1 + len(quiz.wrong)) for quiz in choices)


def calls(source):
    """List the questions that a cell asks, as pairs of the function's name and a key."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("lab.quiz", "lab.bet", "lab.bets"):
            yield from ((node.func.attr, argument.value) for argument in node.args)


@every_notebook
def test_a_notebook_asks_five_to_eight_quizzes_and_a_bet_for_each_of_its_file(name):
    cells = read(name).cells
    code = [cell for cell in cells if cell.cell_type == "code"]
    found = [pair for cell in code for pair in calls(cell.source)]
    number, all_of_it = name.partition("-")[0], read_questions(TEXTS / f"{name}.toml")
    quizzes = [key for kind, key in found if kind == "quiz"]
    assert 5 <= len(quizzes) <= 8
    assert sorted(quizzes) == sorted(f"{number}-{key}" for key in all_of_it.quizzes)
    assert sorted(key for kind, key in found if kind == "bet") == sorted(
        f"{number}-{key}" for key in all_of_it.bets
    )
    assert [*calls(code[-1].source)] == [("bets", number)]  # when all else has run
    for cell, after in zip(cells, [*cells[1:], SimpleNamespace(source="")], strict=True):
        if "prediction" in cell.metadata.get("tags", ()):
            assert after.source.startswith("lab.bet("), cell.source[:60]
            assert "<details>" not in cell.source
    for cell in code:
        if cell.source.startswith("lab.bet("):
            answer = cells[cells.index(cell) + 1]
            assert "answer" in answer.metadata.get("tags", ())
            assert answer.source.startswith("<details><summary>Answer</summary>\n\n")
