"""A question with an answer, marked at once, with a hint for each wrong answer."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any
from zlib import crc32

from mocap.course.lab.computed import all_filled, names_of_cell, rounded
from mocap.course.lab.page import BLANK, Shown, listed, shown, to_html, to_text
from mocap.course.lab.reading import Choice, Number, Order, Quiz, question
from mocap.errors import MocapError

HEADS = {Choice: "Quiz: choose one", Number: "Quiz: a number", Order: "Quiz: put in order"}


def quiz(key: str) -> Shown:
    """Ask a question that marks itself in the page.

    Parameters
    ----------
    key : the number of the notebook and the name of the quiz in its file of questions, such as
        `05-more-edges`. Expressions in the question are computed with the names of the caller.

    Returns
    -------
    What a notebook shows as the last line of a cell: the question, and its choices. The answer is in the page
    as data only.

    Raises
    ------
    MocapError : for an unknown key, a question that is not whole, an expression that fails, and an answer
        that is no longer right.

    Examples
    --------
    >>> quiz("09-no-such")
    Traceback (most recent call last):
    mocap.errors.MocapError: No quiz 'no-such' in 09-discussion.toml.

    Notebooks: 00-quickstart to 19-group-graphs
    """
    return asked(key, question("quiz", key), names_of_cell())


def asked(key: str, quiz: Quiz, names: Mapping[str, object]) -> Shown:
    """Show a quiz, with the numbers that a notebook computes."""
    try:
        quiz = all_filled(quiz, names)
        items, spec = _parts(key, quiz, names)
    except MocapError as error:
        raise MocapError(f"Quiz {key}: {error}") from error
    spec |= {"because": to_html(quiz.because)}
    kind = "ol" if isinstance(quiz, Choice) else "ul"
    inside = f'<p class="asked">{to_html(quiz.question)}</p>\n{listed(map(to_html, items), kind)}'
    marks = "abcdefghij" if isinstance(quiz, Choice) else "-" * len(items)
    text = [f"{mark}{')' * (mark != '-')} {to_text(item)}" for mark, item in zip(marks, items, strict=False)]
    return shown(HEADS[type(quiz)], inside, spec, [to_text(quiz.question), *text])


def _parts(key: str, quiz: Quiz, names: Mapping[str, object]) -> tuple[list[str], dict[str, Any]]:
    """Give what is listed below the question, and the script's data."""
    if isinstance(quiz, Number):
        return [f"{BLANK} {quiz.unit}".rstrip()], _number(quiz, names)
    return _choice(key, quiz) if isinstance(quiz, Choice) else _order(key, quiz)


def _choice(key: str, quiz: Choice) -> tuple[list[str], dict[str, Any]]:
    place = quiz.place - 1 if quiz.place else crc32(key.encode()) % (1 + len(quiz.wrong))
    choices, hints = list(quiz.wrong), [to_html(hint) for hint in quiz.wrong.values()]
    choices.insert(place, quiz.right)
    hints.insert(place, "")
    return choices, {"kind": "choice", "hints": hints}


def _number(quiz: Number, names: Mapping[str, object]) -> dict[str, Any]:
    return {
        "kind": "number",
        "answer": rounded(quiz.answer, names),
        "tolerance": quiz.tolerance,
        "slips": [[rounded(number, names), to_html(hint)] for number, hint in quiz.slips],
        "low": to_html(quiz.too_low),
        "high": to_html(quiz.too_high),
        "unit": quiz.unit,
    }


def _order(key: str, quiz: Order) -> tuple[list[str], dict[str, Any]]:
    right = list(range(len(quiz.steps)))
    mixed, draw = right.copy(), random.Random(key)
    while mixed == right:
        draw.shuffle(mixed)
    spec = {"kind": "order", "order": mixed, "hints": [to_html(hint) for hint in quiz.hints]}
    return [quiz.steps[number] for number in mixed], spec
