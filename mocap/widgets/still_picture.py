"""The picture of a player where no script runs: shaded bodies that are apart from each other, with names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.plotting.picture import LETTERS, SLIDE, few_colours
from mocap.plotting.props import boxes_with, diamonds, rims
from mocap.plotting.style import ASKED
from mocap.widgets.filmed_scene import ASKED_WIDTH, FLAT, PATH_WIDTH, SEAM_RADIUS, XZ, FilmedScene
from mocap.widgets.shaded_picture import FOCUS, GROUND, YAW, ShadedPicture
from mocap.widgets.still_bodies import Body, bodies_in_rows, requested_path, walks_on_ground, yaw_of_paths
from mocap.widgets.walk_figure import capsules_at

WIDTH = 990  # pixels, the greatest width
SLIM = 640  # pixels, the least width, which has room for a legend
SMALLEST = 22  # pixels, the least size of letters
LOWEST = 170  # pixels, the least height of a row
HIGHEST = 640  # pixels, the greatest height of all rows
MARGIN = 14  # pixels
LINE = 1.5  # height of a line of the legend, as a multiple of its letters
PITCH = np.radians(22)  # radians, downwards
ROW_PITCH = np.radians(9)  # radians, for poses in a row
FARNESS = 3.0  # distance of the camera, as a multiple of the extent of the scene
SEEN = 1.4  # distance to which the grid is drawn, as a multiple of the extent of the scene
EXTENT = 4.0  # metres, the least extent from which that distance is computed
ROUNDS = 4  # of the fit of the camera
TAGGED = 4  # largest number of characters with names above their heads
HEADROOM = np.array([0, 0.16, 0])  # metres, from the highest joint to the name above a head
SEAM_FRACTION = 0.008  # least radius of the mark of a seam, as a fraction of the path's extent
NAME_SHAPE = 4.0  # width of a name, as a multiple of its height
WIDE = 0.35  # metres, half the width of a body with its arms
PAPER = "#FFFFFF"
GRID = "#BDB6A8"
INK = "#222222"


class _Entry(NamedTuple):
    """An entry of a legend: the colours of its swatch, none for a remark, and its text."""

    colours: tuple[str, ...]
    text: str


def still_picture(scene: dict[str, Any], *, legend: bool = True, letters: float = SMALLEST) -> bytes:
    """Draw the whole motion of a scene as a PNG.

    Parameters
    ----------
    scene : as `Player.scene`.
    legend : whether there is a legend above the picture.
    letters : the least size of letters, pixels.

    Examples
    --------
    >>> from mocap import datasets
    >>> from mocap.widgets import play
    >>> still_picture(play(datasets.sample("walk_straight")).scene)[1:4]
    b'PNG'
    """
    film = FilmedScene(scene)
    walks = walks_on_ground(film)
    yaw = yaw_of_paths(film) if walks else YAW
    rows = bodies_in_rows(film)
    whole = _camera(film, [body for row in rows for body in row], yaw, len(rows))
    drawn = [_draw_row(film, row, whole) for row in rows]
    picture = Image.fromarray(np.concatenate(drawn))
    size = max(_letters_on_slide(picture.width, picture.height), letters)
    if legend:  # it makes the picture higher, and thus smaller on a slide
        lines = _draw_legend(_entries(film, rows, whole), picture.width, _font(size))
        size = max(_letters_on_slide(picture.width, picture.height + lines.height), letters)
    font = _font(size)
    _write_names(picture, film, rows, whole, font)
    if legend:
        entries = _draw_legend(_entries(film, rows, whole), picture.width, font)
        paper = Image.new("RGB", (picture.width, picture.height + entries.height), PAPER)
        paper.paste(entries, (0, 0))
        paper.paste(picture, (0, entries.height))
        picture = paper
    return few_colours(picture, size, Image.Quantize.FASTOCTREE)


def _letters_on_slide(width: int, height: int) -> float:
    """Return the size of letters, pixels, that can be read if a picture is as large as fits on a slide."""
    return LETTERS / min(SLIDE[0] / width, SLIDE[1] / height)


class _Camera(NamedTuple):
    """The size of a row, pixels, and its camera: position, directions, and focal length in pixels."""

    size: tuple[int, int]
    target: Array
    distance: float
    yaw: float
    pitch: float
    focus: float

    def page(self) -> ShadedPicture:
        """Return an empty picture."""
        page = ShadedPicture(self.size, self.target, self.distance, yaw=self.yaw, pitch=self.pitch)
        page.focus = self.focus
        page.pen.rectangle(
            (0, 0, *page.paper.size), fill=GROUND
        )  # without a gradient, which needs many colours
        return page

    @property
    def reach(self) -> int:
        """The distance to which the grid on the ground is drawn, metres."""
        return round(SEEN * self.distance / FARNESS)


def _camera(film: FilmedScene, bodies: list[Body], yaw: float, rows: int) -> _Camera:
    """Fit a camera to bodies and paths: its picture is as wide as possible, unless rows would be too high."""
    points = _points_of(film, bodies)
    pitch = PITCH if walks_on_ground(film) else ROW_PITCH
    extent = max(float(np.ptp(points, axis=0).max()), EXTENT)
    target = (points.min(axis=0) + points.max(axis=0)) / 2
    unit = 1000
    page = ShadedPicture((unit, unit), target, FARNESS * extent, yaw=yaw, pitch=pitch)
    for _ in range(ROUNDS):
        page = ShadedPicture((unit, unit), target, FARNESS * extent, yaw=yaw, pitch=pitch)
        pixels, _ = page.pixels(points)
        right, down = (pixels.min(axis=0) + pixels.max(axis=0)) / 2 - unit / 2
        metres = FARNESS * extent / (FOCUS * unit)
        target = target + metres * (right * page.axes[0] - down * page.axes[1])
    wide, high = np.ptp(page.pixels(points)[0], axis=0)
    highest = max(LOWEST, HIGHEST // rows)
    zoom = min((WIDTH - 2 * MARGIN) / wide, (highest - 2 * MARGIN) / high)
    height = max(LOWEST, round(zoom * high) + 2 * MARGIN)
    width = int(np.clip(round(zoom * wide) + 2 * MARGIN, SLIM, WIDTH))
    return _Camera((width, height), target, FARNESS * extent, yaw, pitch, zoom * FOCUS * unit)


def _points_of(film: FilmedScene, bodies: list[Body]) -> Array:
    """Return points that must be visible, (N, 3): the bodies with room around them, and the paths."""
    points = []
    for body in bodies:
        pose = film.pose(body.number, body.time) + body.moved
        sides = WIDE * np.array([[1, 0, 0], [-1, 0, 0], [0, 0, 1], [0, 0, -1]])
        head = pose[pose[:, 1].argmax()]
        points += [pose, pose[0] * FLAT + sides, head[None] + 2 * HEADROOM]
    if walks_on_ground(film):
        points += [path * FLAT for path in film.paths]
        points.append(requested_path(film))
        points += list(rims(film.scene["obstacles"]))
    points.append(boxes_with(film.scene["boxes"], [body.moved for body in bodies]).reshape(-1, 3))
    return np.concatenate(points)


def _draw_row(film: FilmedScene, row: list[Body], camera: _Camera) -> NDArray[np.uint8]:
    """Draw the ground, paths and bodies of a row."""
    page = camera.page()
    numbers = sorted({body.number for body in row})
    film.draw_grid(page, np.round(camera.target * FLAT), camera.reach, GRID)
    film.draw_props(page, [body.moved for body in row])
    if walks_on_ground(film):
        page.line(requested_path(film), to_rgb(ASKED), ASKED_WIDTH)
        for number in numbers:
            _draw_path(page, film, number)
    pieces = []
    colours: list[Any] = []
    for number, time, moved in row:
        character = film.scene["characters"][number]
        pieces.append(capsules_at(character, film.pose(number, time) + moved))
        sides = film.body_colours(number, time)
        colours += [sides[side] for *_, side in character["pieces"]]
    return page.finished(np.concatenate(pieces), np.array(colours))


def _draw_path(page: ShadedPicture, film: FilmedScene, number: int) -> None:
    """Draw the path of a character, red where it leaves the requested path, and its seams."""
    character = film.scene["characters"][number]
    marks = film.scene["marks"]
    middles = (film.times[1:] + film.times[:-1]) / 2
    inks = film.path_colours(number, middles)
    for start, end in character["astray"]:
        inks[(middles >= start) & (middles < end)] = to_rgb(marks["astray"])
    page.line(film.paths[number] * FLAT, inks, PATH_WIDTH)
    extent = float(np.ptp(film.paths[number], axis=0).max())
    radius = max(SEAM_RADIUS, SEAM_FRACTION * extent)
    seams = [[*film.pose(number, seam)[0, XZ], radius] for seam in character["seams"]]
    for diamond in diamonds(seams, page.yaw):
        page.area(diamond, to_rgb(marks["seam"]))


def _font(size: float) -> ImageFont.FreeTypeFont:
    """Return the font of matplotlib's pictures."""
    return ImageFont.truetype(Path(mpl.get_data_path(), "fonts/ttf/DejaVuSans.ttf"), size)


