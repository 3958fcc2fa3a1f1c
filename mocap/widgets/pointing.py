"""Handles to drag, by mouse, by touch or by the arrow keys.

They are drawn on the picture of an experiment, so that the reader drags points of the picture itself.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw

from mocap.errors import MocapError
from mocap.plotting.picture import figure_of
from mocap.widgets.embedding import joined
from mocap.widgets.shared_traits import AnyWidget, ValueWidget, shared, validate

RADIUS = 9  # pixels, radius of a handle
WHITE = "#FFFFFF"
INK = "#222222"


def handles(ax: Axes, points: ArrayLike) -> Handles:
    """Create a control of points on axes, whose value is a tuple of (across, up) in the units of the axes.

    `explore` shows it on the picture that `draw` returns. `draw` can change artists of the figure of these
    axes and return them, or return a new figure whose axes have the same position.

    Parameters
    ----------
    ax : linear axes, whose limits are constant and bound the handles. Their labels name the two coordinates.
    points : shape (K, 2), the initial positions of the handles.

    Returns
    -------
    A widget with the trait `value`, for `explore`.

    Raises
    ------
    MocapError : if anywidget is not installed, for points of another shape or outside the axes, initially or
        later, and for axes that are not linear.

    Examples
    --------
    >>> ax = plt.figure().add_subplot(xlim=(3, -3), ylim=(0, 6), xlabel="x (m)", ylabel="z (m)")
    >>> dragged = handles(ax, [[0, 1], [0, 3], [0, 5]])
    >>> dragged.value = ((0, 1), (1.5, 3), (0, 5))  # as dragging the second handle does
    >>> dragged.value[1]
    (1.5, 3.0)

    Notebook: 12-path-editing
    """
    positions = np.asarray(points, float)
    if positions.ndim != 2 or positions.shape[1] != 2 or not len(positions):
        raise MocapError(f"Handles are rows of two numbers, got an array of shape {positions.shape}.")
    if (ax.get_xscale(), ax.get_yscale()) != ("linear", "linear"):
        raise MocapError(f"Handles need linear axes, not {ax.get_xscale()} and {ax.get_yscale()} ones.")
    limits = [[float(end) for end in ends] for ends in (ax.get_xlim(), ax.get_ylim())]
    names = [label.split(" (")[0] for label in (ax.get_xlabel() or "across", ax.get_ylabel() or "up")]
    control = Handles(limits=limits, names=names)
    control.ax = ax
    control.count = len(positions)
    control.value = positions
    plt.close(figure_of(ax))
    return control


class Handles(AnyWidget, ValueWidget):  # type: ignore[misc]
    """A picture with points as its `value`, which Python and the reader may change."""

    _esm = joined(Path(__file__).with_name("dragging.js"))
    picture = shared(b"")
    box = shared([0.0, 0.0, 1.0, 1.0])  # left, top, right, bottom of the axes, as fractions of the figure
    limits = shared([])  # limits of the axes: (left, right), (bottom, top)
    names = shared([])  # names of the two axes
    description = shared("")
    step = shared(0.05)  # step of an arrow key, in the units of the axes
    value = shared(())
    ax: Axes
    count: int

    @validate("value")
    def _check(self, proposal: dict[str, Any]) -> tuple[tuple[float, float], ...]:
        """Check that the number of points is that of the handles, and that all are within the axes."""
        positions = np.asarray(proposal["value"], float)
        if positions.shape != (self.count, 2):
            raise MocapError(f"There are {self.count} handles, got an array of shape {positions.shape}.")
        low, high = np.sort(self.limits, axis=1).T
        outside = ~((positions >= low) & (positions <= high)).all(axis=1)
        if outside.any():
            first = int(outside.argmax())
            raise MocapError(f"Handle {first + 1} would leave the axes: {positions[first].tolist()}.")
        return tuple((float(x), float(y)) for x, y in positions)

    def show(self, png: bytes) -> None:
        """Show a new picture, and update the position of the axes in it."""
        (left, right), (bottom, top) = self.limits
        corners = self.ax.transData.transform([(left, top), (right, bottom)])
        fractions = figure_of(self.ax).transFigure.inverted().transform(corners)  # from left and bottom
        self.box = (fractions * [1, -1] + [0, 1]).ravel().tolist()
        self.picture = png

    def with_handles(self) -> Image.Image:
        """Return the picture with the handles drawn into it."""
        picture = Image.open(io.BytesIO(self.picture)).convert("RGB")
        draw = ImageDraw.Draw(picture)
        low, high = np.array(self.limits).T
        left, top, right, bottom = self.box
        in_axes = (np.array(self.value) - low) / (high - low)
        in_figure = in_axes * [right - left, top - bottom] + [left, bottom]
        for number, pixel in enumerate(in_figure * picture.size, start=1):
            draw.ellipse([*(pixel - RADIUS), *(pixel + RADIUS)], fill=WHITE, outline=INK, width=2)
            draw.text(pixel.tolist(), str(number), fill=INK, anchor="mm")
        return picture
