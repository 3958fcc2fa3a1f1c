"""What a reader thought before the answer, and what came out.

The browser keeps bets in its local storage, under the key of each; so they outlive the kernel, and need none.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from html import unescape
from typing import Any

from mocap.course.lab.computed import filled, names_of_cell, require, rounded
from mocap.course.lab.page import BLANK, Shown, listed, shown, to_html, to_text
from mocap.course.lab.reading import Bet, file_of, question, read_questions
from mocap.errors import MocapError

COLUMNS = ("", "you thought", "came out", "off by")


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
    MocapError : for an unknown key, and a bet that is not whole.

    Examples
    --------
    >>> bet("09-no-such")
    Traceback (most recent call last):
    mocap.errors.MocapError: No bet 'no-such' in 09-discussion.toml.

    Notebooks: 00-quickstart to 19-group-graphs
    """
    if not keys:
        raise MocapError("A bet needs a key, such as '09-walks-that-die'.")
    return asked_before({key: question("bet", key) for key in keys}, names_of_cell())


def asked_before(bets: Mapping[str, Bet], names: Mapping[str, object]) -> Shown:
    """Show bets, with their controls."""
    specs, lines = [], []
    for key, bet in bets.items():
        ask, choices = filled(bet.ask, names), [filled(choice, names) for choice in bet.choices]
        lines.append(f"{_led(ask)} {' / '.join(choices) or f'{BLANK} {bet.unit}'.rstrip()}")
        specs.append(
            {"key": key, "choices": [to_text(choice) for choice in choices]}
            | {"ask": to_html(ask), "unit": bet.unit, "low": bet.low, "high": bet.high, "step": bet.step}
        )
    inside = listed(map(to_html, lines))
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
    found = read_questions(file_of(notebook)).bets
    return summed_up({f"{notebook}-{name}": bet for name, bet in found.items()}, names_of_cell())


def summed_up(bets: Mapping[str, Bet], names: Mapping[str, object]) -> Shown:
    """Show what came out of bets, as a table."""
    rows = [_came_out(key, bet, names) for key, bet in bets.items()]
    head = "".join(f"<th>{column}</th>" for column in COLUMNS)
    body = "".join(
        f'<tr><th scope="row">{row["ask"]}</th><td>–</td><td>{to_html(row["written"])}</td><td>–</td></tr>'
        for row in rows
    )
    inside = f'<table class="table"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
    text = [f"{_led(_plain(row['ask']))} {row['written']}" for row in rows]
    return shown("What you thought, and what came out", inside, {"kind": "summary", "rows": rows}, text)


def _came_out(key: str, bet: Bet, names: Mapping[str, object]) -> dict[str, Any]:
    row: dict[str, Any] = {"key": key, "unit": bet.unit, "step": bet.step}
    try:
        row["ask"] = to_html(filled(bet.ask, names))
        require(bet.holds, names)
        if bet.choices:
            return row | {"value": None, "written": to_text(filled(str(bet.came_out), names))}
        value = rounded(bet.came_out, names)
    except MocapError as error:
        if bet.real and isinstance(error.__cause__, NameError):
            return row | {"ask": to_html(bet.ask), "value": None, "written": ""}
        raise MocapError(f"Bet {key}: {error}") from error
    decimals = len(f"{bet.step:g}".partition(".")[2])
    return row | {"value": value, "written": f"{value:.{decimals}f} {bet.unit}".rstrip()}


def _led(ask: str) -> str:
    """Write what is asked as it leads to what follows; a question needs no colon."""
    return ask if ask.endswith("?") else f"{ask}:"


def _plain(html: str) -> str:
    return unescape(re.sub(r"<[^>]*>", "", html))
