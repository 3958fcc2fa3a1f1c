"""An image to click on: a click or the arrow keys choose one of its rows and columns."""

from __future__ import annotations

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
    control = widget(Pointer)(box=_box(image), shape=numbers.shape, picture=f"data:image/png;base64,{png}")
    control.numbers, control.quantity = numbers, image.colorbar.ax.get_ylabel() if image.colorbar else "value"
    control.observe(control.say_where, "value")
    control.value = tuple(value)
    control.say_where()
    return control


def shares(ax: Axes, corners: ArrayLike) -> list[float]:
    """Give where two corners of linear axes are in the figure, as shares from its left and its top."""
    seen = figure_of(ax).transFigure.inverted().transform(ax.transData.transform(corners))
    return [float(share) for share in (seen * [1, -1] + [0, 1]).ravel()]


def _box(image: AxesImage) -> list[float]:
    """Find the image in its figure: left, top, width, height from row 0 and column 0, as shares of 1."""
    left, right, bottom, top = image.get_extent()
    first, last = (bottom, top) if image.origin == "lower" else (top, bottom)
    x0, y0, x1, y1 = shares(image.axes, [(left, first), (right, last)])
    return [x0, y0, x1 - x0, y1 - y0]


class Pointer(Live):
    """A picture with a `value`, a row and a column, that Python and the reader may set."""

    scripts = (TOUCH, Path(__file__).with_name("pointing.js"))
    shared: ClassVar = {
        **{"description": "", "picture": "", "status": ""},
        **{"box": [], "shape": (), "value": (0, 0)},
    }
    needs = "An image to point at needs"
    numbers: NDArray[np.floating[Any]]
    quantity: str
    value: tuple[int, int]
    box: list[float]
    shape: tuple[int, int]
    picture: str
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
        self.status: str = f"row {row}, column {column}: {self.quantity} {self.numbers[row, column]:.3g}"

    def with_ring(self) -> Image.Image:
        """Draw the ring into the picture."""
        picture = Image.open(io.BytesIO(base64.b64decode(self.picture.split(",")[1]))).convert("RGB")
        (left, top, wide, high), (row, column) = self.box, np.add(self.value, 0.5) / self.shape
        x, y = (left + wide * column) * picture.width, (top + high * row) * picture.height
        for radius, colour in ((9, "#222222"), (7, "#FFFFFF")):
            around = (x - radius, y - radius, x + radius, y + radius)
            ImageDraw.Draw(picture).ellipse(around, outline=colour, width=2)
        return picture
