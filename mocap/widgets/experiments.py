"""Experiments for notebooks: a picture with controls, redrawn when a control moves.

An experiment has three forms: live controls while Python runs, a PNG without Python (on a code host, on a
printed page, in a notebook that is opened again), and an alternative text without pictures. While a control
is dragged, the browser sends its latest value as soon as the last picture is drawn.
"""

from __future__ import annotations

import html
import inspect
import io
import traceback
from collections.abc import Callable, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from mocap.errors import MocapError
from mocap.plotting.picture import Picture, few_colours, figure_of, legible, letters_of
from mocap.widgets.live import display_live
from mocap.widgets.shared_traits import Naming, ipywidgets

Drawn = Any  # a figure, the result of a function of `plotting`, or a list of changed artists


def explore(draw: Callable[..., Drawn], *, alt: str, **controls: Any) -> Experiment:  # noqa: ANN401
    """Show a picture with controls, and redraw it when one of them moves.

    If only a small part of the picture changes, `draw` can change the artists of one figure and return them.
    Then only these are redrawn, over a stored picture of the rest, which is faster.

    Parameters
    ----------
    draw : called with the values of the controls as keyword arguments. It returns a figure, axes or artists,
        or a list of the artists that it changed.
    alt : a sentence that describes the picture, for readers who do not see it.
    controls : name=(low, high) or (low, high, step) for a slider, a bool for a check box, a list or
        {label: value} for a choice, `handles` to drag on the picture, or a widget. A control starts at the
        default in `draw`'s signature, and handles at their own positions.

    Returns
    -------
    The experiment. A notebook shows it as the last line of a cell.

    Raises
    ------
    MocapError : for a control that is not a parameter of `draw`, and for a value that defines no control.
    Exception : any exception of the first call of `draw`. Later, the notebook shows the error in place of the
        picture.

    Examples
    --------
    >>> line, = plt.figure().add_subplot().plot([0, 1], [0, 0])
    >>> def draw(slope=1.0):
    ...     line.set_ydata([0, slope])
    ...     return [line]
    >>> explore(draw, alt="A line that rises as its slope does.", slope=(-1.0, 1.0))
    Experiment(draw, slope=1.0)

    Notebook: 01-skeletons-and-clips
    """
    defaults = {name: parameter.default for name, parameter in inspect.signature(draw).parameters.items()}
    widgets = {}
    for name, control in controls.items():
        if name not in defaults:
            raise MocapError(f"'{draw.__name__}' takes no '{name}'; it takes: {', '.join(defaults)}.")
        widgets[name] = _widget(name, control, defaults[name])
    if sum(hasattr(widget, "with_handles") for widget in widgets.values()) > 1:
        raise MocapError("An experiment has one control of handles: put all points into it.")
    return Experiment(draw, alt, widgets)


def _widget(name: str, control: object, default: object) -> Any:  # noqa: ANN401
    """Create the widget of a control, with its name as the description."""
    try:
        widget = ipywidgets.interactive.widget_from_abbrev(control, default)
    except (ValueError, TypeError):
        widget = None
    if widget is None:
        raise MocapError(f"The control {name}={control!r} is no range, choice or widget.")
    widget.description = name.replace("_", " ")
    return widget


def step_aside(reason: object) -> None:
    """Print the reason why a notebook cannot continue, and disable the cells below.

    Parameters
    ----------
    reason : an error or a sentence.

    Examples
    --------
    >>> step_aside("The clips are not here.")
    The cells below do nothing until the kernel restarts: The clips are not here.

    Notebook: 10-real-data
    """
    from IPython import get_ipython

    print(f"The cells below do nothing until the kernel restarts: {reason}")
    shell = get_ipython()
    if shell is not None:
        shell.input_transformers_cleanup.append(lambda lines: [])  # turns each cell into an empty one


