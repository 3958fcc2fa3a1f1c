"""Colours of all pictures, which colour-blind readers can distinguish, after Okabe and Ito, and Tol.

Each colour has one meaning in the whole course. Blue and vermilion are the left and the right of a body.
Purple is a seam or a transition, orange is the path that was walked, and black is the requested path.
"""

from collections import Counter
from collections.abc import Sequence

COLOURS = {"left": "#0072B2", "right": "#D55E00", "middle": "#333333"}
"""The colour of each side of a body."""

SOURCES = ("#009E73", "#56B4E9", "#8A6D00", "#332288", "#DDCC77", "#882255", "#666666")
"""The colours of clips, characters and stretches of a walk, in order."""

CURVES = ("#009E73", "#882255", "#56B4E9", "#8A6D00")
"""The colours of curves that share axes: first the method of the text, then the method to compare with."""

PATH = "#E69F00"
"""The colour of a path that was walked."""

ASKED = "#000000"
"""The colour of a path that was requested."""

MARK = "#CC79A7"
"""The colour of seams and transitions."""

ASTRAY = "#B00020"
"""The colour of a walk where it leaves the requested path."""

FLOOR = "#DDDDDD"
"""The colour of the lines on the ground."""

QUIET = "#999999"
"""The colour of less important parts."""


def source_colours(names: list[str]) -> dict[str, str]:
    """Assign a colour to each distinct name, in the order of first appearance.

    Examples
    --------
    >>> source_colours(["walk", "turn", "walk"])
    {'walk': '#009E73', 'turn': '#56B4E9'}
    """
    return {name: SOURCES[i % len(SOURCES)] for i, name in enumerate(dict.fromkeys(names))}


def own_colour(number: int, count: int, sources: int = 0) -> str | None:
    """Return the colour of one of several characters, or None for a single one, whose sides are coloured.

    Parameters
    ----------
    number : the number of the character.
    count : the number of characters.
    sources : the number of sources of the first character. Their colours are not used for the others.

    Examples
    --------
    >>> own_colour(0, 1), own_colour(1, 2), own_colour(1, 2, sources=2)
    (None, '#56B4E9', '#8A6D00')
    """
    place = number + max(0, sources - 1) if number else 0
    return SOURCES[place % len(SOURCES)] if count > 1 else None


def distinct_names(names: Sequence[str]) -> list[str]:
    """Append numbers to equal names, so that a legend has an entry for each.

    Examples
    --------
    >>> distinct_names(["walk", "jog", "walk"])
    ['walk (1)', 'jog', 'walk (2)']
    """
    counts = Counter(names)
    seen: Counter[str] = Counter()
    distinct = []
    for name in names:
        seen[name] += 1
        distinct.append(f"{name} ({seen[name]})" if counts[name] > 1 else name)
    return distinct
