"""One look for all pictures: colours that colour-blind readers tell apart, after Okabe and Ito."""

COLOURS = {"left": "#0072B2", "right": "#D55E00", "middle": "#333333"}
"""The colour of each side of a body."""

SOURCES = ("#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#8A6D00", "#0072B2", "#D55E00")
"""One colour after the other for clips, characters and stretches of a walk."""

CURVES = ("#0072B2", "#D55E00", "#009E73", "#333333")
"""For curves that share axes."""

PATH, ASKED, MARK = "#E69F00", "#000000", "#CC79A7"
"""A path that was walked, a path that was asked for, and seams or transitions."""

FLOOR, QUIET = "#DDDDDD", "#999999"
"""The ground's lines, and whatever matters less."""


def source_colours(names: list[str]) -> dict[str, str]:
    """Give each different name a colour, in the order of first appearance.

    Examples
    --------
    >>> source_colours(["walk", "turn", "walk"])
    {'walk': '#009E73', 'turn': '#CC79A7'}
    """
    return {name: SOURCES[i % len(SOURCES)] for i, name in enumerate(dict.fromkeys(names))}
