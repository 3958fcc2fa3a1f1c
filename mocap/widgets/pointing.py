"""A picture to point at: a click on an image, or the arrow keys, choose one of its rows and columns."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.image import AxesImage
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from mocap.errors import MocapError
from mocap.plotting.picture import figure_of, small_png

SCRIPT = Path(__file__).with_name("pointing.js")


def pointer(image: AxesImage, value: Sequence[int] = (0, 0)) -> Any:  # noqa: ANN401
    """Make a control of an image, such as a `plotting.distance_image`: its value is a (row, column).

    Parameters
    ----------
    image : on axes; the whole figure is shown, and closed.
    value : where the ring is at first.

    Raises
    ------
    MocapError : where anywidget is not installed, for an image that is not of numbers, and, here and when it
        is set, for a value outside it.
    """
    numbers = np.asarray(image.get_array())
    if numbers.ndim != 2:
        raise MocapError(f"An image to point at has rows and columns of numbers, not shape {numbers.shape}.")
    figure = figure_of(image)
    png = base64.b64encode(small_png(figure)).decode()
    plt.close(figure)
    widget = _pointer_class()(box=_box(image), shape=numbers.shape, picture=f"data:image/png;base64,{png}")
    widget.numbers, widget.quantity = numbers, image.colorbar.ax.get_ylabel() if image.colorbar else "value"
    widget.observe(widget.tell, "value")
    widget.value = tuple(value)
    widget.tell()
    return widget


def _box(image: AxesImage) -> list[float]:
    """Say where the image is in its figure: left, top, width, height from row 0 and column 0, in shares."""
    left, right, bottom, top = image.get_extent()
    first, last = (bottom, top) if image.origin == "lower" else (top, bottom)
    corners = image.axes.transData.transform([(left, first), (right, last)])
    (x0, y0), (x1, y1) = image.axes.figure.transFigure.inverted().transform(corners)
    return [float(share) for share in (x0, 1 - y0, x1 - x0, y0 - y1)]


class Pointed:
    """What a pointer has beside its traits: what it tells, and how it looks where nothing is live."""

    numbers: NDArray[np.floating[Any]]
    quantity: str
    value: tuple[int, int]
    box: list[float]
    shape: tuple[int, int]
    picture: str
    layout: Any

    def tell(self, _: object = None) -> None:
        """Say where the ring is, and the number there."""
        row, column = self.value
        self.told = f"row {row}, column {column}: {self.quantity} {self.numbers[row, column]:.3g}"

    def still(self) -> Image.Image:
        """Draw the picture with its ring."""
        still = Image.open(io.BytesIO(base64.b64decode(self.picture.split(",")[1]))).convert("RGB")
        (left, top, wide, high), (row, column) = self.box, np.add(self.value, 0.5) / self.shape
        x, y = (left + wide * column) * still.width, (top + high * row) * still.height
        for radius, colour in ((9, "#222222"), (7, "#FFFFFF")):
            around = (x - radius, y - radius, x + radius, y + radius)
            ImageDraw.Draw(still).ellipse(around, outline=colour, width=2)
        return still


@cache
def _pointer_class() -> type[Any]:
    """Make the class of the widget, which needs anywidget and so is not there without it."""
    try:
        import anywidget
        import traitlets
        from ipywidgets import ValueWidget
    except ImportError as error:
        raise MocapError("An image to point at needs anywidget: pip install 'mocap[notebooks]'.") from error

    class Pointer(Pointed, anywidget.AnyWidget, ValueWidget):  # type: ignore[misc]  # untyped
        """A picture whose `value`, a row and a column, Python and the reader may set."""

        _esm = SCRIPT.read_text("utf-8")
        description = traitlets.Unicode().tag(sync=True)
        picture = traitlets.Unicode().tag(sync=True)
        box: traitlets.List[float] = traitlets.List().tag(sync=True)
        shape = traitlets.Tuple().tag(sync=True)
        told = traitlets.Unicode().tag(sync=True)
        value = traitlets.Tuple((0, 0)).tag(sync=True)

        @traitlets.validate("value")
        def _inside(self, proposal: dict[str, Any]) -> tuple[int, ...]:
            value, (rows, columns) = proposal["value"], self.shape
            if len(value) != 2 or value[0] not in range(rows) or value[1] not in range(columns):
                raise MocapError(f"Rows go from 0 to {rows - 1}, columns to {columns - 1}, got {value}.")
            return (int(value[0]), int(value[1]))

    return Pointer