def _write_names(
    picture: Image.Image,
    film: FilmedScene,
    rows: list[list[Body]],
    camera: _Camera,
    font: ImageFont.FreeTypeFont,
) -> None:
    """Write the name of a row in its corner, or the names of characters above their heads."""
    pen = ImageDraw.Draw(picture)
    look: dict[str, Any] = {"fill": INK, "font": font, "stroke_width": 3, "stroke_fill": PAPER}
    names = [character["name"] for character in film.scene["characters"]]
    if len(rows) > 1:
        for place, name in enumerate(names):
            pen.text((MARGIN, place * camera.size[1] + MARGIN / 2), name, **look)
        return
    if not 1 < len(names) <= TAGGED:
        return
    page = camera.page()
    heads = {number: _heads(film, page, rows[0], number) for number in range(len(names))}
    labels: list[Array] = []  # positions of the names so far
    for number, name in enumerate(names):
        neighbours = [*labels]
        for second in heads.keys() - {number}:
            neighbours += [*heads[second]]
        across, down = _farthest(heads[number], np.array(neighbours))
        labels.append(np.array([across, down]))
        room = font.getlength(name) / 2 + MARGIN / 2
        across = np.clip(across, room, max(room, picture.width - room))
        pen.text((across, max(down, font.size + 2)), name, anchor="ms", **look)


