"""Numbers in the prose of a notebook, each with the expression that computes it.

A marked number is followed by a comment, which no page shows: `2.8<!--= 100 * off.mean() -->`. The expression
is worked out with the notebook's names after all of its cells have run, and must give the number to the
digits shown. With `~` instead of `=` the number is approximate: within a tenth of the value. So `course run`
writes today's values into the text, and a test fails when text and output part.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

ABOUT = 0.1  # an approximate number is within this share of its value

_SHOWN = r"[-−]?(?:\d{1,3}(?: \d{3})+|\d+)(?:\.\d+)?"
_MARK = re.compile(rf"(?P<shown>{_SHOWN})?<!--(?P<kind>[=~])\s*(?P<expression>.+?)\s*-->", re.DOTALL)


class Marked(NamedTuple):
    """A number in prose: how it is shown, whether it is approximate, and the expression that computes it."""

    shown: str
    is_approximate: bool
    expression: str

    def written(self, value: float) -> str:
        """Write a value as this number is written, with as many decimals.

        Examples
        --------
        >>> Marked("17 000", False, "count").written(17421.0)
        '17 421'
        """
        _, _, decimals = self.shown.partition(".")
        gap = " " if abs(value) >= 10_000 or " " in self.shown else ""
        text = f"{value:,.{len(decimals)}f}".replace(",", gap)
        return text.replace("-", "−") if "−" in self.shown else text

    def agrees(self, value: float) -> bool:
        """Say whether the number is the value, to the digits shown.

        Examples
        --------
        >>> Marked("2.8", False, "cm").agrees(2.84), Marked("2.8", False, "cm").agrees(2.86)
        (True, False)
        >>> Marked("100", True, "ratio").agrees(109.0)
        True
        """
        if self.is_approximate:
            return abs(value - _number(self.shown)) <= ABOUT * abs(value)
        return self.written(value) == self.shown or _number(self.written(value)) == _number(self.shown)


def _number(shown: str) -> float:
    return float(shown.replace(" ", "").replace("−", "-"))


def marked(text: str) -> Iterator[Marked]:
    """Yield the marked numbers of some Markdown.

    Raises
    ------
    ValueError : for a mark that follows no number.

    Examples
    --------
    >>> list(marked("It is 2.8<!--= 100 * off --> cm off."))
    [Marked(shown='2.8', is_approximate=False, expression='100 * off')]
    """
    for match in _MARK.finditer(text):
        if not match["shown"]:
            raise ValueError(f"No number stands directly before {match[0][:80]}")
        yield Marked(match["shown"], match["kind"] == "~", match["expression"])


def values_of(expressions: Iterable[str], names: Mapping[str, object]) -> dict[str, float | str]:
    """Work out expressions with the names of a notebook; one that fails gives its error as text.

    Examples
    --------
    >>> values_of(["100 * off", "gone"], {"off": 0.028})
    {'100 * off': 2.8000000000000003, 'gone': "NameError: name 'gone' is not defined"}
    """
    values: dict[str, float | str] = {}
    for expression in expressions:
        try:
            values[expression] = float(eval(expression, dict(names)))
        except Exception as error:
            values[expression] = f"{type(error).__name__}: {error}"
    return values


def wrong(text: str, values: Mapping[str, float | str]) -> list[str]:
    """List, in sentences, the marked numbers of a text that are not their values.

    Examples
    --------
    >>> wrong("It is 2.8<!--= off --> cm off.", {"off": 3.1})
    ["The text says 2.8; 'off' gives 3.1."]
    """
    sentences = []
    for mark in marked(text):
        value = values[mark.expression]
        if isinstance(value, str) or not mark.agrees(value):
            computed = value if isinstance(value, str) else f"{value:.6g}"
            sentences.append(f"The text says {mark.shown}; {mark.expression!r} gives {computed}.")
    return sentences


def compare(texts: Iterable[str], names: Mapping[str, object]) -> None:
    """Raise a ValueError that lists the marked numbers of some texts that are not their values.

    Examples
    --------
    >>> compare(["It is 2.8<!--= off --> cm off."], {"off": 2.8})
    """
    text = "\n".join(texts)
    if sentences := wrong(text, values_of((mark.expression for mark in marked(text)), names)):
        raise ValueError("\n".join(sentences))


def refreshed(text: str, values: Mapping[str, float | str]) -> str:
    """Write today's values into a text; what agrees, and what has no value, stays as it is.

    Examples
    --------
    >>> refreshed("It is 2.8<!--= off --> cm off.", {"off": 3.1})
    'It is 3.1<!--= off --> cm off.'
    """

    def new(match: re.Match[str]) -> str:
        (mark,) = marked(match[0])
        value = values.get(mark.expression, "")
        if isinstance(value, str) or mark.agrees(value):
            return match[0]
        return mark.written(value) + match[0][len(mark.shown) :]

    return _MARK.sub(new, text)


def question(texts: Iterable[str]) -> str:
    """Return the code of a cell that prints the values of all marked numbers of some texts, as JSON."""
    expressions = sorted({mark.expression for mark in marked("\n".join(texts))})
    work = f"marked_values.values_of({expressions!r}, globals())"
    return f"import json\nfrom mocap.course import marked_values\nprint(json.dumps({work}))"
