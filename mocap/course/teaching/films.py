"""A film of a notebook's deck, without a voice: a scene for each of its slides.

A scene shows the picture, the player or the recorded experiment of a slide above the slide's words; a slide
without one is a card of its words. It lasts as long as its words take to read.
"""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import repeat, zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont, ImageOps

from mocap._shared.atomic import replacing
from mocap._shared.progress import Progress
from mocap.course.notebooks import read
from mocap.course.site import STILL, recorded_of
from mocap.course.teaching.board import DISC, INK, PAPER, SMOOTH, font_of
from mocap.course.teaching.slides import Slide, deck_file, deck_of
from mocap.errors import MocapError
from mocap.widgets.film import require_ffmpeg, write_mp4
from mocap.widgets.filmed_scene import FilmedScene, stored_scene

SPEED = 15.0  # characters that are read per second
LOOK = {"card": 3.0, "still": 5.0, "moving": 9.0, "player": 10.0}  # seconds of a scene at least
SIZE = (1280, 720)  # pixels
FPS = 20.0  # frames per second
TOP = 84  # pixels above the middle of a scene
EDGE = 56  # pixels left and right of it
ROOM = (1168, 506)  # pixels, its size
LABEL_ROOM = 34  # pixels below a picture with a label
SOFT = "#595959"  # of labels
SWEEP = 0.7  # seconds that a position of an experiment is shown
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
DIGITS = {"_": "₀₁₂₃₄₅₆₇₈₉", "^": "⁰¹²³⁴⁵⁶⁷⁸⁹"}
GREEK = dict(zip((r"\alpha", r"\beta", r"\theta", r"\phi", r"\sigma", r"\pi"), "αβθφσπ", strict=True))
GREEK |= {r"\times": "×", r"\le": "≤", r"\ge": "≥", r"\cdot": "·", r"\,": " ", r"\to": "→"}


def render_film(notebook: Path, out: Path, *, moving: bool = True, progress: Progress = iter) -> Path:
    """Render a film of a notebook as an .mp4.

    Parameters
    ----------
    notebook : the file, with its outputs.
    out : the file to write, an .mp4; nothing is left behind when rendering fails.
    moving : run the notebook first, to record its experiments; else they stand still.
    progress : wraps the scenes while they are drawn.

    Returns
    -------
    The file.

    Raises
    ------
    MocapError : for another ending, without imageio-ffmpeg, and for a notebook that does not run or has
        no deck.

    Examples
    --------
    >>> render_film(Path("nowhere.ipynb"), Path("film.mov"))
    Traceback (most recent call last):
    mocap.errors.MocapError: A film of a notebook is written as .mp4, got 'film.mov'.
    """
    if out.suffix.lower() != ".mp4":
        raise MocapError(f"A film of a notebook is written as .mp4, got '{out}'.")
    require_ffmpeg()
    contents = read(notebook)
    slides = deck_of(deck_file(notebook), contents)
    scenes = script_of(slides, recorded_of(notebook, contents) if moving else {})
    with replacing(out) as unfinished:
        write_mp4(frames_of(scenes, progress), unfinished, FPS)
    return out


@dataclass
class Scene:
    """A scene of a film: its kind, its heading, its words, what it shows, and how long.

    `pictures` are PNGs: one of a still scene, many of a moving one, with `labels`.
    """

    kind: str
    heading: str
    words: str
    pictures: list[bytes] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    figures: FilmedScene | None = None

    @property
    def seconds(self) -> float:
        """How long it is shown: as long as its words take to read, or more."""
        return max(LOOK[self.kind], len(self.words) / SPEED + 0.5)


def script_of(slides: Iterable[Slide], recorded: Mapping[str, Any]) -> list[Scene]:
    """Give the scenes of a film: of a slide, one for each thing that it shows, or one of its words alone.

    Parameters
    ----------
    slides : from `deck_of`; exercises are for the class.
    recorded : recordings of experiments by the source of their cell; without one, a still picture is shown.
    """
    scenes = []
    for slide in (slide for slide in slides if slide.label != "Exercise"):
        words = _words_of(slide)
        heading = spoken(f"{slide.label}: {slide.heading}" if slide.label else slide.heading)
        shown = [parts for cell in slide.cells for parts in _shown(cell, recorded)]
        scenes += [Scene(kind, heading, " ".join(words), *parts) for kind, *parts in shown]
        if words and not shown:
            scenes.append(Scene("card", heading, "\n".join(words)))
    return scenes


def _words_of(slide: Slide) -> list[str]:
    """List the lines of a slide's text as plain words; the cells of a table's row have tabs between them."""
    written = [cell.source for cell in slide.cells if cell.cell_type == "markdown"]
    texts = [text for text in written if not text.startswith("![")]
    lines = [line for text in texts for line in text.splitlines() if re.search("[^-|: ]", line)]
    rows = (re.sub(r"^\s*(?:[-*]|\d+\.) ", "", line).strip("|").split(" | ") for line in lines)
    return list(filter(None, ("\t".join(map(spoken, row)) for row in rows)))


def _shown(cell: Any, recorded: Mapping[str, Any]) -> Iterator[tuple[Any, ...]]:  # noqa: ANN401
    """Yield what a cell shows: the kind of a scene, its pictures, their labels, and figures."""
    attached = re.match(r"!\[.*\]\(attachment:(.*)\)", cell.source, re.DOTALL)
    if attached:
        yield "still", [base64.b64decode(cell.attachments[attached[1]]["image/png"])]
    code = cell.metadata.get("code")
    for output in cell.get("outputs", ()):
        data = output.get("data", {})
        page = data.get("text/html", "")
        figures = stored_scene(page)
        if figures:
            yield "player", [], [], figures
        elif STILL in page and code in recorded:
            recording = recorded[code]
            pictures = [base64.b64decode(picture) for picture in recording["pictures"]]
            yield "moving", pictures, [f"{recording['name']}: {label}" for label in recording["labels"]]
        elif "image/png" in data:
            yield "still", [base64.b64decode(data["image/png"])]


