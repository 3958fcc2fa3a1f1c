"""Marks for the notebooks in a folder, exercise by exercise, and as .csv files for spreadsheets."""

from __future__ import annotations

import copy
import csv
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mocap.course import stored
from mocap.course.check import Verdict
from mocap.course.checks import all_checks
from mocap.course.marking.cells import Cell, Sheet, code_cells, course_sheets, sheet_of
from mocap.course.marking.plain_data import unpack
from mocap.course.marking.sealed import Ended, Sealed, fonts, sealed
from mocap.course.notebooks import library, read
from mocap.errors import MocapError

SECONDS = 30  # time limit of an exercise
STARTING = 120  # time limit of the first cell, which imports much
LARGEST = 50 << 20  # bytes of a notebook
LONGEST = 300  # characters of a cell
FORMULA = ("=", "+", "-", "@", "\t")  # how cells begin that a spreadsheet computes
MISSING = "its cell is missing."


class Mark(NamedTuple):
    """The mark of an exercise: whose notebook, which exercise, right or not, and what the check said.

    Examples
    --------
    >>> Mark("ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.").right
    True
    """

    handed_in: str
    exercise: str
    right: bool
    said: str


class _Handed(NamedTuple):
    """A notebook that was handed in: its path, its cells, what the course asks for, what is wrong with it."""

    path: str
    cells: list[Cell]
    sheet: Sheet | None
    wrong: str


def mark(folder: Path, progress: Callable[[Iterable[Any]], Iterable[Any]] = iter) -> Iterator[Mark]:
    """Mark the exercises of all notebooks in a folder and in the folders inside it.

    All notebooks are read before the first one runs. Each runs in a process of its own, with a new folder as
    its home, few variables in its environment, and limits of time, memory, processes and file size; what it
    prints is thrown away. At the end all that it started is killed. The first cell runs, then each exercise
    with the cells that define what it uses. The checks run here, on random input of their own.

    On Linux, where `offline` says so, the process has no network. This cannot keep a notebook from reading
    what you can read, from writing where you can write, from calling the package's own functions, or from an
    attack on this process by somebody who knows how. A container without a network can: `notebooks/README.md`
    says how.

    Parameters
    ----------
    folder : the notebooks handed in; the folder in it that holds a notebook says whose it is.
    progress : wraps the notebooks while they are marked.

    Yields
    ------
    A mark for each exercise: also for those that a notebook of the course has and a copy lacks, and for those
    of notebooks that others handed in.

    Raises
    ------
    MocapError : if there are no notebooks.

    Examples
    --------
    >>> list(mark(Path("nowhere")))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    library()
    files = [file for file in sorted(folder.rglob("*.ipynb")) if ".ipynb_checkpoints" not in file.parts]
    if not files:
        raise MocapError(f"The folder {folder} holds no notebooks.")
    sheets, marked = course_sheets(stored()), list[Mark]()
    handed = [_read(file, file.relative_to(folder).as_posix(), sheets) for file in files]
    seed = int(np.random.default_rng().integers(2**32))
    with fonts() as known:
        for one in progress(handed):
            marks = list(_marks(one, seed, known))
            yield from marks
            marked += marks
    asked = [name for name in all_checks() if any(mark.exercise == name for mark in marked)]
    for student in dict.fromkeys(one.path.split("/")[0] for one in handed if "/" in one.path):
        done = {mark.exercise for mark in marked if mark.handed_in.startswith(f"{student}/")}
        for name in asked:
            if name not in done:
                yield Mark(f"{student}/", name, False, f"✗ {name}: not handed in.")


def _read(file: Path, path: str, sheets: Sequence[Sheet]) -> _Handed:
    wrong = f"{path}: is not a notebook."
    try:
        if not file.is_file() or file.stat().st_size > LARGEST:
            raise MocapError(f"{path}: is no file, or one of more than {LARGEST >> 20} MB.")
        notebook = read(file)
        return _Handed(path, code_cells(notebook), sheet_of(notebook, sheets), "")
    except MocapError as error:
        wrong = str(error).replace(str(file), path)
    except Exception:  # nbformat lets some things pass that are no notebooks
        pass
    return _Handed(path, [], None, wrong)


def _marks(one: _Handed, seed: int, known: Path) -> Iterator[Mark]:
    """Mark the exercises of the course's notebook, and those of others of which it has cells."""
    asked = one.sheet.exercises if one.sheet else ()
    names = [*dict.fromkeys((*asked, *(name for cell in one.cells for name in cell.exercises)))]
    strange = [name for name in names if name not in all_checks()]
    also = f" The course does not know the tag `{strange[0]}`." if strange else ""
    names = [name for name in names if name not in strange]
    if not names:
        yield Mark(one.path, "", False, one.wrong or f"holds no exercise of the course.{also}")
    for name, verdict in _judge_all(one.cells, names, seed, known).items():
        yield Mark(one.path, name, verdict.right, str(verdict).replace(MISSING, MISSING + also))


