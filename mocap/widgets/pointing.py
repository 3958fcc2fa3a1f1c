"""Pictures to point at: an image to click on, and handles to drag, by mouse, by touch or by the arrow keys.

Handles lie on the picture that an experiment draws, so the reader drags the very thing that answers.
"""

import base64
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from mocap.errors import MocapError
from mocap.plotting.picture import figure_of, small_png
from mocap.widgets.embedding import TOUCH
from mocap.widgets.live import Live, widget


def pointer(image: AxesImage, value: Sequence[int] = (0, 0)) -> Any:  # noqa: ANN401
    """Make a control of an image, such as a `plotting.distance_image`: its value is a (row, column).

    Parameters
    ----------
    image : on axes; the whole figure is shown, and closed.
    value : where the ring is at first.

    Returns
    -------
    A widget with the trait `value`, for `explore` or on its own.

    Raises
    ------
    MocapError : where anywidget is not installed, for an image that is not of numbers, and for a value
        outside the image, here and when it is set later.

    Examples
    --------
    >>> from mocap import plotting
    >>> at = pointer(plotting.distance_image(np.array([[0.04, 0.01], [0.09, 0.16]]), fps=30))
    >>> at.value = (1, 0)  # as a click does
    >>> at.status
    'row 1, column 0: RMS distance (cm) 30'
    """
    numbers = np.asarray(image.get_array())
    if numbers.ndim != 2:
        raise MocapError(f"An image to point at has rows and columns of numbers, not shape {numbers.shape}.")
    figure = figure_of(image)
    png = base64.b64encode(small_png(figure)).decode()
    plt.close(figure)
    left, right, bottom, top = image.get_extent()
    first, last = (bottom, top) if image.origin == "lower" else (top, bottom)
    x0, y0, x1, y1 = shares(image.axes, [(left, first), (right, last)])
    picture = f"data:image/png;base64,{png}"
    control = widget(Pointer)(box=[x0, y0, x1 - x0, y1 - y0], shape=numbers.shape, picture=picture)
    control.numbers, control.quantity = numbers, image.colorbar.ax.get_ylabel() if image.colorbar else "value"
    control.observe(control.say_where, "value")
    control.value = tuple(value)
    control.say_where()
    return control


def shares(ax: Axes, corners: ArrayLike) -> list[float]:
    """Give where two corners of linear axes are in the figure, as shares from its left and its top."""
    seen = figure_of(ax).transFigure.inverted().transform(ax.transData.transform(corners))
    return [float(share) for share in (seen * [1, -1] + [0, 1]).ravel()]


class Pointer(Live):
    """A picture with a `value`, a row and a column, that Python and the reader may set."""

    scripts = (TOUCH, Path(__file__).with_name("pointing.js"))
    shared: ClassVar = {
        **{"description": "", "picture": "", "status": ""},
        **{"box": [], "shape": (), "value": (0, 0)},  # left, top, width, height from row 0 and column 0
    }
    needs = "An image to point at needs"
    numbers: NDArray[np.floating[Any]]
    quantity: str
    value: Any
    box: Any
    shape: Any
    picture: Any
    layout: Any

    def check_value(self, value: Sequence[int]) -> tuple[int, int]:
        """Refuse a row or a column that the image does not have."""
        rows, columns = self.shape
        if len(value) != 2 or value[0] not in range(rows) or value[1] not in range(columns):
            raise MocapError(f"Rows go from 0 to {rows - 1}, columns to {columns - 1}, got {tuple(value)}.")
        return int(value[0]), int(value[1])

    def say_where(self, _: object = None) -> None:
        """Say where the ring is, and the number there."""
        row, column = self.value
        self.status: Any = f"row {row}, column {column}: {self.quantity} {self.numbers[row, column]:.3g}"

    def with_ring(self) -> Image.Image:
        """Draw the ring into the picture."""
        picture = Image.open(io.BytesIO(base64.b64decode(self.picture.split(",")[1]))).convert("RGB")
        (left, top, wide, high), (row, column) = self.box, np.add(self.value, 0.5) / self.shape
        at = np.array([left + wide * column, top + high * row]) * picture.size
        for radius, colour in ((9, "#222222"), (7, "#FFFFFF")):
            ImageDraw.Draw(picture).ellipse([*(at - radius), *(at + radius)], outline=colour, width=2)
        return picture


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
    control = widget(Handles)(limits=limits, names=names)
    control.ax, control.count = ax, len(where)
    control.value = where
    plt.close(figure_of(ax))
    return control


class Handles(Live):
    """A picture with points as its `value`, which Python and the reader may set."""

    scripts = (Path(__file__).with_name("dragging.js"),)
    shared: ClassVar = {
        **{"description": "", "picture": b"", "box": [0.0, 0.0, 1.0, 1.0]},
        **{"limits": [], "names": [], "step": 0.05, "value": ()},
    }
    needs = "Handles to drag need"
    ax: Axes
    count: int
    value: Any
    limits: Any
    layout: Any

    def check_value(self, value: ArrayLike) -> tuple[tuple[float, float], ...]:
        """Check that there are so many points, and that all lie within the axes."""
        where = np.asarray(value, float)
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
        self.box: Any = shares(self.ax, [(left, top), (right, bottom)])
        self.picture: Any = png

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

    def elsewhere(self) -> list[tuple[tuple[float, float], ...]]:
        """Give values that a reader may reach: as it is, one handle in the middle, another at a corner."""
        points = np.tile(np.array(self.value), (3, 1, 1))
        points[1, 0], points[2, -1] = np.mean(self.limits, axis=1), np.array(self.limits)[:, 1]
        return [self.check_value(some) for some in points]
