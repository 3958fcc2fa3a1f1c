"""What the course asks for, and which cells of a notebook an exercise needs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mocap.course.notebooks import names_of, read, tagged

INSTALL = re.compile(
    r"^([ \t]*)(?:[%!].*\b(?:pip3?|conda|mamba|uv)\b.*|(?:pip3?|conda|mamba)[ \t]+)\binstall\b.*$",
    re.MULTILINE,
)
"""A command of a notebook that installs packages, and the space before it."""

COMMAND = re.compile(r"^([ \t]*)[%!?].*$", re.MULTILINE)  # a command of IPython

STUB = re.compile(r"(^|\s)\.\.\.[ \t]*(#.*)?$", re.MULTILINE)  # a line that ends as stubs do


Sheet = tuple[tuple[str, ...], frozenset[str]]
"""A notebook of the course: its exercises, and by what a copy of it is recognised."""


class Cell(NamedTuple):
    """A cell of code: the exercises that its tags name, and its source."""

    exercises: tuple[str, ...]
    source: str


def code_cells(notebook: Any) -> list[Cell]:  # noqa: ANN401
    """List the cells of code of a notebook, without the lines that install something: there is no network.

    Examples
    --------
    >>> from nbformat.v4 import new_code_cell, new_notebook
    >>> cell = new_code_cell("def speed(): ...", metadata={"tags": ["exercise:speed"]})
    >>> code_cells(new_notebook(cells=[cell]))
    [Cell(exercises=('speed',), source='def speed(): ...')]
    """
    named = list(tagged(notebook, "exercise"))
    listed = []
    for cell in notebook.cells:
        if cell.cell_type == "code":
            exercises = tuple(name for name, exercise in named if exercise is cell)
            listed.append(Cell(exercises, without_installs(cell.source)))
    return listed


def without_installs(source: str) -> str:
    r"""Replace the commands that install packages by `pass`; the rest of the cell stays.

    Examples
    --------
    >>> without_installs("%pip install -q seaborn\nx = 1  # I had to pip install it")
    'pass\nx = 1  # I had to pip install it'
    """
    return INSTALL.sub(r"\1pass", source)


def without_commands(source: str) -> str:
    r"""Replace the commands of IPython by `pass`, so that a cell can be read as Python.

    Examples
    --------
    >>> without_commands("%matplotlib inline\nx = 7 % 3")
    'pass\nx = 7 % 3'
    """
    return COMMAND.sub(r"\1pass", source)


def course_sheets(folder: Path) -> list[Sheet]:
    """Read what each notebook of the course asks for."""
    notebooks = [read(file) for file in sorted(folder.glob("*.ipynb"))]
    return [(tuple(name for name, _ in tagged(sheet, "exercise")), _traits(sheet)) for sheet in notebooks]


def sheet_of(notebook: Any, sheets: Iterable[Sheet]) -> Sheet:  # noqa: ANN401
    """Find the notebook of the course that a notebook is a copy of, whatever its file is called.

    It is the one with which it has the most cells, tags and names of functions in common; an empty one where
    there is nothing in common.

    Examples
    --------
    >>> from nbformat.v4 import new_notebook
    >>> sheet_of(new_notebook(), [(("speed",), frozenset(["exercise:speed"]))])
    ((), frozenset())
    """
    traits = _traits(notebook)
    nothing: Sheet = ((), frozenset())
    return max([nothing, *sheets], key=lambda sheet: len(sheet[1] & traits))


def _traits(notebook: Any) -> frozenset[str]:  # noqa: ANN401
    tags = {str(tag) for cell in notebook.cells for tag in cell.metadata.get("tags", ())}
    sources = {cell.source.strip() for cell in notebook.cells}
    functions = re.findall(r"^def \w+", "\n".join(sources), re.MULTILINE)
    return frozenset(functions) | {tag for tag in tags if ":" in tag} | {s for s in sources if len(s) > 20}


def needed(cells: Sequence[Cell], exercise: str, plain: Callable[[str], str] = str) -> list[int]:
    """Find the cells that an exercise needs, in order: its own, and those that define the names it uses.

    Of the cells that define a name, those before the one that uses it count, or else those after it. An
    exercise has the cells with its tag, and those that define its function. Where one of them is finished,
    those that still have the `...` of the stub are left out: the function was written elsewhere.

    Parameters
    ----------
    cells : of the notebook.
    exercise : the name.
    plain : turns a cell with IPython's commands into Python.

    Returns
    -------
    The numbers of the cells; none if the notebook has nothing for the exercise.

    Examples
    --------
    >>> cells = [Cell((), "def half(x): return x / 2"), Cell(("f",), "def f(x): return half(x)")]
    >>> needed(cells, "f"), needed(cells[:1], "g")
    ([0, 1], [])
    """
    names = [names_of(plain(cell.source)) for cell in cells]
    start = re.compile(rf"^(def {exercise}\b|{exercise} = lambda\b)", re.MULTILINE)
    tagged_or_defining = [
        number for number, cell in enumerate(cells) if exercise in cell.exercises or start.search(cell.source)
    ]
    finished = [number for number in tagged_or_defining if not STUB.search(cells[number].source)]
    waiting = finished or tagged_or_defining or _defining(names, exercise)
    numbers: set[int] = set()
    while waiting:
        number = waiting.pop()
        if number not in numbers:
            numbers.add(number)
            _, used = names[number]
            for name in used:
                cells_with_name = _defining(names, name)
                waiting += [earlier for earlier in cells_with_name if earlier < number] or cells_with_name
    return sorted(numbers)


def _defining(names: Sequence[tuple[set[str], set[str]]], name: str) -> list[int]:
    """List the cells that define a name."""
    return [number for number, (defined, _) in enumerate(names) if name in defined]
