"""Drawings for the board: one idea each, in numbered steps, from the course's own diagrams.

A teacher draws them at the board, or prints them. Each is a list of figures, which `board_sheet` puts side by
side with the numbers of the steps.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from mocap import datasets, graphs, matching, plotting
from mocap._shared.atomic import make_folder, replacing
from mocap._shared.progress import Progress
from mocap.body import GroundPath, Motion, arcs, lay_on, resample, rotations
from mocap.course import diagrams
from mocap.course.teaching.films import fitted, font_of

WINDOW, FPS = 10, 30  # frames, frames per second
PANEL, GAP, HEAD = (760, 520), 24, 76  # pixels: a step, what is between them, the heading
COLOURS = 128  # of a file
INK, DISC, PAPER = "#222222", "#0072B2", "#FFFFFF"
Steps = Iterator[Any]  # of figures


def _pair() -> tuple[Motion, Motion]:
    """Give two walks, of which frames 56 and 20 begin windows that match."""
    first, second = (resample(datasets.sample(f"walk_curve_{number}"), FPS) for number in (1, 2))
    return first[56 : 56 + WINDOW], second[20 : 20 + WINDOW]


def _window() -> Steps:
    return (diagrams.window_cloud(_pair()[0], step=step) for step in (1, 2, 3, 4))


def _theta() -> Steps:
    return (diagrams.laying_on(*_pair(), step=step) for step in (1, 2, 3, 4))


def _grid() -> Steps:
    clips = [resample(datasets.sample(f"walk_curve_{number}"), FPS)[:180] for number in (1, 2)]
    grid = matching.distance_grid(*clips, window=WINDOW)
    low = matching.local_minima(grid)
    costs = np.sqrt(grid[tuple(low.T)])
    for minima in (low[:0], low, low[costs < 0.04]):
        yield plotting.distance_image(grid, fps=FPS, minima=minima, names=["clip A", "clip B"]).axes.figure


def _laid() -> Steps:
    first, second = (resample(datasets.sample(f"walk_curve_{number}"), FPS)[:66] for number in (1, 2))
    moving = second[20:]
    yield diagrams.alignment(first, moving, lay_on(moving, first, len(first) - 1), step=3)


def _ball() -> Steps:
    start, end = np.array([np.cos(0.3), np.sin(0.3), 0.0, 0.0]), rotations.about_y(2.2)
    ways = {"slerp": np.stack([rotations.slerp(start, end, share) for share in np.linspace(0, 1, 31)])}
    return (diagrams.turning_paths(ways, share) for share in (0.0, 0.35, 0.7, 1.0))


def _path() -> Steps:
    corner = GroundPath([[0, 0], [0, 3], [3, 3]])
    rounded = arcs((0, 0), heading=0.0, pieces=[(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])
    return (diagrams.two_distances(corner, rounded, step=step) for step in (0, 3, 5, 8))


def _tarjan() -> Steps:
    draw = partial(diagrams.tarjan_step, graphs.notes_example(), places=diagrams.EIGHT_PLACES)
    return (draw(step=step) for step in (0, 4, 9, 12, 15, 18))


def _search() -> Steps:
    return (diagrams.search_steps(graphs.notes_example(), 6, 2, step=step) for step in (0, 2, 4, 7, 10, 13))


BOARD: dict[str, tuple[str, Callable[[], Iterable[Any]]]] = {
    "01-window": ("A window becomes a cloud of points", _window),
    "02-theta": ("Four steps to the best turn and shift", _theta),
    "03-minima": ("A grid of distances, its minima, those below a threshold", _grid),
    "04-laid-on": ("One clip laid on the end of another: turn, then shift", _laid),
    "05-alpha": (
        "The share α of the first clip over a window",
        lambda: map(diagrams.blended_seam, (1, 2, 3, 4)),
    ),
    "06-slerp": ("From one rotation to another on the ball", _ball),
    "07-graph": ("Two clips become a graph", lambda: map(diagrams.nodes_and_edges, (0, 1, 2, 3, 4, 5))),
    "08-tarjan": ("Tarjan's algorithm on eight nodes", _tarjan),
    "09-search": ("Branch and bound on eight nodes", _search),
    "10-path": ("Two distances from a path: at equal arc length, to the nearest point", _path),
    "11-pinned": ("A leg that reaches its pinned foot", lambda: map(diagrams.knee_triangle, (1, 2, 3))),
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
    files, small = [], []
    for name in progress(list(BOARD)):
        sheet = board_sheet(name)
        files.append(_saved(sheet, out / f"{name}.png"))
        sheet.thumbnail((620, 620))
        small.append(sheet)
    rows = [small[at : at + 3] for at in range(0, len(small), 3)]
    highs = [max(sheet.height for sheet in row) + GAP for row in rows]
    page = Image.new("RGB", (3 * (620 + GAP), sum(highs)), PAPER)
    for row, top in zip(rows, np.cumsum([0, *highs]).tolist(), strict=False):
        for column, sheet in enumerate(row):
            page.paste(sheet, (column * (620 + GAP) + GAP // 2, top + GAP // 2))
    return [*files, _saved(page, out / "board.png")]


def _saved(page: Image.Image, path: Path) -> Path:
    with replacing(path) as beside:
        page.quantize(COLOURS, Image.Quantize.MAXCOVERAGE).save(beside, "png", optimize=True)
    return path


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
    heading, steps = BOARD[name]
    figures = list(steps())
    for figure in figures if len(figures) > 1 else []:
        _unnumbered(figure)
    room = PANEL if len(figures) > 1 else (2 * PANEL[0], PANEL[1])  # one figure that shows its steps itself
    panels = [_panel(figure, heading, room) for figure in figures]
    columns = min(len(panels), 2 if len(panels) == 4 else 3)
    wide, high = room[0] + GAP, room[1] + GAP
    page = Image.new("RGB", (columns * wide + GAP, -(-len(panels) // columns) * high + HEAD + GAP), PAPER)
    pen = ImageDraw.Draw(page)
    pen.text((GAP, 18), heading, INK, font_of(38, bold=True))
    for number, panel in enumerate(panels):
        x, y = GAP + number % columns * wide, HEAD + number // columns * high
        page.paste(panel, (x + (room[0] - panel.width) // 2, y + (room[1] - panel.height) // 2))
        if len(panels) > 1:
            pen.ellipse([x, y, x + 48, y + 48], DISC)
            pen.text((x + 24, y + 24), str(number + 1), PAPER, font_of(28, bold=True), anchor="mm")
    return page


def _unnumbered(figure: Any) -> None:  # noqa: ANN401
    """Take off the number with which a step's title begins: the disc beside it has one."""
    for text in figure.findobj(lambda artist: hasattr(artist, "set_text")):
        text.set_text(re.sub(r"^\d+\. ", "", text.get_text()))


def _panel(figure: Any, heading: str, room: tuple[int, int]) -> Image.Image:  # noqa: ANN401
    """Turn a figure into a picture of the size of a step, and close it."""
    picture = Image.open(io.BytesIO(plotting.show(figure, alt=heading).picture)).convert("RGB")
    return fitted(picture, room)
