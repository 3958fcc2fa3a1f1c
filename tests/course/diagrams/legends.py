"""Which entries of a legend occur in the picture: of a stepper, in any of its steps."""

from itertools import chain

import numpy as np
from matplotlib.collections import Collection
from matplotlib.colors import to_hex
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

THICK = 2.5  # points: an outline of at least this width is a mark of its own


def entries(figure):
    """Return the look of each entry of the figure's legends, by its label."""
    legends = [artist for artist in figure.findobj(Legend) if artist.get_visible()]
    return {
        text.get_text(): look
        for legend in legends
        for text, handle in zip(legend.get_texts(), legend.legend_handles, strict=True)
        for look in looks(handle)[-1:]
    }


def occurring(figure):
    """Return the looks of all lines and discs that a figure shows, without its legends."""
    in_legends = set(chain.from_iterable(legend.findobj() for legend in figure.findobj(Legend)))
    shown = [artist for artist in figure.findobj() if artist not in in_legends and artist.get_visible()]
    return {look for artist in shown if is_somewhere(artist) for look in looks(artist)}


def looks(artist):
    """Return how an artist looks: a line by its colour, a disc by its face, then by a thick outline."""
    if isinstance(artist, Line2D):
        has_line = artist.get_linestyle() not in ("None", "", " ")
        if has_line:
            return [("line", to_hex(artist.get_color()))]
        return disc(artist.get_markerfacecolor(), artist.get_markeredgewidth())
    if isinstance(artist, Collection):
        faces = artist.get_facecolors()
        widths = np.resize(artist.get_linewidths(), max(len(faces), 1))
        return [*chain.from_iterable(disc(*each) for each in zip(faces, widths, strict=False))]
    return []


def disc(face, width):
    return [("disc", to_hex(face)), *(["marked disc"] if width >= THICK else [])]


def is_somewhere(artist):
    if isinstance(artist, Line2D):
        return bool(np.isfinite(np.asarray(artist.get_xydata(), float)).all(axis=1).any())
    return True


def missing(draw, positions, figure_of):
    """Return the entries of a stepper's legend that occur in none of its steps.

    draw : draws a step.
    positions : the arguments of its steps.
    figure_of : returns the figure, once a step is drawn.
    """
    found = set()
    named = {}
    for position in positions:
        draw(*position)
        figure = figure_of()
        named |= entries(figure)
        found |= occurring(figure)
    return {label for label, look in named.items() if look not in found}
