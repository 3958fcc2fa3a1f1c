"""Markdown as paragraphs and sentences: slides and films show the first sentence of each paragraph."""

from __future__ import annotations

import re
from itertools import pairwise

FENCED = re.compile(r"(```.*?```|<details>.*?</details>|\$\$.*?\$\$)", re.DOTALL)
GAP = re.compile(r"\n\s*\n|(?<=\n)(?=#)|^(?=#)")  # between blocks
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
INNER = r"`[^`]*`|\$[^$\n]+\$|\[[^\]]*\](?:\([^)]*\))?|\([^()]*\)"
WHOLE = rf"{INNER}|\((?:{INNER}|[^()])*\)"  # no sentence ends in these
STOP = r"(?:(?<=[^A-Z\s][.!?])|(?<=[.!?]\*)|(?<=[.!?]\*\*))\s+(?=[A-ZÀ-Þ*_`$\[\"“(\d])"
END = re.compile(rf"{WHOLE}|(?P<end>{STOP})")
SHORT = re.compile(r"\b(?:e\.g|i\.e|Eqs?|Figs?|cf|vs|no|pp?)\.$")
ITEM = re.compile(r"^[ \t]*(?:[-*]|\d+\.)[ \t]", re.MULTILINE)
LEAD = 45  # characters of words that lead a paragraph in, such as "Predict."
GREEK = dict(zip((r"\alpha", r"\beta", r"\theta", r"\phi", r"\sigma", r"\pi"), "αβθφσπ", strict=True))
GREEK |= {r"\times": "×", r"\le": "≤", r"\ge": "≥", r"\cdot": "·", r"\,": " ", r"\to": "→"}


def blocks(text: str) -> list[str]:
    r"""Split Markdown into its blocks: headings, paragraphs, lists, formulas, code, folded parts.

    Parameters
    ----------
    text : of a cell.

    Returns
    -------
    The blocks, without comments.

    Examples
    --------
    >>> blocks("## Why\n\nOne. Two.\n\n$$a$$\n\n<details>x\n\ny</details>")
    ['## Why', 'One. Two.', '$$a$$', '<details>x\n\ny</details>']
    """
    parts = FENCED.split(COMMENT.sub("", text))  # each second one is whole
    split = [piece for at, part in enumerate(parts) for piece in ([part] if at % 2 else GAP.split(part))]
    return [piece.strip() for piece in split if piece.strip()]


def sentences(text: str) -> list[str]:
    """Split a paragraph into sentences; code, formulas, links and brackets stay whole.

    Examples
    --------
    >>> sentences("It is 3.5 cm off (see Fig. 4. It is small). Why? Look at `a. B`.")
    ['It is 3.5 cm off (see Fig. 4. It is small).', 'Why?', 'Look at `a. B`.']
    """
    text = " ".join(text.split())
    found = [end for end in END.finditer(text) if end["end"] and not SHORT.search(text, 0, end.start())]
    starts = [0, *(end.end() for end in found)]
    return [text[a:b].rstrip() for a, b in pairwise([*starts, len(text)])]


def shortened(block: str, room: int = 0) -> str:
    r"""Give the first sentence of a paragraph, or of each item of a list; anything else stays whole.

    Parameters
    ----------
    block : from `blocks`.
    room : characters; further sentences of a paragraph that fit in them are given, too.

    Returns
    -------
    Markdown.

    Examples
    --------
    >>> shortened("One is here. Two is there.")
    'One is here.'
    >>> shortened("- one. Two\n- **three**. Four")
    '- one.\n- **three**.'
    """
    if block.startswith(("#", "$$", "```", "<", "|", "!")):
        return block
    if not ITEM.match(block):
        return _first(block, room)
    items = zip(ITEM.findall(block), ITEM.split(block)[1:], strict=True)
    return "\n".join(sign + _first(item) for sign, item in items)


def _first(text: str, room: int = 0) -> str:
    """Give the first sentence; words in bold or italics that lead it in do not count as one."""
    first, *others = sentences(text)
    if first.startswith("*") and first.endswith("*") and len(first) < LEAD and others:
        first += f" {others.pop(0)}"
    for other in others:
        if len(first) + 1 + len(other) > room:
            break
        first += f" {other}"
    for sign in ("**", "*"):  # close emphasis that the next sentence would have closed
        if len(re.findall(rf"(?<!\*){re.escape(sign)}(?!\*)", first)) % 2:
            first += sign
    return first


def spoken(text: str) -> str:
    r"""Give a text as plain words for a caption, or nothing where a formula cannot be written as words.

    Examples
    --------
    >>> spoken("The [*cost*](GLOSSARY.md#cost) of `grid` falls with $\\theta$.")
    'The cost of grid falls with θ.'
    >>> spoken(r"It is $\\frac{1}{2}$.")
    ''
    """
    text = COMMENT.sub("", text)
    for word in sorted(GREEK, key=len, reverse=True):
        text = text.replace(word, GREEK[word])
    if re.search(r"\$[^$]*[\\^_{][^$]*\$|<", text):
        return ""
    text = re.sub(r" ?\[\d+(?:, [^\]]*)?\]", "", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text))
    return " ".join(re.sub(r"[*`$]|(?<!\w)_|_(?!\w)", "", text).split())
