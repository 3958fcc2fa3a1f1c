"""Experiments for notebooks: a picture with controls, drawn anew when a control moves.

What `explore` shows has three forms: live controls where Python runs, a PNG where it does not (a code host, a
printed page, a notebook that is opened again), and a sentence where there are no pictures. While a control is
dragged, the browser sends its latest value as soon as the last picture is drawn.
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

Drawn = Any  # a figure, what a function of `plotting` gives, or a list of moved artists


def explore(draw: Callable[..., Drawn], *, alt: str, **controls: Any) -> Experiment:  # noqa: ANN401
    """Show a picture with controls, and draw it anew whenever one of them moves.

    Where little moves, let `draw` move the artists of one figure and return them: then only these are drawn
    again, over a stored picture of the rest, which is faster.

    Parameters
    ----------
    draw : called with the controls' values by name; returns what it drew, or a list of the artists it moved.
    alt : a sentence that says what the picture shows, for readers who do not see it.
    controls : name=(low, high) or (low, high, step) for a slider, a bool for a check box, a list or
        {label: value} for a choice, `handles` to drag on what `draw` returns, or a widget. A control starts
        at the default in `draw`'s signature, handles where they were made.

    Returns
    -------
    The experiment; a notebook shows it as the last line of a cell.

    Raises
    ------
    MocapError : for a control that `draw` does not take, and for a value that makes no control.
    Exception : whatever `draw` raises at first. Later, the notebook shows the error in the picture's place.

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
    """Make the widget of a control, with its name as the description."""
    try:
        widget = ipywidgets.interactive.widget_from_abbrev(control, default)
    except (ValueError, TypeError):
        widget = None
    if widget is None:
        raise MocapError(f"The control {name}={control!r} is no range, choice or widget.")
    widget.description = name.replace("_", " ")
    return widget


def step_aside(reason: object) -> None:
    """Print in one sentence why a notebook cannot go on, and make the cells below do nothing.

    Parameters
    ----------
    reason : an error, or a sentence.

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
    """The controls, the picture and the last error of an experiment, as `explore` returns it.

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
        """Return the controls' values by name."""
        return {name: control.value for name, control in self.controls.items()}

    def set(self, **values: Any) -> Experiment:  # noqa: ANN401
        """Move controls as a reader would, draw at once, and raise what `draw` raises; for tests."""
        for name, value in values.items():
            self.controls[name].value = value
        self.refresh()
        if self.error:
            raise self.error
        return self

    def refresh(self) -> None:
        """Draw anew; an error is shown in the picture's place until a drawing works again."""
        try:
            self.png = self._png(self.draw(**self.values()))
            self.error = None
            if self._dragged:
                self._dragged.show(self.png)
            else:
                self.picture.value = self.png
        except Exception as error:  # of any kind: it comes from a student's function
            self.error = error
            said = traceback.format_exception_only(error)[-1].strip()
            for frame in traceback.extract_tb(error.__traceback__)[1:2]:  # in the student's function
                said += f"\n({frame.name}, line {frame.lineno}: {frame.line})"
            style = "color:var(--jp-error-color1, #A00000); white-space:pre-wrap"
            self.message.value = f"<pre style='{style}'>{html.escape(said)}</pre>"
        self.picture.layout.display = "none" if self.error else None
        self.message.layout.display = None if self.error else "none"

    def _png(self, drawn: Drawn) -> bytes:
        """Draw a whole figure; or, for a list of artists, these over the stored picture of all others.

        Matplotlib leaves `animated` artists out of a full drawing, and their changes do not make a figure
        stale. While the figure is not stale, the stored background is valid, and the artists are drawn on it.
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
        """Take a new figure; its axes get the old ones' positions: a layout takes as long as a drawing."""
        plt.close(figure)  # or the notebook shows it a second time, and pyplot keeps it for ever
        previous = self._figure
        self._figure = figure
        self._canvas = FigureCanvasAgg(figure)
        if previous and _have_same_layout(figure, previous):
            figure.set_layout_engine("none")
            for axes, previous_axes in zip(figure.axes, previous.axes, strict=True):
                axes.set_position(previous_axes.get_position(original=True))
        figure.stale = True

    def still(self) -> tuple[dict[str, str], dict[str, Any]]:
        """Return the picture for where no Python runs, with its handles, as a PNG."""
        drawn = self._dragged.with_handles() if self._dragged else Image.open(io.BytesIO(self.png))
        small = few_colours(drawn, letters_of(self._canvas.figure) * self._canvas.figure.dpi)
        return Picture(small, self.alt)._repr_mimebundle_()

    def _ipython_display_(self) -> None:
        display_live(self.still(), self.box, "slider")


def _have_same_layout(figure: Figure, previous: Figure) -> bool:
    """Check whether two figures have the same size and number of axes."""
    sizes_agree = (figure.get_size_inches() == previous.get_size_inches()).all()
    return bool(sizes_agree and len(figure.axes) == len(previous.axes))
