"""Pictures as notebooks keep them: a small PNG, and a sentence for readers who do not see it."""

from __future__ import annotations

import base64
import html
import io
from dataclasses import dataclass, field
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from mocap.errors import MocapError

DPI = 110
COLOURS = 256  # in the palette: the loss is hardly seen, and the file is less than half as large
SLIDE = (1168, 480)  # pixels that a slide has for a picture, across and down
LETTERS = 21  # pixels of the smallest letters there


def show(drawn: Any, alt: str) -> Picture:  # noqa: ANN401 (whatever a plotting function gives)
    """Show a picture as the last line of a cell, with a sentence that describes it.

    Parameters
    ----------
    drawn : what a function of `plotting` gives: artists, axes or a figure; the whole figure is shown.
    alt : a sentence that says what the picture shows, for readers who do not see it.

    Returns
    -------
    The picture. The figure is closed; otherwise the notebook would show it a second time.

    Raises
    ------
    MocapError : without a sentence, and where `drawn` is on no figure.

    Examples
    --------
    >>> show(plt.figure().add_subplot().plot([1, 4, 9]), alt="A curve that rises.")
    Picture('A curve that rises.')

    Notebook: 00-quickstart
    """
    if not alt.strip():
        raise MocapError("A picture needs a sentence for readers who do not see it: alt='...'.")
    figure = figure_of(drawn)
    plt.close(figure)
    return Picture(small_png(legible(figure)), alt)


@dataclass(frozen=True)
class Picture:
    """What `show` returns: a PNG and its sentence; a notebook shows both.

    Parameters
    ----------
    picture : the PNG, as bytes.
    alt : a sentence that says what the picture shows.

    Examples
    --------
    >>> picture = show(plt.figure().add_subplot().plot([1, 4, 9]), alt="A curve that rises.")
    >>> picture.picture[1:4], picture.alt
    (b'PNG', 'A curve that rises.')
    """

    picture: bytes = field(repr=False)
    alt: str

    def __repr__(self) -> str:
        return f"Picture({self.alt!r})"

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, str], dict[str, Any]]:
        data = base64.b64encode(self.picture).decode()
        tag = f'<img alt="{html.escape(self.alt)}" src="data:image/png;base64,{data}">'
        # JupyterLab and nbconvert drop the alt text of an image/png, and keep that of HTML.
        return {"text/html": tag, "image/png": data, "text/plain": self.alt}, {"image/png": {"alt": self.alt}}


def figure_of(drawn: Any) -> Figure:  # noqa: ANN401
    """Find the figure that holds artists, axes, or lists of them.

    Raises
    ------
    MocapError : where no figure holds them.
    """
    parts = [drawn]
    while parts:
        part = parts.pop(0)
        if isinstance(part, list | tuple | np.ndarray):
            parts[:0] = getattr(part, "flat", part)
        elif isinstance(figure := getattr(part, "figure", None), Figure):
            return figure
    raise MocapError(f"A picture must be given as a figure, or artists on one, not as {drawn!r:.99}.")


def legible(figure: Figure, room: tuple[int, int] = SLIDE) -> Figure:
    """Enlarge letters that a slide with room for so many pixels would show too small; return the figure."""
    least = 72 * LETTERS / np.min(room / figure.get_size_inches())  # points
    for text in figure.findobj(Text):
        text.set_fontsize(max(text.get_fontsize(), least))
    return figure


def letters_of(figure: Figure) -> float:
    """Give the size of a figure's smallest letters, inches."""
    written = (text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip())
    return min((float(text.get_fontsize()) for text in written), default=np.inf) / 72


def small_png(figure: Figure, **notes: str) -> bytes:
    """Draw a figure as a PNG of few colours, with notes inside."""
    figure.savefig(full := io.BytesIO(), format="png", dpi=DPI, pil_kwargs={"compress_level": 1})
    return few_colours(Image.open(full), letters_of(figure) * DPI, **notes)


def few_colours(picture: Image.Image, letters: float = np.inf, **notes: str) -> bytes:
    """Encode a picture as a PNG of few colours, which says how many pixels its smallest letters have."""
    few, inside = picture.convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE), PngInfo()
    for name, note in {"letters": f"{letters:.1f}", **notes}.items():
        inside.add_text(name, note)
    few.save(small := io.BytesIO(), "png", optimize=True, pnginfo=inside)
    return small.getvalue()
