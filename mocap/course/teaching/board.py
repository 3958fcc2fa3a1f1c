"""Drawings for the board: one idea each, in numbered steps, from the course's own diagrams.

A teacher draws them at the board, or prints them. Each is a list of figures, which `board_sheet` puts side by
side with the numbers of the steps.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont, ImageOps

from mocap import datasets, graphs, matching, plotting
from mocap._shared.atomic import make_folder, write_file
from mocap._shared.progress import Progress
from mocap.body import GroundPath, Motion, arcs, resample, rotations
from mocap.body.planar import align_frames
from mocap.course import diagrams
from mocap.plotting.picture import few_colours

WINDOW = 10  # frames
FPS = 30  # frames per second
PANEL = (760, 520)  # pixels of a step
SMALL = (620, 440)  # pixels of a drawing on the sheet of all
GAP = 24  # pixels between steps
HEAD = 76  # pixels, the height of the heading
HEADING_TOP = 18  # pixels above the heading
HEADING_SIZE = 38  # pixels, of its letters
DISC_SIZE = 48  # pixels, the diameter of the disc that holds the number of a step
NUMBER_SIZE = 28  # pixels, of its letters
INK = "#222222"
DISC = "#0072B2"
PAPER = "#FFFFFF"
SMOOTH = Image.Resampling.LANCZOS
FOUR = (1, 2, 3, 4)
Steps = Iterator[Any]  # of figures, or of what a step has moved on one


def _walks(frames: int) -> list[Motion]:
    return [resample(datasets.sample(f"walk_curve_{number}"), FPS)[:frames] for number in (1, 2)]


def _pair() -> tuple[Motion, Motion]:
    """Give the two windows of notebook 03, which match."""
    circle, curve = (resample(datasets.sample(f"walk_{name}"), FPS) for name in ("circle", "curve_1"))
    return circle[47 : 47 + WINDOW], curve[80 : 80 + WINDOW]


def _window() -> Steps:
    window, _ = _pair()
    return (diagrams.window_cloud(window, step=step) for step in FOUR)


def _theta() -> Steps:
    return (diagrams.laying_on(*_pair(), step=step) for step in FOUR)


def _minima() -> Steps:
    grid = matching.distance_grid(*_walks(180), window=WINDOW)
    low = matching.local_minima(grid)
    costs = np.sqrt(grid[tuple(low.T)])
    for minima in (low[:0], low, low[costs < 0.04]):
        yield plotting.distance_image(grid, fps=FPS, minima=minima, names=["clip A", "clip B"]).axes.figure


def _laid() -> Steps:
    first, second = _walks(66)
    yield diagrams.alignment(first, second[20:], align_frames(second[20:], first, len(first) - 1))


def _alpha() -> Steps:
    return map(diagrams.blended_seam, FOUR)


def _slerp() -> Steps:
    start = np.array([np.cos(0.3), np.sin(0.3), 0.0, 0.0])
    end = rotations.about_y(2.2)
    arc = np.stack([rotations.slerp(start, end, share) for share in np.linspace(0, 1, 31)])
    return (diagrams.turning_paths({"slerp": arc}, share) for share in (0.0, 0.35, 0.7, 1.0))


def _graph() -> Steps:
    return map(diagrams.nodes_and_edges, range(6))


def _tarjan() -> Steps:
    return map(diagrams.tarjan_steps(graphs.notes_example()), (0, 4, 6, 14, 16, 99))


def _search() -> Steps:
    return map(diagrams.search_steps(graphs.notes_example(), 6, 2), (0, 2, 3, 9, 11, 13))


def _path() -> Steps:
    corner = GroundPath([[0, 0], [0, 3], [3, 3]])
    rounded = arcs((0, 0), heading=0.0, pieces=[(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])
    return map(diagrams.two_distances(corner, rounded), (0, 3, 5, 8))


def _pinned() -> Steps:
    return map(diagrams.knee_triangle, (1, 2, 3))


def _layers() -> Steps:
    hairpin = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]])
    goals = hairpin.at(0.7 * np.arange(7)) @ [1j, 1]
    draw_stage = diagrams.layer_steps(goals, 5)
    return (draw_stage(step, 4, True) for step in (6, 9, 13, 17, 18, 25))


def _quaternion() -> Steps:
    return map(diagrams.half_turns, range(3))


def _tree() -> Steps:
    walk = resample(datasets.sample("walk_straight"), FPS)
    return map(diagrams.down_the_tree(walk, 20), (0, 2, 3, 24))


WHOLE = "04-laid-on"  # one figure that shows its steps itself
# reads: statement: a table of the drawings: file, heading and steps
BOARD: dict[str, tuple[str, Callable[[], Steps]]] = {
    "01-window": ("A window as a cloud of points", _window),
    "02-theta": ("Four steps to the best turn and shift", _theta),
    "03-minima": ("A grid of distances, its minima, those below a threshold", _minima),
    "04-laid-on": ("One clip laid on the end of another: turn, then shift", _laid),
    "05-alpha": ("The share α of the first clip over a window", _alpha),
    "06-slerp": ("From one rotation to another on the ball", _slerp),
    "07-graph": ("Two clips become a graph", _graph),
    "08-tarjan": ("Tarjan's algorithm on eight nodes", _tarjan),
    "09-search": ("Branch and bound on eight nodes", _search),
    "10-path": ("Two distances from a path: at equal arc length, to the nearest point", _path),
    "11-pinned": ("A leg that reaches its pinned foot", _pinned),
    "12-layers": ("The layered search along a hairpin: cross out, keep the best four, lengthen", _layers),
    "13-quaternion": ("A vector is turned in two halves", _quaternion),
    "14-tree": ("Forward kinematics, joint after joint", _tree),
}


def write_board(out: Path, progress: Progress = iter) -> list[Path]:
    """Write all drawings as PNGs into a folder, and `board.png`, on which all are seen small.

    Parameters
    ----------
    out : the folder.
    progress : wraps the names of the drawings.

    Returns
    -------
    The files, the sheet of all last.
    """
    make_folder(out)
    pages = {out / f"{name}.png": board_sheet(name) for name in progress(list(BOARD))}
    pages[out / "board.png"] = _laid_out([page.convert("RGB") for page in pages.values()], SMALL, 3)
    for file, page in pages.items():
        write_file(file, few_colours(page))
    return list(pages)


def _laid_out(pictures: list[Image.Image], room: tuple[int, int], columns: int, head: int = 0) -> Image.Image:
    """Lay pictures on a page, row by row, each fitted into a room of pixels."""
    rows = -(-len(pictures) // columns)
    width = GAP + columns * (room[0] + GAP)
    height = head + rows * (room[1] + GAP) + GAP
    page = Image.new("RGB", (width, height), PAPER)
    for number, picture in enumerate(pictures):
        fitted = ImageOps.pad(picture, room, SMOOTH, PAPER)
        page.paste(fitted, _corner(number, room, columns, head))
    return page


def _corner(number: int, room: tuple[int, int], columns: int, head: int) -> tuple[int, int]:
    """Return the upper left corner of a picture on a page, by its number, in pixels."""
    row, column = divmod(number, columns)
    return GAP + column * (room[0] + GAP), head + row * (room[1] + GAP)


@cache
def pictures_of(name: str) -> list[bytes]:
    """Draw the steps of a drawing, each as a PNG before the next: some move what they drew."""
    heading, steps = BOARD[name]
    return [plotting.show(drawn, alt=heading).picture for drawn in steps()]


def board_sheet(name: str) -> Image.Image:
    """Draw one drawing: its heading, and its steps with their numbers.

    Parameters
    ----------
    name : one of `BOARD`.

    Examples
    --------
    >>> board_sheet("11-pinned").size
    (2376, 644)
    """
    heading, _ = BOARD[name]
    pictures = [Image.open(io.BytesIO(picture)).convert("RGB") for picture in pictures_of(name)]
    room = (2 * PANEL[0], PANEL[1]) if name == WHOLE else PANEL
    columns = min(len(pictures), 2 if len(pictures) == 4 else 3)
    page = _laid_out(pictures, room, columns, HEAD)
    pen = ImageDraw.Draw(page)
    pen.text((GAP, HEADING_TOP), heading, INK, font_of(HEADING_SIZE, bold=True))
    if name != WHOLE:
        for number in range(len(pictures)):
            _draw_number(pen, str(number + 1), _corner(number, room, columns, HEAD))
    return page


def _draw_number(pen: ImageDraw.ImageDraw, number: str, corner: tuple[int, int]) -> None:
    """Draw the number of a step on a disc, with its upper left corner in pixels."""
    x, y = corner
    middle = (x + DISC_SIZE / 2, y + DISC_SIZE / 2)
    pen.ellipse([x, y, x + DISC_SIZE, y + DISC_SIZE], DISC)
    pen.text(middle, number, PAPER, font_of(NUMBER_SIZE, bold=True), anchor="mm")


@cache
def font_of(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Give the font of Matplotlib's pictures, which has Greek letters."""
    matplotlib = find_spec("matplotlib")
    assert matplotlib and matplotlib.origin
    fonts = Path(matplotlib.origin).parent / "mpl-data" / "fonts" / "ttf"
    return ImageFont.truetype(str(fonts / f"DejaVuSans{'-Bold' if bold else ''}.ttf"), size)
