"""The questions of a notebook, as its file in the folder `texts` has them.

A file has a table `[quiz.NAME]` for each quiz and `[bet.NAME]` for each bet. The fields of a table are those
of the classes below; a quiz also says its `kind`: choice, number or order. In texts, `code` and *stress* are
marked as in Markdown, and `{{expression:.1f}}` is a number that the notebook computes.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from mocap.errors import MocapError, shortened

TEXTS = Path(__file__).with_name("texts")
TRUE = "True"  # what holds always


class Choice(NamedTuple):
    """One choice is right; `wrong` has a hint for each other one.

    `because` says why the right one is right. `holds` is an expression that is true while it is; `place` is
    where the right one stands, from 1, if not anywhere.
    """

    question: str
    right: str
    wrong: dict[str, str]
    because: str
    holds: str = TRUE
    place: int = 0


class Number(NamedTuple):
    """A number within a tolerance of the answer is right; `slips` are pairs of a wrong number and its hint.

    An answer, and the number of a slip, may be an expression. Other wrong numbers are `too_low` or
    `too_high`.
    """

    question: str
    answer: float | str
    tolerance: float
    too_low: str
    too_high: str
    because: str
    unit: str = ""
    slips: list[list[Any]] = []  # noqa: RUF012 (nothing appends to it)


class Order(NamedTuple):
    """Steps in their right order; each two neighbours have a hint for who has them the wrong way round."""

    question: str
    steps: list[str]
    hints: list[str]
    because: str


class Bet(NamedTuple):
    """Something to predict: one of `choices`, or else a number; with `low` and `high` it is a slider.

    `came_out` is one of the choices, or an expression for the number, in the same `unit`. `step` is the
    slider's, and to its decimals numbers are written. What is `real` needs captured clips.
    """

    ask: str
    came_out: float | str
    choices: list[str] = []  # noqa: RUF012 (nothing appends to it)
    unit: str = ""
    low: float | None = None
    high: float | None = None
    step: float = 1.0
    holds: str = TRUE
    real: bool = False


Quiz = Choice | Number | Order
KINDS: dict[str, type[Quiz]] = {"choice": Choice, "number": Number, "order": Order}


class Questions(NamedTuple):
    """What a file holds, by name."""

    quizzes: dict[str, Quiz]
    bets: dict[str, Bet]


def file_of(notebook: str, folder: Path = TEXTS) -> Path:
    """Find the file of a notebook by its number, such as 04b."""
    found = sorted(folder.glob(f"{notebook}-*.toml")) if notebook.isalnum() else []
    if not found:
        raise MocapError(f"There are no questions for a notebook {shortened(repr(notebook), 30)}.")
    return found[0]


def question(kind: str, key: str) -> Any:  # noqa: ANN401 (a Quiz or a Bet)
    """Find a quiz or a bet by its key: the number of the notebook, and its name in the notebook's file.

    Raises
    ------
    MocapError : for an unknown key.
    """
    notebook, _, name = key.partition("-")
    file = file_of(notebook)
    all_of_it = read_questions(file)
    found: Mapping[str, Quiz | Bet] = all_of_it.quizzes if kind == "quiz" else all_of_it.bets
    if name not in found:
        raise MocapError(f"No {kind} {shortened(repr(name), 40)} in {file.name}.")
    return found[name]


def read_questions(file: Path) -> Questions:
    """Read a file of questions; the tests hold that each has an answer, and a hint for each wrong one.

    Raises
    ------
    MocapError : for a file that is not TOML, and for a question that lacks a field or has an unknown one.
    """
    try:
        tables = tomllib.loads(file.read_text("utf-8"))
        quizzes = {name: dict(table) for name, table in tables.get("quiz", {}).items()}
        return Questions(
            {name: KINDS[table.pop("kind")](**table) for name, table in quizzes.items()},
            {name: Bet(**table) for name, table in tables.get("bet", {}).items()},
        )
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise MocapError(f"{file.name}: {shortened(str(error), 140)}.") from error
