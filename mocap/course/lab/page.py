"""What a question shows in a browser, and where no script runs.

The HTML asks the question as plain text. The script turns it into something to click on; what it needs to
mark an answer stands in an attribute, in base64, so that nobody reads it by accident.
"""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

CODE = re.compile(r"`([^`]+)`")
STRESSED = re.compile(r"(?<![\w*])\*(\S(?:[^*]*\S)?)\*(?![\w*])")
BLANK = "______"


@dataclass(frozen=True)
class Shown:
    """What a cell shows: HTML, and as text what is asked.

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
    return "\n".join(line for line in lines if line and not line.startswith("//"))


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
    parts = CODE.split(text)
    parts[::2] = [STRESSED.sub(r"\1", part) for part in parts[::2]]
    return "".join(parts)


def listed(items: Iterable[str], kind: str = "ul") -> str:
    """Write a list of texts as HTML."""
    return f"<{kind}>{''.join(f'<li>{to_html(item)}</li>' for item in items)}</{kind[:2]}>"
