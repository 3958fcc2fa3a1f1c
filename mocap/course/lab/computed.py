"""Numbers of a question that the notebook computes, so that they are never those of another day."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from typing import Any

from mocap.course.lab.reading import Choice, Quiz
from mocap.errors import MocapError, shortened

Names = Mapping[str, object]
PLACE = re.compile(r"\{\{(.+?)(?::([-+.,\d]*[a-z%]?))?\}\}")


def names_of_cell() -> Names:
    """Give the names of the notebook whose cell called the function that calls this one."""
    return sys._getframe(2).f_globals


def computed(expression: float | str, names: Names) -> float:
    """Work out a number with the names of a notebook.

    Raises
    ------
    MocapError : where that fails; the error that it failed with is its cause.

    Examples
    --------
    >>> computed("100 * off", {"off": 0.25}), computed(3, {})
    (25.0, 3.0)
    >>> computed("off", {})
    Traceback (most recent call last):
    mocap.errors.MocapError: 'off' fails with NameError: name 'off' is not defined.
    """
    try:
        return float(eval(expression, dict(names)) if isinstance(expression, str) else expression)
    except Exception as error:
        reason = f"{type(error).__name__}: {shortened(str(error), 60)}"
        raise MocapError(f"{shortened(repr(expression), 60)} fails with {reason}.") from error


def rounded(expression: float | str, names: Names) -> float:
    """Work out a number to six digits, which are the same on every machine.

    Examples
    --------
    >>> rounded("1 / n", {"n": 3})
    0.333333
    """
    return float(f"{computed(expression, names):.6g}")


def filled(text: str, names: Names) -> str:
    """Put numbers into a text, as in `{{100 * off:.1f}} cm`.

    Examples
    --------
    >>> filled("It is {{100 * off:.1f}} cm off, below {{limit}}.", {"off": 0.028, "limit": 3})
    'It is 2.8 cm off, below 3.'
    """
    return PLACE.sub(lambda found: format(computed(found[1], names), found[2] or "g"), text)


def require(expression: str, names: Names) -> None:
    """Raise a MocapError if what an answer rests on is no longer true.

    Examples
    --------
    >>> require("more > 2 * fewer", {"more": 9, "fewer": 4})
    """
    if not computed(expression, names):
        raise MocapError(f"the answer is no longer right: {shortened(repr(expression), 100)} is false.")


def all_filled(quiz: Quiz, names: Names) -> Quiz:
    """Put numbers into all texts of a quiz, and check what its answer rests on."""

    def into(value: Any) -> Any:  # noqa: ANN401 (text, or what holds texts, or else)
        if isinstance(value, str):
            return filled(value, names)
        if isinstance(value, dict):
            return {into(key): into(hint) for key, hint in value.items()}
        return [into(part) for part in value] if isinstance(value, list) else value

    if isinstance(quiz, Choice):
        require(quiz.holds, names)
    return quiz._replace(**{field: into(getattr(quiz, field)) for field in quiz._fields})