class Experiment:
    """The controls, the picture and the last error of an experiment, as returned by `explore`.

    Parameters
    ----------
    draw, alt : as for `explore`.
    controls : a widget for each name.

    Examples
    --------
    >>> line, = plt.figure().add_subplot().plot([0, 1], [0, 0])
    >>> def draw(slope=1.0):
    ...     line.set_ydata([0, slope])
    ...     return [line]
    >>> experiment = explore(draw, alt="A line that rises as its slope does.", slope=(-1.0, 1.0))
    >>> experiment.set(slope=0.5).values()  # a reader moves the slider, a test calls `set`
    {'slope': 0.5}
    """

    def __init__(self, draw: Callable[..., Drawn], alt: str, controls: dict[str, Any]) -> None:
        self.draw = draw
        self.alt = alt
        self.controls = controls
        self.error: Exception | None = None
        self._figure: Figure | None = None
        handles = [control for control in controls.values() if hasattr(control, "with_handles")]
        self._dragged = handles[0] if handles else None
        self.picture: Any = self._dragged or ipywidgets.Image(format="png")
        self.picture.add_class("mocap-picture")
        self.message = ipywidgets.HTML(layout={"display": "none"})
        self.picture.layout = {"flex": "1 1 320px", "max_width": "max-content", "min_width": "0"}
        below = ipywidgets.HBox([self.picture, self.message])
        below.layout = {"flex_flow": "row wrap", "align_items": "flex-start", "width": "100%"}
        parts = [control for control in controls.values() if control is not self.picture]
        parts += [below, ipywidgets.HTML(f"<small>{html.escape(alt)}</small>"), Naming(alt=alt)]
        self.box = ipywidgets.VBox(parts, layout={"align_items": "flex-start"})
        self.set()
        for control in controls.values():
            control.observe(lambda _: self.refresh(), "value")

    def __repr__(self) -> str:
        values = "".join(f", {name}={value!r}" for name, value in self.values().items())
        return f"Experiment({self.draw.__name__}{values})"

    def values(self) -> dict[str, Any]:
        """Return the values of the controls by name."""
        return {name: control.value for name, control in self.controls.items()}

    def set(self, **values: Any) -> Experiment:  # noqa: ANN401
        """Set controls as a reader would, redraw, and raise any exception of `draw`, for tests."""
        for name, value in values.items():
            self.controls[name].value = value
        self.refresh()
        if self.error:
            raise self.error
        return self

    def refresh(self) -> None:
        """Redraw the picture, or show the error in its place until a call of `draw` succeeds."""
        try:
            self.png = self._png(self.draw(**self.values()))
            self.error = None
            if self._dragged:
                self._dragged.show(self.png)
            else:
                self.picture.value = self.png
        except Exception as error:  # any exception, because a student's function raises it
            self.error = error
            said = traceback.format_exception_only(error)[-1].strip()
            for frame in traceback.extract_tb(error.__traceback__)[1:2]:  # in the student's function
                said += f"\n({frame.name}, line {frame.lineno}: {frame.line})"
            style = "color:var(--jp-error-color1, #A00000); white-space:pre-wrap"
            self.message.value = f"<pre style='{style}'>{html.escape(said)}</pre>"
        self.picture.layout.display = "none" if self.error else None
        self.message.layout.display = None if self.error else "none"

    def _png(self, drawn: Drawn) -> bytes:
        """Draw a whole figure, or the artists of a list over the stored picture of all others.

        Matplotlib omits `animated` artists from a full drawing, and their changes do not make a figure stale.
        While the figure is not stale, the stored background is valid, and the artists are drawn on it.
        """
        figure = figure_of(drawn)
        moved = isinstance(drawn, Sequence) and all(isinstance(part, Artist) for part in drawn)
        artists = sorted(drawn, key=Artist.get_zorder) if moved else []
        if figure is not self._figure:
            self._take(figure)
        for artist in artists:
            if not artist.get_animated():
                artist.set_animated(True)
                figure.stale = True
        if figure.stale:
            legible(figure)
            self._canvas.draw()
            self._background = self._canvas.copy_from_bbox(figure.bbox)
        else:
            self._canvas.restore_region(self._background)
        for artist in artists:
            if hasattr(artist, "do_3d_projection"):
                artist.do_3d_projection()
            artist.draw(self._canvas.get_renderer())
        picture = Image.fromarray(np.asarray(self._canvas.buffer_rgba()))
        stream = io.BytesIO()
        picture.convert("RGB").save(stream, "png", compress_level=1)  # fast rather than small
        return stream.getvalue()

    def _take(self, figure: Figure) -> None:
        """Take a new figure, and reuse the positions of its axes, as a layout is as slow as a drawing."""
        plt.close(figure)  # otherwise the notebook shows it a second time, and pyplot never releases it
        previous = self._figure
        self._figure = figure
        self._canvas = FigureCanvasAgg(figure)
        if previous and _have_same_layout(figure, previous):
            figure.set_layout_engine("none")
            for axes, previous_axes in zip(figure.axes, previous.axes, strict=True):
                axes.set_position(previous_axes.get_position(original=True))
        figure.stale = True

    def still(self) -> tuple[dict[str, str], dict[str, Any]]:
        """Return the picture with its handles as a PNG, for notebooks without Python."""
        drawn = self._dragged.with_handles() if self._dragged else Image.open(io.BytesIO(self.png))
        small = few_colours(drawn, letters_of(self._canvas.figure) * self._canvas.figure.dpi)
        return Picture(small, self.alt)._repr_mimebundle_()

    def _ipython_display_(self) -> None:
        display_live(self.still(), self.box, "slider")


def _have_same_layout(figure: Figure, previous: Figure) -> bool:
    """Return whether two figures have the same size and number of axes."""
    sizes_agree = (figure.get_size_inches() == previous.get_size_inches()).all()
    return bool(sizes_agree and len(figure.axes) == len(previous.axes))