def _judge_all(cells: list[Cell], names: list[str], seed: int, known: Path) -> dict[str, Verdict]:
    """Judge exercises in one process, and in a new one after an exercise that ends it."""
    judged: dict[str, Verdict] = {}
    while left := [name for name in names if name not in judged]:
        with sealed(known) as student:
            at_fault = left
            try:
                student.allow(STARTING)
                student.ask("begin", [tuple(cell) for cell in cells])
                for name in left:
                    at_fault = [name]
                    student.allow(SECONDS)
                    judged[name] = _judge(student, name, seed)
            except Ended as ended:
                judged |= {name: Verdict(False, f"{name}: {ended}.") for name in at_fault}
    return judged


def _judge(student: Sealed, name: str, seed: int) -> Verdict:
    rng, known = np.random.default_rng(seed), all_checks()[name]
    check = copy.copy(known)
    check.draw, check.seconds = lambda _: known.draw(rng), 2 * SECONDS  # later than the limit of `allow`
    prepared = student.ask("prepare", name)
    if not prepared["found"]:
        return Verdict(False, f"{name}: {MISSING}")
    try:
        with np.errstate(all="ignore"):
            verdict = check.verdict(partial(call, student, name))
    except Exception:  # an answer such as 10**400, which has no float
        verdict = Verdict(False, f"{name}: your answer cannot be compared with the right one.")
    if verdict.right or not prepared["error"]:
        return verdict
    return Verdict(False, f"{name}: its cells raise {prepared['error']}")


def call(student: Sealed, name: str, *arguments: Any) -> Any:  # noqa: ANN401
    """Call a student's function as a check calls it: the call happens in the student's process."""
    reply = student.ask("call", name, arguments)
    if reply.get("raised") == "NotImplementedError":
        raise NotImplementedError
    if "raised" in reply:
        raise type(reply["raised"], (Exception,), {})(reply["said"])
    for number, changed in reply["changed"]:
        np.copyto(arguments[number], unpack(changed))
    return unpack(reply["given"])


def to_csv(marks: Iterable[Mark]) -> str:
    """Write marks as the text of a .csv file, one line per mark.

    Texts stay on one line, and an apostrophe stands before one that a spreadsheet would take for a formula.

    Examples
    --------
    >>> print(to_csv([Mark("=ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.")]))
    handed in,exercise,right,said
    '=ada/02.ipynb,align,1,✓ align: right on 40 random inputs.
    """
    rows = [(mark.handed_in, mark.exercise, int(mark.right), mark.said) for mark in marks]
    return _text([("handed in", "exercise", "right", "said"), *rows])


def to_table(marks: Iterable[Mark]) -> str:
    """Write marks as the text of a .csv file, a line for each student and a column for each exercise.

    Examples
    --------
    >>> print(to_table([Mark("ada/00.ipynb", "speed", True, ""), Mark("ada/02.ipynb", "align", False, "")]))
    student,speed,align,right
    ada,1,0,1
    """
    marks = list(marks)
    names = [*dict.fromkeys(mark.exercise for mark in marks if mark.exercise)]
    table: dict[str, dict[str, int]] = {}
    for mark in marks:
        row = table.setdefault(mark.handed_in.split("/")[0], {})
        if mark.exercise:
            row[mark.exercise] = max(int(mark.right), row.get(mark.exercise, 0))
    rows = [[who, *(row.get(name, "") for name in names), sum(row.values())] for who, row in table.items()]
    return _text([["student", *names, "right"], *rows])


def _text(rows: Iterable[Iterable[str | int]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([_cell(value) for value in row] for row in rows)
    return text.getvalue()


def _cell(value: str | int) -> str | int:
    """Make a text safe: one line of visible characters, and no formula."""
    if isinstance(value, int):
        return value
    line = "".join(sign if sign.isprintable() else " " for sign in value[: 10 * LONGEST])
    line = " ".join(line.split())
    line = f"{line[: LONGEST - 1]}…" if len(line) > LONGEST else line
    return f"'{line}" if line.startswith(FORMULA) or value.startswith(FORMULA) else line
