"""What the course asks for, and which cells of a notebook an exercise needs."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mocap.course.check import Check
from mocap.course.notebooks import names_of, read, tagged

ORACLES = (
    r"\bchecks\b(?!\.\w+\()|[.'\"](?:truth|mistakes|stand_in|get_objects|modules|_getframe)\b"
    r"|\b(?:all_checks|lab\.own\s+import|lab\.slots|mine\(\s*['\"]|exec\(|eval\(|getsource|importlib|__(?:import|dict|globals|builtins|closure)__)"
)
"""Ways to a right answer: a check that is not just called, its parts, and what can hide such names."""


STUB = re.compile(r"(^|\s)\.\.\.[ \t]*(#.*)?$", re.MULTILINE)  # a line that ends as stubs do


Sheet = tuple[tuple[str, ...], frozenset[str]]
"""A notebook of the course: its exercises, and by what a copy of it is recognised."""


class Cell(NamedTuple):
    """A cell of code: the exercises that its tags name, and its source."""

    exercises: tuple[str, ...]
    source: str


def code_cells(notebook: Any) -> list[Cell]:  # noqa: ANN401
    """List the cells of code of a notebook, but for those that install something: there is no network.

    Examples
    --------
    >>> from nbformat.v4 import new_code_cell, new_notebook
    >>> cell = new_code_cell("def speed(): ...", metadata={"tags": ["exercise:speed"]})
    >>> code_cells(new_notebook(cells=[cell]))
    [Cell(exercises=('speed',), source='def speed(): ...')]
    """
    named = list(tagged(notebook, "exercise"))
    cells = [cell for cell in notebook.cells if cell.cell_type == "code" and "pip install" not in cell.source]
    return [Cell(tuple(name for name, own in named if own is cell), cell.source) for cell in cells]


def course_sheets(folder: Path) -> list[Sheet]:
    """Read what each notebook of the course asks for."""
    course = [read(file) for file in sorted(folder.glob("*.ipynb"))]
    return [(tuple(name for name, _ in tagged(one, "exercise")), _traits(one)) for one in course]


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
    traits, nothing = _traits(notebook), ((), frozenset[str]())
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
    known = [names_of(plain(cell.source)) for cell in cells]
    written = re.compile(rf"^(def {exercise}\b|{exercise} = lambda\b)", re.MULTILINE)
    own = [n for n, cell in enumerate(cells) if exercise in cell.exercises or written.search(cell.source)]
    left = [n for n in own if not STUB.search(cells[n].source)] or own
    left = left or [number for number, (defined, _) in enumerate(known) if exercise in defined]
    found: set[int] = set()
    while left:
        number = left.pop()
        if number not in found:
            found.add(number)
            for name in known[number][1]:
                at = [other for other, (defined, _) in enumerate(known) if name in defined]
                left += [other for other in at if other < number] or at
    return sorted(found)


def named_oracle(cells: Sequence[Cell], check: Check, course: Collection[str]) -> str:
    r"""Find what could have given a right answer away: part of a check, or a function that the check calls.

    Only the notebook's own cells count: those of the exercise, and those of no exercise that are not in
    `course`, the traits of the course's notebook.

    Returns
    -------
    The first such words, or "".

    Examples
    --------
    >>> from mocap.course import checks
    >>> cells = [Cell(("hamilton",), "def hamilton(a, b): return rotations.multiply(a, b)")]
    >>> named_oracle(cells, checks.hamilton, ())
    'multiply'
    """
    own = "\n".join(
        cell.source
        for cell in cells
        if check.name in cell.exercises or not (cell.exercises or cell.source.strip() in course)
    )
    solution = "\n".join(text for text in course if f"def {check.name}(" in text)  # may call some of them
    functions = [name for name in check.oracles if f"{name}(" not in solution and f"def {name}(" not in own]
    called = rf"|\b(?:{'|'.join(functions)})(?=\s*\()" if functions else ""
    found = re.search(ORACLES + called, re.sub(r"(?m)^from mocap\.course import [\w, ]+$", "", own))
    return found[0] if found else ""