def spoken(text: str) -> str:
    r"""Give a text as plain words for a caption, or nothing where a formula cannot be written as words.

    Examples
    --------
    >>> spoken("The [*cost*](GLOSSARY.md#cost) of `grid` falls with $\\theta$.")
    'The cost of grid falls with θ.'
    >>> spoken(r"It is $\\frac{1}{2}$.")
    ''
    """
    text = re.sub(r"([_^])(\d)", lambda match: DIGITS[match[1]][int(match[2])], COMMENT.sub("", text))
    for word in sorted(GREEK, key=len, reverse=True):
        text = text.replace(word, GREEK[word])
    if re.search(r"\$[^$]*[\\^_{][^$]*\$|<", text):
        return ""
    without_links = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r" ?\[\d+(?:, [^\]]*)?\]", "", without_links)
    return " ".join(re.sub(r"[*`$]|(?<!\w)_|_(?!\w)", "", text).split())


def frames_of(scenes: list[Scene], progress: Progress = iter) -> Iterator[NDArray[np.uint8]]:
    """Draw a film, frame by frame, each of shape (720, 1280, 3); a bar shows how much of it is over."""
    total = sum(scene.seconds for scene in scenes)
    begun = 0.0  # seconds of the scenes before
    for scene in progress(scenes):
        page = _page(scene)
        middle = _middle(scene)
        for number in range(round(scene.seconds * FPS)):
            time = number / FPS
            if number == 0 or scene.kind in ("player", "moving"):
                page.paste(middle(time), (EDGE, TOP))
            bar = round((begun + time) / total * SIZE[0])
            ImageDraw.Draw(page).rectangle([0, SIZE[1] - 6, bar, SIZE[1]], DISC)
            yield np.asarray(page)
        begun += scene.seconds


def _page(scene: Scene) -> Image.Image:
    """Draw what stays in a scene: its heading, and its words unless they are all that it shows."""
    page = Image.new("RGB", SIZE, PAPER)
    heading = scene.heading
    pen = ImageDraw.Draw(page)
    while font_of(36, bold=True).getlength(heading) > ROOM[0]:
        heading = heading[:-2].rstrip() + "…"
    pen.text((EDGE, 24), heading, INK, font_of(36, bold=True))
    if scene.kind != "card":
        lines = wrapped(scene.words, font_of(26), ROOM[0])
        pen.multiline_text((EDGE, TOP + ROOM[1] + 10), "\n".join(lines[:3]), INK, font_of(26), spacing=8)
    return page


def _middle(scene: Scene) -> Callable[[float], Image.Image]:
    """Give the function that draws the middle of a scene at a time."""
    figures = scene.figures
    if figures is not None:
        return lambda time: Image.fromarray(figures.picture(time, ROOM))
    pictures = [_card(scene.words)] if scene.kind == "card" else []
    for data, label in zip(scene.pictures, scene.labels or repeat(""), strict=False):
        high = ROOM[1] - LABEL_ROOM if label else ROOM[1]
        picture = ImageOps.pad(Image.open(io.BytesIO(data)).convert("RGBA"), (ROOM[0], high), SMOOTH)
        page = Image.new("RGB", ROOM, PAPER)
        page.paste(picture, (0, 0), picture)
        ImageDraw.Draw(page).text((ROOM[0] / 2, ROOM[1] - 30), label, SOFT, font_of(22), anchor="ma")
        pictures.append(page)
    there_and_back = pictures + pictures[-2:0:-1]
    return lambda time: there_and_back[int(time / SWEEP) % len(there_and_back)]


def _card(words: str) -> Image.Image:
    """Write words large; a line of them is a point of a list, or a row of a table with tabs in it."""
    page = Image.new("RGB", (ROOM[0], ROOM[1] + 60), PAPER)
    rows = [row.split("\t") for row in words.split("\n")]
    mark = "• " if len(rows) > 1 else ""
    columns = list(zip_longest(*(row for row in rows if row[1:]), fillvalue=""))
    for size in (34, 30, 26, 22):
        font = font_of(size)
        places = [0, *np.cumsum([max(map(font.getlength, column)) + size for column in columns])]
        lines = [line for row in rows for line in _lines_of(row, mark, font)]
        if len(lines) * size * 1.35 < page.height and places[-1] <= page.width + size:
            break
    for number, cells in enumerate(lines):
        for place, cell in zip(places, cells, strict=False):
            ImageDraw.Draw(page).text((place, 10 + 1.35 * size * number), cell, INK, font)
    return page


def _lines_of(row: list[str], mark: str, font: ImageFont.FreeTypeFont) -> list[list[str]]:
    """Break a row into lines; one of a table stays one line, and an empty line follows a point of a list."""
    if row[1:]:
        return [row]
    return [[line] for line in [*wrapped(mark + row[0], font, ROOM[0]), ""]]


def wrapped(words: str, font: ImageFont.FreeTypeFont, width: float) -> list[str]:
    """Break words into lines that are no wider than a width, pixels."""
    lines = [""]
    for word in words.split():
        longer = f"{lines[-1]} {word}".strip()
        if font.getlength(longer) <= width or not lines[-1]:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
