"""Quizzes, which mark themselves, and bets: what a reader thought before the answer, and what came out.

The HTML asks a question as plain text. The script turns it into something to click on; what it needs to
mark an answer stands in an attribute, in base64, so that nobody reads it by accident. The browser keeps bets
in its local storage, under the key of each; so they outlive the kernel, and need none.
"""

from __future__ import annotations

import base64
import html
import json
import re
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from zlib import crc32

from mocap.course.lab.questions import Names, computed, filled, question, read_questions, require
from mocap.errors import MocapError

CODE = re.compile(r"`([^`]+)`")
STRESSED = re.compile(r"(?<![\w*])\*(\S(?:[^*]*\S)?)\*(?![\w*])")
TAG = re.compile(r"<[^>]*>")
LETTERS = "abcdefghij"  # of the choices of a quiz
BLANK = "______"
COLUMNS = ("", "you thought", "came out", "off by")
# The entries of a bet that its file leaves out.
BET: dict[str, Any] = {"choices": [], "unit": "", "low": None, "high": None, "step": 1.0, "real": False}

Bets = Mapping[str, dict[str, Any]]


@dataclass(frozen=True)
class Shown:
    """The output of a cell: HTML, and as text the question.

    Examples
    --------
    >>> Shown("<p>Which is right?</p>", "Which is right?")
    Which is right?
    """

    html: str
    text: str

    def __repr__(self) -> str:
        return self.text

    def _repr_mimebundle_(self, **_: object) -> dict[str, str]:
        return {"text/html": self.html, "text/plain": self.text}


def shown(head: str, inside: str, spec: dict[str, Any], text: Iterable[str]) -> Shown:
    """Pack a question: its heading, its HTML for where no script runs, the script's data, its text."""
    data = base64.b64encode(json.dumps(spec).encode()).decode()
    return Shown(
        f'<div class="mocap-question" data-spec="{data}"><p class="head">{head}</p>\n{inside}\n</div>\n'
        f"<style>{_packed('questions.css')}</style>\n<script>{_packed('questions.js')}</script>",
        "\n".join(text),
    )


@cache
def _packed(name: str) -> str:
    """Read a script or a style, without indents and comments, as each question of a page repeats it."""
    lines = map(str.strip, Path(__file__).with_name(name).read_text("utf-8").splitlines())
    return "\n".join(line for line in lines if line and not line.startswith(("//", "/*", "*")))


def to_html(text: str) -> str:
    """Write a text of a question as HTML.

    Examples
    --------
    >>> to_html("Is `D < 4` *always* so?")
    'Is <code>D &lt; 4</code> <em>always</em> so?'
    """
    parts = CODE.split(html.escape(text, quote=False))
    parts[::2] = [STRESSED.sub(r"<em>\1</em>", part) for part in parts[::2]]
    parts[1::2] = [f"<code>{part}</code>" for part in parts[1::2]]
    return "".join(parts)


def to_text(text: str) -> str:
    """Write a text of a question without its marks.

    Examples
    --------
    >>> to_text("Is `D < 4` *always* so?")
    'Is D < 4 always so?'
    """
    return html.unescape(TAG.sub("", to_html(text)))


