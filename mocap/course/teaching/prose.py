"""Markdown as paragraphs and sentences: slides and films show the first sentence of each paragraph."""

from __future__ import annotations

import re

FENCED = re.compile(r"```.*?```|<details>.*?</details>|\$\$.*?\$\$", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
KEPT = re.compile(r"`[^`]*`|\$[^$\n]+\$|\[[^\]]*\](?:\([^)]*\))?|\([^()]*\)")  # no sentence ends in these
END = re.compile(r"(?:(?<=[^A-Z\s][.!?])|(?<=[.!?]\*)|(?<=[.!?]\*\*))\s+(?=[A-ZÀ-Þ*_`$\[\"“(\d\x00])")
SHORT = re.compile(r"\b(?:e\.g|i\.e|Eqs?|Figs?|cf|vs|no|pp?)\.$")
ITEM = re.compile(r"^[ \t]*(?:[-*]|\d+\.)[ \t]")
LEAD = 45  # characters of words that lead a paragraph in, such as "Predict."
HIDDEN = "\x00{}\x00"
GREEK = {
    **{
        f"\\{name}": sign
        for name, sign in zip(("alpha", "beta", "theta", "phi", "sigma"), "αβθφσ", strict=True)
    },
    **{r"\times": "×", r"\le": "≤", r"\ge": "≥", r"\cdot": "·", r"\pi": "π", r"\,": " ", r"\to": "→"},
}


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
    kept: list[str] = []

    def hide(found: re.Match[str]) -> str:
        kept.append(found[0])
        return f"\n\n{HIDDEN.format(len(kept) - 1)}\n\n"

    parts = re.split(r"\n\s*\n|(?<=\n)(?=#)|(?<=^)(?=#)", FENCED.sub(hide, COMMENT.sub("", text)))
    found = [part.strip() for part in parts if part.strip()]
    return [re.sub("\x00(\\d+)\x00", lambda number: kept[int(number[1])], part) for part in found]


def sentences(text: str) -> list[str]:
    """Split a paragraph into sentences; code, formulas, links and brackets stay whole.

    Examples
    --------
    >>> sentences("It is 3.5 cm off (see Fig. 4. It is small). Why? Look at `a. B`.")
    ['It is 3.5 cm off (see Fig. 4. It is small).', 'Why?', 'Look at `a. B`.']
    """
    kept: list[str] = []

    def hide(found: re.Match[str]) -> str:
        kept.append(found[0])
        return HIDDEN.format(len(kept) - 1)

    whole: list[str] = []
    for part in END.split(KEPT.sub(hide, KEPT.sub(hide, " ".join(text.split())))):  # brackets in brackets
        if whole and SHORT.search(whole[-1]):
            whole[-1] += f" {part}"
        else:
            whole.append(part)
    for _ in range(2):
        whole = [re.sub("\x00(\\d+)\x00", lambda number: kept[int(number[1])], part) for part in whole]
    return whole


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
    items: list[str] = []
    for line in block.splitlines():
        if ITEM.match(line):
            items.append(line)
        else:
            items[-1] += f" {line.strip()}"
    return "\n".join(_marked(item) for item in items)


def _marked(item: str) -> str:
    sign = ITEM.match(item)
    assert sign
    return sign[0] + _first(item[sign.end() :])


def _first(text: str, room: int = 0) -> str:
    """Give the first sentence; words in bold or italics that lead it in do not count as one."""
    found = sentences(text)
    lead = found[0].startswith("*") and found[0].endswith("*") and len(found[0]) < LEAD
    count = 1 + lead
    while count < len(found) and len(" ".join(found[: count + 1])) <= room:
        count += 1
    return _closed(" ".join(found[:count]))


def _closed(sentence: str) -> str:
    """Close emphasis that the next sentence would have closed."""
    for sign in ("**", "*"):
        if len(re.findall(rf"(?<!\*){re.escape(sign)}(?!\*)", sentence)) % 2:
            sentence += sign
    return sentence


def spoken(text: str) -> str:
    r"""Give a text as plain words for a caption, or nothing where a formula cannot be written as words.

    Examples
    --------
    >>> spoken("The [*cost*](GLOSSARY.md#cost) of `grid` falls with $\\theta$.")
    'The cost of grid falls with θ.'
    >>> spoken(r"It is $\\frac{1}{2}$.")
    ''
    """
    for word, sign in sorted(GREEK.items(), key=lambda pair: -len(pair[0])):
        text = text.replace(word, sign)
    if re.search(r"\$[^$]*[\\^_{][^$]*\$|<", COMMENT.sub("", text)):
        return ""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", COMMENT.sub("", text))
    text = re.sub(r" ?\[\d+(?:, [^\]]*)?\]", "", text)
    return " ".join(re.sub(r"[*`$]|(?<!\w)_|_(?!\w)", "", text).split())
