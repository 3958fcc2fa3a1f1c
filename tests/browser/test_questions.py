"""Quizzes and bets on the site, which has no Python; test_lab.py has them in JupyterLab."""

from contextlib import contextmanager
from functools import partial

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from tests.browser.conftest import keep, wait_until, watched_page, without_scripts
from tests.course.test_site import build_small

START = """
from mocap.course.lab.asking import show_quiz, show_bets, show_outcomes

share = {"ask": "Share of the walks", "came_out": "100 * died", "unit": "%", "low": 0, "high": 100}
more = {"ask": "How many turn?", "came_out": "twice", "choices": ["as many", "twice"]}
off = {"ask": "Off the path", "came_out": "3.25", "unit": "cm", "step": 0.1}
died = 0.6
which = {"question": "Which?", "right": "the *right* one"}
which |= {"wrong": {"another": "Look at its name."}, "because": "As it says."}
"""
ANSWER = "<details><summary>Answer</summary>\n\n{}\n\n</details>"
CELLS = [
    "# Questions",
    START,
    "**Predict.** Which share dies, and how many turn?",
    "show_bets({'99-share': share, '99-more': more}, {})",
    ANSWER.format("Most of them do."),
    ANSWER.format("No bet guards this one."),
    "show_bets({'99-off': off}, {})",
    ANSWER.format("A little."),
    "show_quiz('99-c', which, {})",
    "show_outcomes({'99-share': share, '99-more': more, '99-off': off}, {'died': died})",
]


def cell(text, outputs=()):
    if text.startswith(("#", "*", "<")):
        return new_markdown_cell(text)
    return new_code_cell(text, outputs=list(outputs))


def on_the_site(tmp_path, page):
    if not (tmp_path / "out").exists():
        space, cells = {}, []
        exec(START, space)
        for text in CELLS:
            outputs = []
            if text.startswith("show_"):
                outputs = [new_output("execute_result", eval(text, space)._repr_mimebundle_())]
            cells.append(cell(text, outputs))
        nbformat.write(new_notebook(cells=cells), tmp_path / "00-one.ipynb")
        (tmp_path / "teaching").mkdir()
        build_small(tmp_path, tmp_path / "out")
    page.goto((tmp_path / "out" / "00-one.html").as_uri())


@contextmanager
def asking(browser, show):
    """Yield a page on which `show` shows the questions, a function that does so anew, and one of a number."""
    with watched_page(browser) as (page, faults):

        def again():
            show(page)
            wait_until(lambda: page.locator(".mocap-question[data-awake]").count() == 4)

        again()
        yield page, again, lambda number: page.locator(".mocap-question").nth(number)
        keep(page, "questions")
    assert faults == []


@pytest.fixture(scope="module")
def opened(browser, tmp_path_factory):
    """Show the questions on the site."""
    with asking(browser, partial(on_the_site, tmp_path_factory.mktemp("questions"))) as questions:
        yield questions


def test_an_answer_opens_when_a_bet_is_kept_and_the_page_remembers(opened):
    page, again, question = opened
    bet, summary = question(0), question(3)
    answers = page.locator("details")
    is_open = [lambda n=n: answers.nth(n).get_attribute("open") is not None for n in range(3)]
    answers.nth(0).locator("summary").click()
    assert "opens when you have kept a bet" in bet.get_by_role("status").inner_text()
    assert not is_open[0]()
    answers.nth(1).locator("summary").click()
    wait_until(is_open[1])  # no bet guards it
    bet.get_by_role("button", name="Keep my bet").click()
    assert bet.get_by_role("status").inner_text() == "Something is not entered yet."
    slider = bet.get_by_role("slider", name="Share of the walks")
    slider.focus()
    slider.press("Home")
    slider.press("ArrowRight")
    assert slider.get_attribute("aria-valuetext") == "1 %"
    bet.get_by_role("button", name="twice").press("Enter")
    bet.get_by_role("button", name="Keep my bet").press("Enter")
    wait_until(is_open[0])
    assert "Share of the walks: 1 %" in bet.inner_text()
    field = question(1).get_by_role("textbox", name="Off the path, in cm")
    field.fill("2,5 cm")
    field.press("Enter")
    wait_until(is_open[2])
    again()
    assert "Share of the walks: 1 %" in bet.inner_text()
    assert "How many turn? twice" in bet.inner_text()
    rows = [row.inner_text().split("\t") for row in summary.locator("tbody tr").all()]
    assert rows == [
        ["Share of the walks", "1 %", "60 %", "59 %"],
        ["How many turn?", "twice", "twice", "✓ right"],
        ["Off the path", "2.5 cm", "3.2 cm", "0.8 cm"],
    ]
    assert "You have kept 3 of 3 bets." in summary.inner_text()
    summary.get_by_role("button", name="Remove these bets").click()
    assert bet.get_by_role("button", name="Keep my bet").is_visible()
    bet.get_by_role("button", name="no bet").click()
    wait_until(is_open[0])
    assert "Share of the walks: no bet" in bet.inner_text()


def test_quizzes_mark_themselves(opened):
    _, _, question = opened
    said = question(2).get_by_role("status").inner_text
    question(2).get_by_role("button", name="another").click()
    assert said() == "✗ Not yet. Look at its name."
    right = question(2).get_by_role("button", name="the right one")
    right.press("Enter")
    assert said() == "✓ Right. As it says."
    assert right.get_attribute("aria-pressed") == "true"


@without_scripts
def test_without_a_script_only_what_is_asked_is_seen(page, tmp_path):
    on_the_site(tmp_path, page)
    text = " ".join(page.locator(".mocap-question, details").all_inner_texts())
    assert "as many / twice" in text
    assert "the right one" in text
    for hidden in ("As it says", "Look at its name", "Most of them do."):
        assert hidden not in text
