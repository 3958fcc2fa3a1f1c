"""Pictures in notebooks: a small PNG with an alternative text for readers who do not see it."""

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
COLOURS = 256  # colours of the palette. The loss is hardly visible, and the file is less than half as large
SLIDE = (1168, 480)  # pixels, the width and the height of a picture on a slide
LETTERS = 21  # pixels, the size of the smallest letters on a slide
SHOWN = 14  # pixels, the largest size of the smallest letters on a page
POINTS = 72  # points of type in an inch


def show(drawn: Any, alt: str) -> Picture:  # noqa: ANN401 (whatever a plotting function returns)
    """Show a picture as the last line of a cell, with an alternative text that describes it.

    Parameters
    ----------
    drawn : artists, axes or a figure, as returned by the functions of `plotting`. The whole figure is shown.
    alt : a sentence that describes the picture, for readers who do not see it.

    Returns
    -------
    The picture. The figure is closed, because otherwise the notebook would show it a second time.

    Raises
    ------
    MocapError : without a sentence, and if `drawn` belongs to no figure.

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
    """A PNG and the sentence that describes it, both displayed by a notebook.

    Parameters
    ----------
    picture : the PNG, as bytes.
    alt : a sentence that describes the picture.
    fitted : show it at `shown_width`; otherwise a page shows it as wide as it is.

    Examples
    --------
    >>> picture = show(plt.figure().add_subplot().plot([1, 4, 9]), alt="A curve that rises.")
    >>> picture.picture[1:4], picture.alt
    (b'PNG', 'A curve that rises.')
    """

    picture: bytes = field(repr=False)
    alt: str
    fitted: bool = field(default=True, repr=False)

    def __repr__(self) -> str:
        return f"Picture({self.alt!r})"

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, str], dict[str, Any]]:
        data = base64.b64encode(self.picture).decode()
        attributes: dict[str, Any] = {"alt": self.alt}
        if self.fitted:
            attributes["width"] = shown_width(self.picture)
        tags = "".join(f' {name}="{html.escape(str(value))}"' for name, value in attributes.items())
        tag = f'<img{tags} src="data:image/png;base64,{data}">'
        # JupyterLab and nbconvert drop the alt text of an image/png, and keep that of HTML.
        return {"text/html": tag, "image/png": data, "text/plain": self.alt}, {"image/png": attributes}


def figure_of(drawn: Any) -> Figure:  # noqa: ANN401
    """Find the figure of artists, axes, or lists of them.

    Raises
    ------
    MocapError : if they belong to no figure.
    """
    parts = [drawn]
    while parts:
        part = parts.pop(0)
        if isinstance(part, list | tuple | np.ndarray):
            parts[:0] = getattr(part, "flat", part)
            continue
        figure = getattr(part, "figure", None)
        if isinstance(figure, Figure):
            return figure
    raise MocapError(f"A picture must be given as a figure, or artists on one, not as {drawn!r:.99}.")


def legible(figure: Figure, room: tuple[int, int] = SLIDE) -> Figure:
    """Enlarge the letters that would be too small on a slide, and return the figure.

    Parameters
    ----------
    figure : the figure, which is changed in place.
    room : the width and the height of the picture on the slide, pixels.
    """
    pixels_per_inch = np.min(room / figure.get_size_inches())
    smallest = POINTS * LETTERS / pixels_per_inch
    for text in figure.findobj(Text):
        text.set_fontsize(max(text.get_fontsize(), smallest))
    return figure


def letters_of(figure: Figure) -> float:
    """Return the size of a figure's smallest visible letters, inches, or infinity without letters."""
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return min((float(text.get_fontsize()) for text in texts), default=np.inf) / POINTS


def shown_width(png: bytes) -> int:
    """Return the width, pixels, at which a page shows a picture with letters as large as those of its text.

    Letters that can be read on a slide are twice as large as the text of a page around the same picture. A
    picture is never enlarged. One whose letters are not known keeps its width.

    Parameters
    ----------
    png : a picture that `small_png` or `few_colours` encoded.
    """
    picture = Image.open(io.BytesIO(png))
    letters = float(picture.info.get("letters", np.inf))
    if letters == np.inf:
        return picture.width
    return int(picture.width * min(1.0, SHOWN / letters))


def small_png(figure: Figure, **notes: str) -> bytes:
    """Encode a figure as a PNG of few colours, with notes in its metadata."""
    png = io.BytesIO()
    figure.savefig(png, format="png", dpi=DPI, pil_kwargs={"compress_level": 1})
    letters = letters_of(figure) * DPI
    return few_colours(Image.open(png), letters, Image.Quantize.MAXCOVERAGE, **notes)


def few_colours(
    picture: Image.Image,
    letters: float = np.inf,
    method: Image.Quantize = Image.Quantize.MAXCOVERAGE,
    **notes: str,
) -> bytes:
    """Encode a picture as a PNG of few colours.

    Parameters
    ----------
    picture : the picture.
    letters : the size of its smallest letters, pixels, which is stored in the metadata.
    method : how colours are chosen. An octree keeps shades and large backgrounds.
    notes : further metadata, by name.
    """
    quantized = picture.convert("RGB").quantize(COLOURS, method)
    metadata = PngInfo()
    for name, note in {"letters": f"{letters:.1f}", **notes}.items():
        metadata.add_text(name, note)
    png = io.BytesIO()
    quantized.save(png, "png", optimize=True, pnginfo=metadata)
    return png.getvalue()