def _heads(film: FilmedScene, page: ShadedPicture, row: list[Body], number: int) -> Array:
    """Return the pixels above the heads of a character, (B, 2)."""
    poses = [film.pose(number, body.time) + body.moved for body in row if body.number == number]
    heads = np.array([pose[pose[:, 1].argmax()] for pose in poses])
    return page.pixels(heads + HEADROOM)[0]


def _farthest(places: Array, neighbours: Array) -> Array:
    """Return the place for a name that is farthest from its neighbours, which are wider than high."""
    distances = np.linalg.norm((places[:, None] - neighbours) / [NAME_SHAPE, 1], axis=-1)
    return np.asarray(places[distances.min(axis=1).argmax()])


def _entries(film: FilmedScene, rows: list[list[Body]], camera: _Camera) -> list[_Entry]:
    """List the entries of the legend: characters, unless a row has their name, sources, marks and squares."""
    characters = film.scene["characters"]
    marks = film.scene["marks"]
    first = characters[0]
    sources = dict.fromkeys((source["colour"], source["name"]) for source in first["sources"])
    walks = walks_on_ground(film)
    entries = []
    if len(characters) > 1 and len(rows) == 1:
        swatch = tuple(dict.fromkeys(colour for colour, _ in sources)) or (first["colour"],)
        entries += [_Entry(swatch, first["name"])]
        entries += [_Entry((character["colour"],), character["name"]) for character in characters[1:]]
    elif walks and len(characters) == 1 and not sources:
        entries += [_Entry((first["path_colour"],), "path of the motion")]
    entries += [_Entry((colour,), name) for colour, name in sources]
    if len(film.scene["asked"]):
        entries += [_Entry((ASKED,), "requested path")]
    if first["seams"] and walks:
        entries += [_Entry((marks["seam"],), "seam")]
    if first["astray"] and walks:
        entries += [_Entry((marks["astray"],), "off the path")]
    if walks:
        return [*entries, _Entry((), f"squares of {film.cell(camera.reach)} m")]
    times = [body.time for body in rows[0]]
    return [*entries, _Entry((), f"poses from {times[0]:.2f} s to {times[-1]:.2f} s, evenly spread")]


def _draw_legend(entries: list[_Entry], width: int, font: ImageFont.FreeTypeFont) -> Image.Image:
    """Draw the entries of a legend in as many lines as they need."""
    size = font.size
    places: list[tuple[float, float]] = []
    across = float(MARGIN)
    line = 0
    for colours, text in entries:
        room = font.getlength(text) + (1.5 * size if colours else 0)
        if places and across + room > width - MARGIN:
            across = float(MARGIN)
            line += 1
        places.append((across, (line + 0.5) * LINE * size + MARGIN / 2))
        across += room + 1.2 * size
    legend = Image.new("RGB", (width, round((line + 1) * LINE * size + MARGIN)), PAPER)
    pen = ImageDraw.Draw(legend)
    for (first_x, middle), (colours, text) in zip(places, entries, strict=True):
        for place, colour in enumerate(colours):
            start = first_x + size * place / len(colours)
            end = first_x + size * (place + 1) / len(colours)
            pen.rectangle([start, middle - size / 2, end, middle + size / 2], fill=colour)
        pen.text((first_x + (1.5 * size if colours else 0), middle), text, fill=INK, font=font, anchor="lm")
    return legend
