"""Markdown as plain words, for captions."""

import re

COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
DIGITS = {"_": "₀₁₂₃₄₅₆₇₈₉", "^": "⁰¹²³⁴⁵⁶⁷⁸⁹"}
GREEK = dict(zip((r"\alpha", r"\beta", r"\theta", r"\phi", r"\sigma", r"\pi"), "αβθφσπ", strict=True))
GREEK |= {r"\times": "×", r"\le": "≤", r"\ge": "≥", r"\cdot": "·", r"\,": " ", r"\to": "→"}


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
    text = re.sub(r"[_^]\d", lambda found: DIGITS[found[0][0]][int(found[0][1])], text)
    for word in sorted(GREEK, key=len, reverse=True):
        text = text.replace(word, GREEK[word])
    if re.search(r"\$[^$]*[\\^_{][^$]*\$|<", text):
        return ""
    text = re.sub(r" ?\[\d+(?:, [^\]]*)?\]", "", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text))
    return " ".join(re.sub(r"[*`$]|(?<!\w)_|_(?!\w)", "", text).split())
