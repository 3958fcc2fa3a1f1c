"""The questions of a notebook, as its file in the folder `texts` has them, with numbers that it computes.

A file has a table `[quiz.NAME]` for each quiz and `[bet.NAME]` for each bet; the tests hold that each is
whole. In texts, `code` and *stress* are marked as in Markdown, and `{{expression:.1f}}` is a number that the
notebook computes, so that it is never one of another day.

A quiz has a `question`; the `right` choice; `wrong`, with a hint for each other choice; `because`, which says
why the right answer is right; `holds`, an expression that is true while it is; and `place`, where the right
choice stands, from 1, if not anywhere.

A bet has `ask`, and `came_out`: one of its `choices`, or an expression for a number in its `unit`. With
`low` and `high` it is a slider by `step`, to whose decimals numbers are written. It may have `holds`. What is
`real` needs captured clips.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mocap.errors import MocapError, shortened

Names = Mapping[str, object]
TEXTS = Path(__file__).with_name("texts")
PLACE = re.compile(r"\{\{(.+?)(?::([-+.,\d]*[a-z%]?))?\}\}")


def read_questions(notebook: str) -> dict[str, dict[str, Any]]:
    """Read the questions of a notebook by its number, such as 04b: {"quiz": {...}, "bet": {...}}.

    Raises
    ------
    MocapError : where there are none.
    """
    files = sorted(TEXTS.glob(f"{notebook}-*.toml")) if notebook.isalnum() else []
    if not files:
        raise MocapError(f"There are no questions for a notebook {shortened(repr(notebook), 30)}.")
    return {"quiz": {}, "bet": {}} | tomllib.loads(files[0].read_text("utf-8"))


def question(kind: str, key: str) -> dict[str, Any]:
    """Find a quiz or a bet by its key: the number of the notebook, and its name in the notebook's file.

    Raises
    ------
    MocapError : for an unknown key.
    """
    notebook, _, name = key.partition("-")
    questions = read_questions(notebook)[kind]
    if name not in questions:
        raise MocapError(f"No {kind} {shortened(repr(name), 40)} for notebook {notebook}.")
    return dict(questions[name])


def computed(expression: str, names: Names) -> float:
    """Work out a number with the names of a notebook, to six digits, which are the same on every machine.

    Raises
    ------
    MocapError : where that fails; the error that it failed with is its cause.

    Examples
    --------
    >>> computed("1 / n", {"n": 3})
    0.333333
    >>> computed("off", {})
    Traceback (most recent call last):
    mocap.errors.MocapError: 'off' fails with NameError: name 'off' is not defined.
    """
    try:
        return float(f"{float(eval(expression, dict(names))):.6g}")
    except Exception as error:
        reason = f"{type(error).__name__}: {shortened(str(error), 60)}"
        raise MocapError(f"{shortened(repr(expression), 60)} fails with {reason}.") from error


def filled(value: Any, names: Names) -> Any:  # noqa: ANN401 (a text, or what holds texts)
    """Put numbers into a text, as in `{{100 * off:.1f}} cm`, or into all texts of a question.

    Examples
    --------
    >>> filled("It is {{100 * off:.1f}} cm off, below {{limit}}.", {"off": 0.028, "limit": 3})
    'It is 2.8 cm off, below 3.'
    """
    if isinstance(value, str):
        return PLACE.sub(lambda match: format(computed(match[1], names), match[2] or "g"), value)
    if isinstance(value, dict):
        return {filled(key, names): filled(part, names) for key, part in value.items()}
    return [filled(part, names) for part in value] if isinstance(value, list) else value


def require(question_texts: Mapping[str, Any], names: Names) -> None:
    """Raise a MocapError if what an answer rests on is no longer true.

    Examples
    --------
    >>> require({"holds": "more > 2 * fewer"}, {"more": 9, "fewer": 4})
    """
    expression = question_texts.get("holds", "True")
    if not computed(expression, names):
        raise MocapError(f"the answer is no longer right: {shortened(repr(expression), 100)} is false.")
