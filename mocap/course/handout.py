"""For teachers: copies of the notebooks without solutions, and marks for the notebooks handed in."""

from __future__ import annotations

import ast
import csv
import io
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.atomic import make_folder, write_text
from mocap.course.notebooks import library, read, tagged
from mocap.errors import MocapError

PAGES = ("GLOSSARY.md", "FORMULAS.md")  # the README is for teachers
SECONDS = 30  # time limit of an exercise
CHECKS = "from mocap.course import checks"
STARTING = {"seconds": 120}  # time limit of the cells before the exercises, which import much


def hand_out(notebooks: Path, out: Path) -> list[Path]:
    """Copy the course without its solutions.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the copies; no file in it is replaced, as it may be a student's work.

    Returns
    -------
    The copied notebooks.

    Raises
    ------
    MocapError : if there are no notebooks, or a copy would replace a file.

    Examples
    --------
    >>> hand_out(Path("nowhere"), Path("out"))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    nbformat, files = library(), sorted(notebooks.glob("*.ipynb"))
    if not files:
        raise MocapError(f"The folder {notebooks} holds no notebooks.")
    make_folder(out)
    for file in (*files, *(notebooks / page for page in PAGES)):
        if (out / file.name).exists():
            raise MocapError(f"{out / file.name} exists already; choose another folder.")
    for file in files:
        notebook = read(file)
        solutions = [cell for _, cell in tagged(notebook, "solution")]
        notebook.cells = [cell for cell in notebook.cells if cell not in solutions]
        write_text(out / file.name, nbformat.writes(notebook) + "\n")
    for page in PAGES:
        write_text(out / page, (notebooks / page).read_text("utf-8"))
    return [out / file.name for file in files]


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


def mark(folder: Path, progress: Callable[[Iterable[Path]], Iterable[Path]] = iter) -> Iterator[Mark]:
    """Run the exercises of all notebooks in a folder and in the folders inside it, each in its own process.

    The first code cell of a notebook runs, and then each exercise with the package's own check; no other cell
    does. The code is that of the students: run it where you would run their programs by hand.

    Parameters
    ----------
    folder : the notebooks handed in; the path of a file inside the folder says whose it is.
    progress : wraps the notebooks while they are marked.

    Yields
    ------
    A mark for each exercise.

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
    files = sorted(file for file in folder.rglob("*.ipynb") if ".ipynb_checkpoints" not in file.parts)
    if not files:
        raise MocapError(f"The folder {folder} holds no notebooks.")
    for file in progress(files):
        whose = file.relative_to(folder).as_posix()
        try:
            notebook = read(file)
        except MocapError as error:
            yield Mark(whose, "", False, str(error))
            continue
        exercises = dict(tagged(notebook, "exercise"))
        if not exercises:
            yield Mark(whose, "", False, "holds no exercises: their cells have the tag `exercise:NAME`.")
        for name, said in _said(notebook, exercises).items():
            yield Mark(whose, name, said.startswith("✓"), said)


def _said(notebook: Any, exercises: dict[str, Any]) -> dict[str, str]:  # noqa: ANN401
    """Run the exercises of a notebook and return what the checks say; continue after one that ends Python."""
    setup = next((cell.source for cell in notebook.cells if cell.cell_type == "code"), "")
    said: dict[str, str] = {}
    while left := {name: cell for name, cell in exercises.items() if name not in said}:
        said |= _run(setup, left)
    return {name: said[name] for name in exercises}


def _run(setup: str, exercises: dict[str, Any]) -> dict[str, str]:
    """Run exercises in one process, up to the first that does not end or that ends the process."""
    from nbclient import NotebookClient
    from nbclient.exceptions import CellTimeoutError, DeadKernelError
    from nbformat.v4 import new_code_cell, new_notebook

    cells = [new_code_cell(source, metadata=STARTING) for source in (f"{CHECKS}; checks.all_checks()", setup)]
    for name, cell in exercises.items():
        verdict = f"checks.all_checks()[{name!r}].verdict(globals().get({name!r}, lambda *_: ...)).__str__()"
        cells += [new_code_cell(cell.source), new_code_cell(f"{CHECKS}\n{verdict}")]
    run, started = new_notebook(cells=cells), [0]
    client = NotebookClient(run, allow_errors=True, shutdown_kernel="immediate")
    client.timeout_func = lambda cell: cell.metadata.get("seconds", SECONDS)
    client.on_cell_start = lambda cell, cell_index: started.append(cell_index)
    names, ended = list(exercises), ""
    try:
        client.execute()
    except CellTimeoutError:
        ended = f"✗ stopped after {client.timeout_func(cells[started[-1]])} s"
    except DeadKernelError:
        ended = "✗ ends Python itself"
    done = started[-1] // 2 - 1 if ended else len(names)
    said = [_verdict(*run.cells[2 * n + 2 : 2 * n + 4]) for n in range(max(done, 0))]
    at_fault = names if done < 0 else names[done : done + 1]
    return dict(zip(names, said, strict=False)) | dict.fromkeys(at_fault, ended)


def _verdict(exercise: Any, check: Any) -> str:  # noqa: ANN401
    """Return what a check says, or the error of the student's cell, which ran before it."""
    for output in exercise.outputs + check.outputs:
        if output.output_type == "error":
            return f"✗ {output.ename}: {output.evalue}"
    results = [output for output in check.outputs if output.output_type == "execute_result"]
    if not results:
        return "✗ keeps the check from printing"
    return str(ast.literal_eval(results[0].data["text/plain"]))


def to_csv(marks: Iterable[Mark]) -> str:
    """Write marks as the text of a .csv file, one line per mark.

    Examples
    --------
    >>> print(to_csv([Mark("ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.")]))
    handed in,exercise,right,said
    ada/02.ipynb,align,1,✓ align: right on 40 random inputs.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["handed in", "exercise", "right", "said"])
    table.writerows([mark.handed_in, mark.exercise, int(mark.right), mark.said] for mark in marks)
    return text.getvalue()