def listed(items: Iterable[str], kind: str = "ul") -> str:
    """Write a list of texts as HTML."""
    return f"<{kind}>{''.join(f'<li>{to_html(item)}</li>' for item in items)}</{kind[:2]}>"


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
    MocapError : for an unknown key, an expression that fails, and an answer that is no longer right.

    Examples
    --------
    >>> quiz("09-no-such")
    Traceback (most recent call last):
    mocap.errors.MocapError: No quiz 'no-such' for notebook 09.

    Notebooks: 00-quickstart to 19-group-graphs
    """
    return show_quiz(key, question("quiz", key), sys._getframe(1).f_globals)


def show_quiz(key: str, quiz: dict[str, Any], names: Names) -> Shown:
    """Show a quiz, with the numbers that a notebook computes.

    The right choice is at the quiz's `place`, which counts from 1; by default its key decides.
    """
    try:
        quiz = filled(quiz, names)
        require(quiz, names)
    except MocapError as error:
        raise MocapError(f"Quiz {key}: {error}") from error
    choices = list(quiz["wrong"])
    hints = [to_html(hint) for hint in quiz["wrong"].values()]
    index = quiz["place"] - 1 if quiz.get("place") else crc32(key.encode()) % (1 + len(choices))
    choices.insert(index, quiz["right"])
    hints.insert(index, "")
    inside = f'<p class="asked">{to_html(quiz["question"])}</p>\n' + listed(choices, 'ol type="a"')
    spec = {"kind": "choice", "hints": hints, "because": to_html(quiz["because"])}
    lines = [f"{letter}) {to_text(choice)}" for letter, choice in zip(LETTERS, choices, strict=False)]
    return shown("Quiz: choose one", inside, spec, [to_text(quiz["question"]), *lines])


def bet(*keys: str) -> Shown:
    """Ask what the reader thinks; the answer folded below stays closed until that is entered.

    Parameters
    ----------
    keys : one or more bets of one question, each by the number of the notebook and the name of the bet in its
        file of questions, such as `09-walks-that-die`.

    Returns
    -------
    What a notebook shows as the last line of a cell. The next `<details>` of the page is the answer.

    Raises
    ------
    MocapError : for an unknown key.

    Examples
    --------
    >>> bet("09-no-such")
    Traceback (most recent call last):
    mocap.errors.MocapError: No bet 'no-such' for notebook 09.

    Notebooks: 00-quickstart to 19-group-graphs
    """
    return show_bets({key: question("bet", key) for key in keys}, sys._getframe(1).f_globals)


def show_bets(bets: Bets, names: Names) -> Shown:
    """Show bets, with their controls."""
    specs = []
    lines = []
    for key, table in bets.items():
        bet = BET | table
        ask = filled(bet["ask"], names)
        choices = filled(bet["choices"], names)
        blank = " / ".join(choices) or f"{BLANK} {bet['unit']}".rstrip()
        lines.append(f"{_led(ask)} {blank}")
        spec = {"key": key, "choices": list(map(to_text, choices)), "ask": to_html(ask)}
        specs.append(spec | {name: bet[name] for name in ("unit", "low", "high", "step")})
    inside = listed(lines)
    return shown("Your bet", inside, {"kind": "bets", "bets": specs}, map(to_text, lines))


def bets(notebook: str) -> Shown:
    """Show what the reader thought, and what came out.

    Parameters
    ----------
    notebook : its number, such as `09`. What came out is computed with the names of the caller, so this
        is the last cell of a notebook.

    Returns
    -------
    What a notebook shows as the last line of a cell: a table.

    Raises
    ------
    MocapError : for a notebook without questions, an expression that fails, and an answer that is no longer
        right.

    Examples
    --------
    >>> bets("99")
    Traceback (most recent call last):
    mocap.errors.MocapError: There are no questions for a notebook '99'.

    Notebooks: 00-quickstart to 19-group-graphs
    """
    questions = read_questions(notebook)["bet"]
    with_keys = {f"{notebook}-{name}": bet for name, bet in questions.items()}
    return show_outcomes(with_keys, sys._getframe(1).f_globals)


def show_outcomes(bets: Bets, names: Names) -> Shown:
    """Show a table of bets and their outcomes."""
    rows = [_outcome(key, BET | bet, names) for key, bet in bets.items()]
    head = "".join(f"<th>{column}</th>" for column in COLUMNS)
    body = "".join(
        f'<tr><th scope="row">{row["ask"]}</th><td>–</td><td>{to_html(row["written"])}</td><td>–</td></tr>'
        for row in rows
    )
    inside = f'<table class="table"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
    asks = [html.unescape(TAG.sub("", row["ask"])) for row in rows]
    lines = [f"{_led(ask)} {row['written']}" for ask, row in zip(asks, rows, strict=True)]
    return shown("What you thought, and what came out", inside, {"kind": "summary", "rows": rows}, lines)


def _outcome(key: str, bet: dict[str, Any], names: Names) -> dict[str, Any]:
    """Return a row of the table: the bet's question, the outcome as a number, and as it is written.

    A bet on a captured clip, which a reader may lack, has no outcome where a name is unknown.
    """
    row: dict[str, Any] = {"key": key, "unit": bet["unit"], "step": bet["step"]}
    try:
        row["ask"] = to_html(filled(bet["ask"], names))
        require(bet, names)
        if bet["choices"]:
            return row | {"value": None, "written": to_text(filled(bet["came_out"], names))}
        value = computed(bet["came_out"], names)
    except MocapError as error:
        if bet["real"] and isinstance(error.__cause__, NameError):
            return row | {"ask": to_html(bet["ask"]), "value": None, "written": ""}
        raise MocapError(f"Bet {key}: {error}") from error
    decimals = len(f"{bet['step']:g}".partition(".")[2])
    return row | {"value": value, "written": f"{value:.{decimals}f} {bet['unit']}".rstrip()}


def _led(ask: str) -> str:
    """Return an ask with a colon, which a question does not need."""
    return ask if ask.endswith("?") else f"{ask}:"
