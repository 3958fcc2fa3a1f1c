"""A film of about three minutes per notebook: its headings, pictures, players and words, without a voice."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from mocap._shared.atomic import replacing
from mocap._shared.progress import Progress
from mocap.course import read
from mocap.course.site import recorded_of
from mocap.course.teaching.film_script import Scene, script_of
from mocap.errors import MocapError
from mocap.widgets.film import require_ffmpeg, write_mp4

SIZE, FPS = (1280, 720), 20.0
TOP, BOTTOM, EDGE = 84, 590, 56  # pixels: where the picture begins and ends, and the margin at the sides
INK, SOFT, PAPER, DONE = "#222222", "#595959", "#FFFFFF", "#0072B2"
SWEEP = 0.7  # seconds that a position of an experiment is shown
Draw = Callable[[float], Image.Image]


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
        nothing to show.

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
    scenes = script_of(contents, recorded_of(notebook, contents) if moving else {})
    if not scenes:
        raise MocapError(f"{notebook}: has no heading, picture or player to show.")
    with replacing(out) as beside:
        write_mp4(frames_of(scenes, progress), beside, FPS)
    return out


def frames_of(scenes: list[Scene], progress: Progress = iter) -> Iterator[NDArray[np.uint8]]:
    """Draw a film, frame by frame, each of shape (720, 1280, 3)."""
    total, done = sum(scene.seconds for scene in scenes), 0.0
    for scene in progress(scenes):
        page = _page(scene)
        draw = _drawn(scene)
        for number in range(round(scene.seconds * FPS)):
            time = number / FPS
            if number == 0 or scene.kind in ("player", "moving"):
                inner = draw(time)
                page.paste(inner, (EDGE, TOP))
            _bar(page, (done + time) / total)
            yield np.asarray(page)
        done += scene.seconds


def _bar(page: Image.Image, share: float) -> None:
    """Show how much of the film is over."""
    ImageDraw.Draw(page).rectangle([0, SIZE[1] - 6, round(share * SIZE[0]), SIZE[1]], DONE)


def _page(scene: Scene) -> Image.Image:
    """Draw what stays in a scene: its heading, and its words unless they are all that it shows."""
    page = Image.new("RGB", SIZE, PAPER)
    pen = ImageDraw.Draw(page)
    pen.text((EDGE, 24), _fitting(scene.heading, 36, SIZE[0] - 2 * EDGE), INK, font_of(36, bold=True))
    if scene.kind != "card":
        lines = _wrapped(scene.words, font_of(26), SIZE[0] - 2 * EDGE)
        pen.multiline_text((EDGE, BOTTOM + 10), "\n".join(lines[:3]), INK, font_of(26), spacing=8)
    return page


def _drawn(scene: Scene) -> Draw:
    """Give the function that draws the middle of a scene at a time."""
    if scene.kind == "player":
        assert scene.figures
        return lambda time: scene.figures.picture(time, (SIZE[0] - 2 * EDGE, BOTTOM - TOP))  # type: ignore[union-attr]
    if scene.kind == "card":
        card = _card(scene.words)
        return lambda _: card
    labels = scene.labels or [""]
    pictures = [_framed(data, label) for data, label in zip(scene.pictures, labels, strict=True)]
    there = [*range(len(pictures)), *range(len(pictures) - 2, 0, -1)] or [0]  # to the end and back
    return lambda time: pictures[there[int(time / SWEEP) % len(there)]]


def _framed(data: bytes, label: str) -> Image.Image:
    """Bring a picture to the size of the middle, above its label."""
    room = (SIZE[0] - 2 * EDGE, BOTTOM - TOP - 34 * bool(label))
    picture = Image.open(io.BytesIO(data)).convert("RGBA")
    picture = fitted(picture, room)
    page = Image.new("RGB", (SIZE[0] - 2 * EDGE, BOTTOM - TOP), PAPER)
    page.paste(picture, ((page.width - picture.width) // 2, (room[1] - picture.height) // 2), picture)
    if label:
        ImageDraw.Draw(page).text((page.width / 2, page.height - 30), label, SOFT, font_of(22), anchor="ma")
    return page


def fitted(picture: Image.Image, room: tuple[int, int]) -> Image.Image:
    """Make a picture as large as fits into a width and a height, pixels."""
    scale = min(room[0] / picture.width, room[1] / picture.height)
    size = (max(1, round(scale * picture.width)), max(1, round(scale * picture.height)))
    return picture.resize(size, Image.Resampling.LANCZOS)


def _card(words: str) -> Image.Image:
    """Write words large; a line of them is a point of a list."""
    page = Image.new("RGB", (SIZE[0] - 2 * EDGE, BOTTOM - TOP + 60), PAPER)
    for size in (34, 30, 26, 22, 19):
        font, points = font_of(size), words.split("\n")
        mark = "• " if len(points) > 1 else ""
        lines = [line for point in points for line in [*_wrapped(mark + point, font, page.width), ""]]
        if len(lines) * size * 1.35 < page.height:
            break
    ImageDraw.Draw(page).multiline_text((0, 10), "\n".join(lines), INK, font, spacing=size * 0.3)
    return page


def _wrapped(words: str, font: ImageFont.FreeTypeFont, width: float) -> list[str]:
    """Break words into lines that are no wider than a width, pixels."""
    lines = [""]
    for word in words.split():
        longer = f"{lines[-1]} {word}".strip()
        if font.getlength(longer) > width and lines[-1]:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def _fitting(words: str, size: int, width: float) -> str:
    """Cut a heading that is too long for its line."""
    while font_of(size, bold=True).getlength(words) > width:
        words = words[:-2].rstrip() + "…"
    return words


@cache
def font_of(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Give the font of Matplotlib's pictures, which has Greek letters."""
    found = find_spec("matplotlib")
    assert found
    assert found.origin
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(found.origin).parent / "mpl-data" / "fonts" / "ttf" / name), size)
