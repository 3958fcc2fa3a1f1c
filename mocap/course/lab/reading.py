"""The questions of a notebook, as its file in the folder `texts` has them.

A file has a table `[quiz.NAME]` for each quiz and `[bet.NAME]` for each bet. The fields of a table are those
of the classes below; a quiz also says its `kind`: choice, number or order. In texts, `code` and *stress* are
marked as in Markdown, and `{{expression:.1f}}` is a number that the notebook computes.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

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

    def faults(self) -> Iterator[str]:
        """Say what is wrong with the choices."""
        if not self.wrong:
            yield "it needs a wrong choice."
        if self.right in self.wrong:
            yield "the right choice is among the wrong ones."
        if not 0 <= self.place <= 1 + len(self.wrong):
            yield "its place is not among the choices."
        for choice, hint in self.wrong.items():
            if not _is_text(hint):
                yield f"no hint for the choice '{shortened(choice, 60)}'."


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

    def faults(self) -> Iterator[str]:
        """Say what is wrong with the tolerance and the slips."""
        if not self.tolerance > 0:
            yield "its tolerance is not above 0."
        for slip in self.slips:
            pair = isinstance(slip, list) and len(slip) == 2
            if not (pair and type(slip[0]) in (int, float, str) and _is_text(slip[1])):
                yield "a slip is a pair of a number and its hint."


class Order(NamedTuple):
    """Steps in their right order; each two neighbours have a hint for who has them the wrong way round."""

    question: str
    steps: list[str]
    hints: list[str]
    because: str

    def faults(self) -> Iterator[str]:
        """Say what is wrong with the steps."""
        if not all(map(_is_text, [*self.steps, *self.hints])):
            yield "a step or a hint is no text."
        elif len(set(self.steps)) < max(3, len(self.steps)):
            yield "it needs at least 3 steps, all different."
        if len(self.hints) != len(self.steps) - 1:
            yield "it needs a hint for each two steps that follow each other."


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

    def faults(self) -> Iterator[str]:
        """Say what is wrong with the choices, or with the slider."""
        if not all(map(_is_text, self.choices)):
            yield "a choice is no text."
        elif self.choices and len(set(self.choices)) < max(2, len(self.choices)):
            yield "it needs at least 2 choices, all different."
        if self.choices and self.came_out not in self.choices:
            yield f"what came out is none of its choices: {shortened(repr(self.came_out), 60)}."
        if not self.step > 0 or (self.low is None) != (self.high is None):
            yield "a slider goes from low to high, in steps above 0."
        if self.low is not None and self.high is not None and not self.low < self.high:
            yield "a slider's low is below its high."


Quiz = Choice | Number | Order
KINDS: dict[str, type[Quiz]] = {"choice": Choice, "number": Number, "order": Order}
FITTING: dict[Any, tuple[type, ...]] = {
    str: (str,),
    bool: (bool,),
    int: (int,),
    float: (int, float),
    float | None: (int, float),
    float | str: (int, float, str),
    dict[str, str]: (dict,),
    list[str]: (list,),
    list[list[Any]]: (list,),
}


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
    MocapError : for an unknown key, and a file that is not whole.
    """
    notebook, _, name = key.partition("-")
    file = file_of(notebook)
    all_of_it = read_questions(file)
    found: Mapping[str, Quiz | Bet] = all_of_it.quizzes if kind == "quiz" else all_of_it.bets
    if name not in found:
        raise MocapError(f"No {kind} {shortened(repr(name), 40)} in {file.name}.")
    return found[name]


def read_questions(file: Path) -> Questions:
    """Read a file of questions.

    Raises
    ------
    MocapError : for a file that is not TOML, and for a question that lacks something or has something
        unknown: no right answer, a wrong choice without a hint, the same choice twice.
    """
    try:
        tables = tomllib.loads(file.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise MocapError(f"{file.name}: {shortened(str(error), 140)}.") from error
    for kind in sorted(tables.keys() - {"quiz", "bet"}):
        raise MocapError(f"{file.name}: a table is called quiz.NAME or bet.NAME, got '{shortened(kind)}'.")
    if not all(isinstance(table, dict) for table in tables.values()):
        raise MocapError(f"{file.name}: quiz and bet are tables of tables.")
    try:
        return Questions(
            {name: _quiz(name, table) for name, table in tables.get("quiz", {}).items()},
            {name: _checked(f"bet.{name}", table, Bet) for name, table in tables.get("bet", {}).items()},
        )
    except MocapError as error:
        raise MocapError(f"{file.name}, {error}") from error


def _quiz(name: str, table: Any) -> Quiz:  # noqa: ANN401 (as the file has it)
    kind = table.get("kind") if isinstance(table, dict) else None
    if not isinstance(kind, str) or kind not in KINDS:
        raise MocapError(f"quiz.{shortened(name, 40)}: a quiz has a kind: {', '.join(KINDS)}.")
    quiz: Quiz = _checked(f"quiz.{name}", {key: table[key] for key in table if key != "kind"}, KINDS[kind])
    return quiz


def _checked(name: str, table: Any, kind: type[Any]) -> Any:  # noqa: ANN401 (as the file has it)
    """Make a question of a table that has all fields of its class that are needed, each of its type."""
    name = shortened(name, 40)
    if not isinstance(table, dict):
        raise MocapError(f"{name}: is a table, got {shortened(repr(table), 60)}.")
    for field in sorted(table.keys() - set(kind._fields)):
        raise MocapError(f"{name}: no field '{shortened(field, 30)}'; there are {', '.join(kind._fields)}.")
    types = get_type_hints(kind)
    for field in kind._fields:
        if field not in table and field not in kind._field_defaults:
            raise MocapError(f"{name}: '{field}' is missing.")
        if field in table and type(table[field]) not in FITTING[types[field]]:
            raise MocapError(f"{name}: '{field}' cannot be {shortened(repr(table[field]), 60)}.")
        if table.get(field) == "" and field != "unit":
            raise MocapError(f"{name}: '{field}' is empty.")
    question = kind(**table)
    for fault in question.faults():
        raise MocapError(f"{name}: {fault}")
    return question


def _is_text(value: object) -> bool:
    return isinstance(value, str) and value.strip() != ""
