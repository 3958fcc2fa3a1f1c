"""Handles to drag, by mouse, by touch or by the arrow keys.

They lie on the picture that an experiment draws, so the reader drags the very thing that answers.
"""

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


def handles(ax: Axes, points: ArrayLike) -> Any:  # noqa: ANN401
    """Make a control of points on axes: its value is a tuple of (across, up), in the units of the axes.

    `explore` shows it on the picture that `draw` gives. So let `draw` move artists of the figure of these
    axes and return them; it may also return a new figure whose axes lie in the same place.

    Parameters
    ----------
    ax : linear axes, whose limits stay; no handle leaves them. Their labels name the two numbers.
    points : shape (K, 2), where the handles are at first.

    Returns
    -------
    A widget with the trait `value`, for `explore`.

    Raises
    ------
    MocapError : where anywidget is not installed, for points of another shape or outside the axes, here and
        when they are set later, and for axes that are not linear.

    Examples
    --------
    >>> ax = plt.figure().add_subplot(xlim=(3, -3), ylim=(0, 6), xlabel="x (m)", ylabel="z (m)")
    >>> dragged = handles(ax, [[0, 1], [0, 3], [0, 5]])
    >>> dragged.value = ((0, 1), (1.5, 3), (0, 5))  # as a drag of the second one does
    >>> dragged.value[1]
    (1.5, 3.0)

    Notebook: 12-path-editing
    """
    where = np.asarray(points, float)
    if where.ndim != 2 or where.shape[1] != 2 or not len(where):
        raise MocapError(f"Handles are rows of two numbers, got an array of shape {where.shape}.")
    if (ax.get_xscale(), ax.get_yscale()) != ("linear", "linear"):
        raise MocapError(f"Handles need linear axes, not {ax.get_xscale()} and {ax.get_yscale()} ones.")
    limits = [[float(end) for end in ends] for ends in (ax.get_xlim(), ax.get_ylim())]
    names = [label.split(" (")[0] for label in (ax.get_xlabel() or "across", ax.get_ylabel() or "up")]
    control = Handles(limits=limits, names=names)
    control.ax, control.count = ax, len(where)
    control.value = where
    plt.close(figure_of(ax))
    return control


class Handles(AnyWidget, ValueWidget):  # type: ignore[misc]
    """A picture with points as its `value`, which Python and the reader may set."""

    _esm = joined(Path(__file__).with_name("dragging.js"))
    picture, box = shared(b""), shared([0.0, 0.0, 1.0, 1.0])
    limits, names, description = shared([]), shared([]), shared("")
    step, value = shared(0.05), shared(())
    ax: Axes
    count: int

    @validate("value")
    def _check(self, proposal: dict[str, Any]) -> tuple[tuple[float, float], ...]:
        """Check that there are so many points, and that all lie within the axes."""
        where = np.asarray(proposal["value"], float)
        if where.shape != (self.count, 2):
            raise MocapError(f"There are {self.count} handles, got an array of shape {where.shape}.")
        low, high = np.sort(self.limits, axis=1).T
        outside = ~((where >= low) & (where <= high)).all(axis=1)
        if outside.any():
            first = int(outside.argmax())
            raise MocapError(f"Handle {first + 1} would leave the axes: {where[first].tolist()}.")
        return tuple((float(x), float(y)) for x, y in where)

    def show(self, png: bytes) -> None:
        """Take the picture that was just drawn; the axes' place may have changed with it."""
        (left, right), (bottom, top) = self.limits
        corners = self.ax.transData.transform([(left, top), (right, bottom)])
        seen = figure_of(self.ax).transFigure.inverted().transform(corners)
        self.box = (seen * [1, -1] + [0, 1]).ravel().tolist()  # shares from the figure's left and top
        self.picture = png

    def with_handles(self) -> Image.Image:
        """Draw the handles into the picture."""
        picture = Image.open(io.BytesIO(self.picture)).convert("RGB")
        (low, high), draw = np.array(self.limits).T, ImageDraw.Draw(picture)
        left, top, right, bottom = self.box
        places = (np.array(self.value) - low) / (high - low) * [right - left, top - bottom] + [left, bottom]
        for number, at in enumerate(places * picture.size, start=1):
            draw.ellipse([*(at - 9), *(at + 9)], fill="#FFFFFF", outline="#222222", width=2)
            draw.text(at.tolist(), str(number), fill="#222222", anchor="mm")
        return picture
