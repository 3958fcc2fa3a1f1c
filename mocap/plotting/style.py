"""One look for all pictures: colours that colour-blind readers tell apart, after Okabe and Ito, and Tol.

Each colour has one meaning in the whole course: blue and vermilion are the left and the right of a body and
nothing else, purple is a seam or a transition, orange is the path that was walked, black the path that was
asked for.
"""

COLOURS = {"left": "#0072B2", "right": "#D55E00", "middle": "#333333"}
"""The colour of each side of a body."""

SOURCES = ("#009E73", "#56B4E9", "#8A6D00", "#332288", "#DDCC77", "#882255", "#666666")
"""One colour after the other for clips, characters and stretches of a walk."""

CURVES = ("#009E73", "#882255", "#56B4E9", "#8A6D00")
"""For curves that share axes: first the method that the text is about, second what it is compared with."""

PATH, ASKED, MARK = "#E69F00", "#000000", "#CC79A7"
"""A path that was walked, a path that was asked for, and seams or transitions."""

ASTRAY = "#B00020"
"""Where a walk leaves the path that was asked for."""

FLOOR, QUIET = "#DDDDDD", "#999999"
"""The ground's lines, and whatever matters less."""


def source_colours(names: list[str]) -> dict[str, str]:
    """Give each different name a colour, in the order of first appearance.

    Examples
    --------
    >>> source_colours(["walk", "turn", "walk"])
    {'walk': '#009E73', 'turn': '#56B4E9'}
    """
    return {name: SOURCES[i % len(SOURCES)] for i, name in enumerate(dict.fromkeys(names))}


def own_colour(number: int, count: int) -> str | None:
    """Give one of several characters its colour; one alone has the colours of its sides.

    Examples
    --------
    >>> own_colour(0, 1), own_colour(1, 2)
    (None, '#56B4E9')
    """
    return SOURCES[number % len(SOURCES)] if count > 1 else None
