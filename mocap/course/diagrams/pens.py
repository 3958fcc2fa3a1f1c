"""Pens that several diagrams share: arrows and words at points of a plane, and legends' discs."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.text import Annotation

from mocap.plotting import CURVES


def arrow(ax: Axes, start: complex, end: complex, colour: str, wide: float = 1.8, **style: Any) -> Annotation:  # noqa: ANN401
    """Draw an arrow from a point across + i up to another."""
    look = {"arrowstyle": "-|>", "color": colour, "linewidth": wide, "shrinkA": 0, "shrinkB": 0} | style
    return ax.annotate("", (end.real, end.imag), (start.real, start.imag), arrowprops=look)


def say(ax: Axes, middle: complex, words: str, **look: Any) -> None:  # noqa: ANN401
    """Write words with their middle at a point across + i up."""
    ax.text(middle.real, middle.imag, words, **({"ha": "center", "va": "center"} | look))


def trace(ax: Axes, points: Any, **look: Any) -> None:  # noqa: ANN401
    """Draw a line through complex points, or a dot on one."""
    ax.plot(points.real, points.imag, **look)


def strokes(ax: Axes, **look: Any) -> LineCollection:  # noqa: ANN401
    """Add lines that get their places by `set_segments`."""
    added = LineCollection([], **look)
    ax.add_collection(added)
    return added


def disc(face: str, **look: Any) -> Line2D:  # noqa: ANN401
    """Make a disc for a legend."""
    return Line2D([], [], linestyle="", marker="o", color=face, **look)


def show_program(ax: Axes, program: Sequence[str], line: int) -> Rectangle:
    """Write a program, and mark the line that has just run; return the mark."""
    ax.set(xlim=(0, 1), ylim=(len(program), -1))
    ax.set_axis_off()
    for number, text in enumerate(program):
        ax.text(0.01, number, text, va="center", family="monospace")
    return ax.axhspan(line - 0.5, line + 0.5, color=CURVES[0], alpha=0.25, linewidth=0)
