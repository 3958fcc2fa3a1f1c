"""Positions of an experiment's first control, recorded as pictures for pages where no Python runs.

`watch` records each experiment that a notebook shows: the course's site runs it in the notebook's own kernel.
"""

import base64
import io
import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from mocap.plotting.picture import shown_width
from mocap.widgets.experiments import Experiment

ROOM = 70_000  # bytes for the pictures of one experiment
COUNTS = (15, 11, 8, 5)  # of positions; the most that fit in the room
SIZES = (1.0, 0.8, 0.64, 0.5, 0.4, 0.3, 0.2)  # of the pictures, as shares of their width
COLOURS = 64


def record(experiment: Experiment, *, room: int = ROOM) -> dict[str, Any] | None:
    """Move an experiment's first control through its range, and keep the pictures.

    Parameters
    ----------
    experiment : what `explore` returns; its control is back in its place afterwards.
    room : bytes for all pictures; they become fewer and smaller until they fit.

    Returns
    -------
    The control's `name`, the `labels` of its positions, the `pictures` as WebP in base64, the number `at` of
    the position at rest, the `width` at which they are shown, pixels, and the sentence `alt`. None for an
    experiment without such a control.

    Raises
    ------
    Exception : whatever `draw` raises.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from mocap.widgets.experiments import explore
    >>> line, = plt.figure().add_subplot().plot([0, 1], [0, 0])
    >>> def draw(slope=2):
    ...     line.set_ydata([0, slope])
    ...     return [line]
    >>> recorded = record(explore(draw, alt="A line that rises as its slope does.", slope=(0, 4, 2)))
    >>> recorded["labels"], recorded["at"], len(recorded["pictures"])
    (['0', '2', '4'], 1, 3)
    """
    for name, control in experiment.controls.items():
        positions = [] if hasattr(control, "with_handles") else _positions(control)
        if positions:
            return _recorded(experiment, name, positions, room)
    return None


def _recorded(
    experiment: Experiment, name: str, positions: list[tuple[str, Any]], room: int
) -> dict[str, Any]:
    """Return the recording of one control of an experiment, at the given positions."""
    initial = experiment.controls[name].value
    rest = next(number for number, (_, value) in enumerate(positions) if value == initial)
    try:
        stills = [experiment.set(**{name: value}).still()[0]["image/png"] for _, value in positions]
    finally:
        experiment.set(**{name: initial})
    pictures = [Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB") for png in stills]
    kept, small = _fitting(pictures, rest, room)
    labels = [positions[number][0] for number in kept]
    recording: dict[str, Any] = {"name": name.replace("_", " "), "labels": labels}
    encoded = [base64.b64encode(data).decode() for data in small]
    recording |= {"pictures": encoded, "at": kept.index(rest), "alt": experiment.alt}
    return recording | {"width": shown_width(base64.b64decode(stills[rest]))}


def _positions(control: Any) -> list[tuple[str, Any]]:  # noqa: ANN401
    """List labels and values of a slider, choice or check box, the one at rest among them."""
    if isinstance(control.value, bool):
        return [("off", False), ("on", True)]
    if hasattr(control, "options"):
        rest = control.index
        positions = list(control._options_full)
    elif hasattr(control, "step"):
        count = 1 + max(1, round((control.max - control.min) / control.step))
        steps = (control.min + number * control.step for number in range(count))
        values = [min(type(control.value)(value), control.max) for value in steps]
        rest = round((control.value - control.min) / control.step)
        values[rest] = control.value
        positions = [(f"{value:.6g}", value) for value in values]
    else:
        return []
    return [positions[number] for number in _spread(len(positions), rest, COUNTS[0])]


def _spread(count: int, rest: int, limit: int) -> list[int]:
    """Choose up to `limit` of `count` places, evenly, with both ends and the place `rest`."""
    places = np.unique(np.linspace(0, count - 1, min(limit, count)).round().astype(int))
    if rest not in places:
        inner = places[1:-1] if len(places) > 2 else places
        nearest = inner[np.abs(inner - rest).argmin()]
        places[places == nearest] = rest
    return [int(place) for place in np.sort(places)]


def _shrunk(picture: Image.Image, size: float) -> Image.Image:
    """Return a picture at a share of its width."""
    if size == 1:
        return picture
    width, height = (max(1, round(size * length)) for length in picture.size)
    return picture.resize((width, height), Image.Resampling.LANCZOS)


def _fitting(pictures: list[Image.Image], rest: int, room: int) -> tuple[list[int], list[bytes]]:
    """Choose pictures, and encode them, so that they fit: first smaller, then fewer, then smaller still."""

    @cache
    def palette(size: float) -> Image.Image:
        # One for all pictures, so that a thing has the same colour in each of them.
        small = [_shrunk(picture, size) for picture in pictures]
        width = max(picture.width for picture in small)
        sheet = Image.new("RGB", (width, sum(picture.height for picture in small)))
        top = 0
        for picture in small:
            sheet.paste(picture, (0, top))
            top += picture.height
        return sheet.quantize(COLOURS, Image.Quantize.MAXCOVERAGE)

    @cache
    def encoded(number: int, size: float) -> bytes:
        data = io.BytesIO()
        picture = _shrunk(pictures[number], size)
        flat = picture.quantize(palette=palette(size), dither=Image.Dither.NONE)
        flat.convert("RGB").save(data, "webp", lossless=True)
        return data.getvalue()

    tries = [(count, size) for count in COUNTS for size in SIZES[:2]]
    for count, size in [*tries, *((COUNTS[-1], size) for size in SIZES[2:])]:
        kept = _spread(len(pictures), rest, count)
        small = [encoded(number, size) for number in kept]
        if sum(map(len, small)) <= room:
            break
    return kept, small


def watch(folder: str) -> None:
    """Record each experiment that the cells of this kernel show from now on, into a folder of JSON files.

    Parameters
    ----------
    folder : for a file per experiment: what `record` returns and the cell's `source`, or the `error`.
    """
    from IPython import get_ipython

    def keep(cell: Any) -> None:  # noqa: ANN401
        if isinstance(cell.result, Experiment):
            try:
                recorded = record(cell.result)
            except Exception as error:  # of any kind: it comes from the notebook
                recorded = {"error": f"{type(error).__name__}: {error}"}
            if recorded:
                recorded["source"] = cell.info.raw_cell
                file = Path(folder, f"{len(list(Path(folder).iterdir())):03}.json")
                file.write_text(json.dumps(recorded), "utf-8")

    get_ipython().events.register("post_run_cell", keep)
