"""Quizzes and bets: their data, what they show, and where they stand in the notebooks."""

import ast
import base64
import json
import re
import tomllib
from types import SimpleNamespace

import numpy as np

from mocap.course import lab
from mocap.course.lab.asking import BET, show_bets, show_outcomes, show_quiz, to_html, to_text
from mocap.course.lab.questions import TEXTS, computed, filled, read_questions
from tests.course.stored_notebooks import FOLDER, every_notebook, read
from tests.course.test_prose import PER, UNUSUAL
from tests.refusals import refusals, refused

FILES = sorted(TEXTS.glob("*.toml"))

GOOD = """
[quiz.more]
question = "Is `D < 4` *always* {{limit:.0f}}?"
right = "yes"
because = "It is."
wrong = { no = "Look again.", "at times" = "Not at times." }

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


QUIZZES, BETS = tomllib.loads(GOOD).values()
YES = {"question": "?", "right": "yes", "wrong": {"no": "x", "never": "y"}, "because": "so"}


def data(shown):
    return json.loads(base64.b64decode(re.search(r'data-spec="([^"]*)"', shown.html)[1]))


def seen(shown):
    """Give what is read where no script runs."""
    return re.sub(r"(?s)<(script|style)>.*?</\1>|<[^>]*>", " ", shown.html)


# What they show


def test_a_choice_shows_its_choices_and_hides_which_is_right():
    shown = show_quiz("99-more", QUIZZES["more"], {"limit": 4.2})
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


def test_the_right_choice_stands_where_it_is_asked_to_and_else_not_always_at_one_place():
    for place in (1, 2, 3):
        assert data(show_quiz("99-more", YES | {"place": place}, {}))["hints"].index("") == place - 1
    places = [data(show_quiz(f"99-{number}", YES, {}))["hints"].index("") for number in range(30)]
    assert set(places) == {0, 1, 2}


def test_a_bet_asks_and_the_summary_says_what_came_out():
    bets = {f"99-{name}": bet for name, bet in BETS.items()}
    shown = show_bets(bets, {})
    assert shown.text == "Share: ______ %\nWhich? this / that"
    assert [one["key"] for one in data(shown)["bets"]] == ["99-share", "99-which"]
    assert "25" not in seen(shown) and "<li>Which? this / that</li>" in shown.html
    summary = show_outcomes(bets, {"limit": 4})
    assert summary.text == "Share: 25 %\nWhich? that"
    assert [row["value"] for row in data(summary)["rows"]] == [25, None]
    refused(
        "99-which: the answer is no longer right: 'limit > 3' is false", show_outcomes, bets, {"limit": 2}
    )


def test_what_needs_captured_clips_is_left_open_without_them():
    bets = {"99-share": BETS["share"] | {"real": True}}
    assert show_outcomes(bets, {}).text == "Share: "
    assert data(show_outcomes(bets, {}))["rows"][0]["value"] is None
    refused("Bet 99-share: '100 / limit' fails with ZeroDivisionError", show_outcomes, bets, {"limit": 0})


def test_an_answer_that_is_no_longer_right_is_an_error():
    quiz = QUIZZES["more"] | {"holds": "limit > 3"}
    assert show_quiz("99-more", quiz, {"limit": np.float64(4)})
    for names, said in [({"limit": 2}, "no longer right"), ({}, "name 'limit' is not defined")]:
        refused(said, show_quiz, "99-more", quiz, names)


def test_marks_of_text():
    assert to_html("`a*b*c` and *so* 2 * 3 * 4 <x>") == (
        "<code>a*b*c</code> and <em>so</em> 2 * 3 * 4 &lt;x&gt;"
    )
    assert to_text("`a*b*c` and *so* 2 * 3") == "a*b*c and so 2 * 3"
    assert filled("{{x[0:2][1]:.1f}} and {{x[0]}} {y}", {"x": [1, 2]}) == "2.0 and 1 {y}"
    assert computed("x", {"x": np.float32(2)}) == 2


# What is not there


test_what_is_not_there_is_said = refusals(
    ("No quiz 'none' for notebook 09.", lab.quiz, "09-none"),
    ("There are no questions for a notebook 'none'.", lab.quiz, "none"),
    (r"There are no questions for a notebook '\*'.", lab.quiz, "*-none"),
    ("No bet 'none' for notebook 09.", lab.bet, "09-none"),
    ("There are no questions for a notebook '99'.", lab.bets, "99"),
    ("Bet 09-transitions-per-step: .* fails with NameError", lab.bets, "09"),
)


def test_names_are_those_of_the_caller():
    space = {}
    exec("import numpy as np\nfrom mocap.course import lab\nf = np.empty((0, 42))", space)
    assert "those that need a look with all 42 numbers" in eval("lab.bet('02c-all-numbers')", space).text
    assert eval("lab.bet('09-die-at-185')", space).text == "Share of the walks that die at 185: ______ %"


# All files, and the notebooks


FIELDS = {  # what each has, and what it may have
    "quiz": ("question right wrong because", "holds place"),
    "bet": ("ask came_out", "choices unit low high step holds real"),
}


def faults(kind, one):
    """Say what is wrong with a question: no hint for a wrong answer, no answer, the same choice twice."""
    must, may = (set(names.split()) for names in FIELDS[kind])
    if not must <= one.keys() <= must | may:
        yield f"it needs {must}, and may have {may}"
    wrong, table = one.get("wrong", {}), BET | one
    different = [*table["choices"], *wrong, *[one.get("right")] * (kind == "quiz")]
    texts = [*(one[name] for name in must - {"came_out", "wrong"}), *different, *wrong.values()]
    if not all(isinstance(text, str) and text.strip() for text in texts):
        yield "something is empty"
    if len({*different}) < len(different):
        yield "something is there twice"
    low, high, choices = table["low"], table["high"], table["choices"]
    whole = {
        "quiz": 0 <= one.get("place", 0) <= 1 + len(wrong) > 1,
        "bet": (not choices or table["came_out"] in choices) and len(choices) != 1 and table["step"] > 0,
    }
    if not whole[kind] or (low is None) != (high is None) or (high or 1) <= (low or 0):
        yield "it has no right answer, or too few wrong ones, hints or places"


def test_each_file_is_whole_and_belongs_to_a_notebook():
    choices = []
    for file in FILES:
        found = read_questions(file.stem.partition("-")[0])
        assert found == {"quiz": {}, "bet": {}} | tomllib.loads(file.read_text("utf-8"))
        assert found.keys() == {"quiz", "bet"}
        for kind, some in found.items():
            for name, one in some.items():
                assert list(faults(kind, one)) == [], (file.stem, name)
        assert (FOLDER / f"{file.stem}.ipynb").exists()
        assert re.findall(rf"(?i)\b(?:{UNUSUAL}|{PER})\b", file.read_text("utf-8")) == []  # plain words
        choices += found["quiz"].values()
    longest = sum(len(quiz["right"]) > max(map(len, quiz["wrong"])) for quiz in choices)
    assert longest < sum(1 / (1 + len(quiz["wrong"])) for quiz in choices)  # not more often than by chance


def calls(source):
    """List the questions that a cell asks, as pairs of the function's name and a key."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("lab.quiz", "lab.bet", "lab.bets"):
            yield from ((node.func.attr, argument.value) for argument in node.args)


@every_notebook
def test_a_notebook_asks_the_quizzes_and_bets_of_its_file(name):
    cells = read(name).cells
    code = [cell for cell in cells if cell.cell_type == "code"]
    found = [pair for cell in code for pair in calls(cell.source)]
    number = name.partition("-")[0]
    all_of_it = read_questions(number)
    quizzes = [key for kind, key in found if kind == "quiz"]
    assert len(quizzes) <= 8
    assert sorted(quizzes) == sorted(f"{number}-{key}" for key in all_of_it["quiz"])
    assert sorted(key for kind, key in found if kind == "bet") == sorted(
        f"{number}-{key}" for key in all_of_it["bet"]
    )
    assert [*calls(code[-1].source)] == [("bets", number)]  # when all else has run
    for cell, after in zip(cells, [*cells[1:], SimpleNamespace(source="")], strict=True):
        if "prediction" in cell.metadata.get("tags", ()):
            assert after.source.startswith("lab.bet(") != ("<details>" in cell.source), cell.source[:60]
    for cell in code:
        if cell.source.startswith("lab.bet("):
            answer = cells[cells.index(cell) + 1]
            assert "answer" in answer.metadata.get("tags", ())
            assert answer.source.startswith("<details><summary>Answer</summary>\n\n")
