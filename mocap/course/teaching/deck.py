"""Decks of slides: written by hand beside the notebooks, with the pictures and the code of these.

A deck is a file of Markdown in `notebooks/slides`, called like its notebook. A line of three dashes ends a
slide; each begins with its heading. A line `{show what}` stands for what a cell of the notebook shows, and
`{code what}` for its code, where `what` is a tag of the cell, or words that no other cell has. A line such as
`{draw 08-tarjan 3}` stands for a step of a drawing for the board. What follows `Note:` is for the speaker.
"Predict:", "Answer:" and "Exercise:" at the beginning of a heading become a label.
"""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mocap.course.notebooks import library
from mocap.course.teaching.board import pictures_of
from mocap.errors import MocapError

TAKEN = re.compile(r"^\{(show|code|draw) ([^}\n]+)\}$", re.MULTILINE)
PICTURE = re.compile(r"!\[.*?\]\(.*?\)", re.DOTALL)
LABELS = ("Predict", "Answer", "Exercise")


@dataclass
class Slide:
    """A slide: its label, its heading, its cells, and Markdown for the speaker."""

    label: str
    heading: str
    cells: list[Any]
    notes: str


def deck_file(notebook: Path) -> Path:
    """Give where the deck of a notebook is."""
    return notebook.parent / "slides" / f"{notebook.stem}.md"


def deck_of(file: Path, notebook: Any) -> list[Slide]:  # noqa: ANN401
    """Read a deck.

    Parameters
    ----------
    file : the deck.
    notebook : from `course.read`, for pictures and code.

    Returns
    -------
    The slides; a cell is of Markdown, or a copy of the notebook's with its code or with what it shows.

    Raises
    ------
    MocapError : where the deck is missing, and for a line that takes nothing, no cell or several cells of the
        notebook.
    """
    if not file.is_file():
        raise MocapError(f"There is no deck {file}: slides and films are made of decks.")
    parts = re.split(r"^---$", file.read_text("utf-8"), flags=re.MULTILINE)
    return [_slide(file, notebook, part) for part in parts]


def _slide(file: Path, notebook: Any, part: str) -> Slide:  # noqa: ANN401
    told, _, notes = part.partition("\nNote:")
    heading, _, body = told.strip().partition("\n")
    label, _, rest = (heading := heading.lstrip("# ")).partition(": ")
    label, heading = (label, rest) if label in LABELS else ("", heading)
    texts = TAKEN.split(body)
    if wrong := re.search(r"^\{.*", "".join(texts[::3]), re.MULTILINE):
        raise MocapError(f"{file}: '{wrong[0]:.60}' is not {{show ...}}, {{code ...}} or {{draw ...}}.")
    written = library().v4.new_markdown_cell
    cells = [written(texts[0].strip())]
    for what, name, text in zip(texts[1::3], texts[2::3], texts[3::3], strict=True):
        cells += [_taken(file, notebook, what, name), written(text.strip())]
    return Slide(
        label, heading, [cell for cell in cells if cell.source or cell.get("outputs")], notes.strip()
    )


def _taken(file: Path, notebook: Any, what: str, name: str) -> Any:  # noqa: ANN401
    """Copy a cell of the notebook, with its code or with what it shows; or draw a step for the board."""
    if what == "draw":
        new, (name, _, step) = library().v4, name.partition(" ")
        picture = {"image/png": base64.b64encode(pictures_of(name)[int(step) - 1]).decode()}
        return new.new_code_cell(outputs=[new.new_output("display_data", picture)])
    found = [cell for cell in notebook.cells if name in cell.metadata.get("tags", ())]
    found = found or [cell for cell in notebook.cells if name in cell.source]
    if len(found) != 1:
        raise MocapError(f"{file}: '{name:.60}' is in {len(found)} cells of the notebook, not in one.")
    (cell,) = found
    if cell.cell_type == "markdown":
        return type(cell)(cell, source="\n".join(PICTURE.findall(cell.source)))
    if what == "code":
        return type(cell)(cell, outputs=[])
    seen = [output for output in cell.outputs if "data" in output] or cell.outputs
    return type(cell)(cell, source="", outputs=seen, metadata={**cell.metadata, "code": cell.source})
