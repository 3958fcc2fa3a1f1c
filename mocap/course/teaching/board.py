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
from mocap.body.planar import lay_on
from mocap.course import diagrams
from mocap.plotting.picture import few_colours

WINDOW, FPS = 10, 30  # frames, frames per second
PANEL, GAP, HEAD = (760, 520), 24, 76  # pixels: a step, what is between them, the heading
INK, DISC, PAPER = "#222222", "#0072B2", "#FFFFFF"
SMOOTH = Image.Resampling.LANCZOS
SMALL = (620, 440)  # pixels of a drawing on the sheet of all
FOUR = (1, 2, 3, 4)
Steps = Iterator[Any]  # of figures, or of what a step has moved on one


def _walks(frames: int) -> list[Motion]:
    return [resample(datasets.sample(f"walk_curve_{number}"), FPS)[:frames] for number in (1, 2)]


def _pair() -> tuple[Motion, Motion]:
    """Give the two windows of notebook 03, which match."""
    circle, curve = (resample(datasets.sample(f"walk_{name}"), FPS) for name in ("circle", "curve_1"))
    return circle[56 : 56 + WINDOW], curve[97 : 97 + WINDOW]


def _grid() -> Steps:
    grid = matching.distance_grid(*_walks(180), window=WINDOW)
    low = matching.local_minima(grid)
    costs = np.sqrt(grid[tuple(low.T)])
    for minima in (low[:0], low, low[costs < 0.04]):
        yield plotting.distance_image(grid, fps=FPS, minima=minima, names=["clip A", "clip B"]).axes.figure


def _laid() -> Steps:
    first, second = _walks(66)
    yield diagrams.alignment(first, second[20:], lay_on(second[20:], first, len(first) - 1))


def _ball() -> Steps:
    start, end = np.array([np.cos(0.3), np.sin(0.3), 0.0, 0.0]), rotations.about_y(2.2)
    ways = {"slerp": np.stack([rotations.slerp(start, end, share) for share in np.linspace(0, 1, 31)])}
    return (diagrams.turning_paths(ways, share) for share in (0.0, 0.35, 0.7, 1.0))


def _path() -> Steps:
    rounded = arcs((0, 0), heading=0.0, pieces=[(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])
    return map(diagrams.two_distances(GroundPath([[0, 0], [0, 3], [3, 3]]), rounded), (0, 3, 5, 8))


def _layers() -> Steps:
    asked = GroundPath([[0, 0], [0, 2.1], [0.7, 2.1], [0.7, 0]]).at(0.7 * np.arange(7)) @ [1j, 1]
    draw_stage = diagrams.layer_steps(asked, 5)
    return (draw_stage(step, 4, True) for step in (6, 9, 13, 17, 18, 25))


def _tree() -> Steps:
    walk = resample(datasets.sample("walk_straight"), FPS)
    return map(diagrams.down_the_tree(walk, 20), (0, 2, 3, 24))


WHOLE = "04-laid-on"  # one figure that shows its steps itself
BOARD: dict[str, tuple[str, Callable[[], Steps]]] = {
    "01-window": (
        "A window as a cloud of points",
        lambda: (diagrams.window_cloud(_pair()[0], step=step) for step in FOUR),
    ),
    "02-theta": (
        "Four steps to the best turn and shift",
        lambda: (diagrams.laying_on(*_pair(), step=step) for step in FOUR),
    ),
    "03-minima": ("A grid of distances, its minima, those below a threshold", _grid),
    "04-laid-on": ("One clip laid on the end of another: turn, then shift", _laid),
    "05-alpha": ("The share α of the first clip over a window", lambda: map(diagrams.blended_seam, FOUR)),
    "06-slerp": ("From one rotation to another on the ball", _ball),
    "07-graph": ("Two clips become a graph", lambda: map(diagrams.nodes_and_edges, range(6))),
    "08-tarjan": (
        "Tarjan's algorithm on eight nodes",
        lambda: map(diagrams.tarjan_steps(graphs.notes_example()), (0, 4, 6, 14, 16, 99)),
    ),
    "09-search": (
        "Branch and bound on eight nodes",
        lambda: map(diagrams.search_steps(graphs.notes_example(), 6, 2), (0, 2, 3, 9, 11, 13)),
    ),
    "10-path": ("Two distances from a path: at equal arc length, to the nearest point", _path),
    "11-pinned": ("A leg that reaches its pinned foot", lambda: map(diagrams.knee_triangle, FOUR[:3])),
    "12-layers": ("The layered search along a hairpin: cross out, keep the best four, lengthen", _layers),
    "13-quaternion": ("A vector is turned in two halves", lambda: map(diagrams.half_turns, range(3))),
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
    wide, high = room[0] + GAP, room[1] + GAP
    page = Image.new("RGB", (columns * wide + GAP, -(-len(pictures) // columns) * high + head + GAP), PAPER)
    for number, picture in enumerate(pictures):
        place = (GAP + number % columns * wide, head + number // columns * high)
        page.paste(ImageOps.pad(picture, room, SMOOTH, PAPER), place)
    return page


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
    alone = name == WHOLE
    room = ((1 + alone) * PANEL[0], PANEL[1])
    columns = min(len(pictures), 2 if len(pictures) == 4 else 3)
    page = _laid_out(pictures, room, columns, HEAD)
    pen = ImageDraw.Draw(page)
    pen.text((GAP, 18), heading, INK, font_of(38, bold=True))
    for number in range(0 if alone else len(pictures)):
        x, y = GAP + number % columns * (room[0] + GAP), HEAD + number // columns * (room[1] + GAP)
        pen.ellipse([x, y, x + 48, y + 48], DISC)
        pen.text((x + 24, y + 24), str(number + 1), PAPER, font_of(28, bold=True), anchor="mm")
    return page


@cache
def font_of(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Give the font of Matplotlib's pictures, which has Greek letters."""
    found = find_spec("matplotlib")
    assert found and found.origin
    fonts = Path(found.origin).parent / "mpl-data" / "fonts" / "ttf"
    return ImageFont.truetype(str(fonts / f"DejaVuSans{'-Bold' if bold else ''}.ttf"), size)
