"""A reader's copy of the course: what a new version changes in it, a notebook given anew, and progress."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from mocap._shared.atomic import write_file
from mocap.course.notebooks import library, notebooks_in, read, tagged
from mocap.errors import MocapError, Remedy, shortened

RECORD = ".course.json"  # in the copy: the version of the course, and the notebooks as they were copied
EARLIER = "earlier"  # the folder for notebooks that were given anew
UNKNOWN = ""  # in the record: the notebook of a copy that an earlier version made
MINE = "my_graph.py"  # beside the notebooks: the functions that passed their checks
LAST_OF_PROGRAM = 8  # the number of the last notebook of the way that has a part of the program


def record_copy(folder: Path, copy: Path, version: str) -> str:
    """Note in a copy which version of the course it has, and say what this version changes.

    Parameters
    ----------
    folder : the notebooks of this version.
    copy : the reader's folder, which has all of them already.
    version : that of the package.

    Returns
    -------
    Which notebooks have changed since they were copied, and what to do; "" for none. Of a copy without a
    record, those have changed whose texts differ.
    """
    earlier: dict[str, str] = _read_record(copy).get("notebooks", {})
    recorded = {}
    changed = []
    for file in notebooks_in(folder):
        digest = _digest(file)
        is_same_text = _texts(file) == _texts(copy / file.name)
        recorded[file.name] = earlier.get(file.name, digest if is_same_text else UNKNOWN)
        if recorded[file.name] != digest:
            changed.append(file.name.partition("-")[0])
    _write_record(copy, version, recorded)
    if not changed:
        return ""
    start = f"Version {version} changes these notebooks of your copy: {', '.join(changed)}."
    return f"{start} `mocap lab --reset {changed[0]}` gives a notebook anew, with your answers in it."


def reset_notebook(folder: Path, copy: Path, number: str, version: str) -> str:
    """Give a notebook of a copy anew, with the reader's answers, and keep the old one in a folder beside it.

    Parameters
    ----------
    folder : the notebooks of this version.
    copy : the reader's folder.
    number : that of the notebook, such as 03 or 04b.
    version : that of the package.

    Returns
    -------
    A sentence that says which answers were kept, and where the old notebook is.

    Raises
    ------
    MocapError : for a number that no notebook has, and an old notebook that cannot be read.
    """
    file = notebook_file(folder, number)
    target = copy / file.name
    notebook = read(file)
    without_checks(notebook)
    kept: list[str] = []
    sentence = f"{file.name} is new"
    if target.exists():
        kept = _carry_over(read(target), notebook)
        old = _free_name(copy / EARLIER / file.name)
        old.parent.mkdir(exist_ok=True)
        shutil.copy(target, old)
        sentence += f"; the old one is {old.relative_to(copy)}"
    write_file(target, library().writes(notebook) + "\n")
    recorded = _read_record(copy).get("notebooks", {})
    _write_record(copy, version, {**recorded, file.name: _digest(file)})
    answers = f" Your answers are in it: {', '.join(kept)}." if kept else ""
    return f"{sentence}.{answers}"


def notebook_file(folder: Path, number: str) -> Path:
    """Return the file of a notebook.

    Parameters
    ----------
    folder : the notebooks of this version.
    number : that of the notebook, such as 03 or 04b.

    Raises
    ------
    MocapError : for a number that no notebook has.
    """
    for file in notebooks_in(folder):
        if file.name.partition("-")[0] == number:
            return file
    problem = f"There is no notebook {shortened(repr(number), 40)}."
    raise MocapError(problem, remedy=Remedy("give {} the number of one, such as 03", "reset"))


def without_checks(notebook: Any) -> None:  # noqa: ANN401
    """Remove the outputs of the cells that check an exercise."""
    for _, cell in tagged(notebook, "check"):
        cell.outputs = []
        cell.execution_count = None


def progress(file: Path | None) -> str:
    """Return how many exercises of each notebook of the way are solved, and which is next.

    Parameters
    ----------
    file : the file that keeps functions that passed their checks; None for none.

    Examples
    --------
    >>> print(progress(None).splitlines()[0])
    00 ○○ speed, cheapest
    """
    from mocap.course.lab.kept_functions import read_text, split  # needs NumPy and networkx

    solved = {name for name, _, _ in split(read_text(file))[1]}
    lines = []
    following = ""
    for number, names in _exercises().items():
        missing = [name for name in names if name not in solved]
        marks = "".join("○" if name in missing else "●" for name in names)
        lines.append(f"{number} {marks} {', '.join(missing) or 'solved'}")
        if missing and not following:
            following = f"Next: `{missing[0]}` in notebook {number}."
    return "\n".join([*lines, following or "All exercises of the way are solved."])


def _exercises() -> dict[str, list[str]]:
    """Return the exercises of the way by their notebooks."""
    from mocap.course.checks import all_checks  # the help needs no NumPy

    by_notebook: dict[str, list[str]] = {}
    for name, check in all_checks().items():
        if check.notebook.isdigit() and int(check.notebook) <= LAST_OF_PROGRAM:
            by_notebook.setdefault(check.notebook, []).append(name)
    return by_notebook


def _carry_over(old: Any, new: Any) -> list[str]:  # noqa: ANN401
    """Put the answers of an old notebook into the exercises of a new one; return their names."""
    answers = {name: cell.source for name, cell in tagged(old, "exercise")}
    kept = []
    for name, cell in tagged(new, "exercise"):
        if answers.get(name, cell.source) != cell.source:
            cell.source = answers[name]
            kept.append(name)
    return kept


def _free_name(path: Path) -> Path:
    """Return the path, or one with a number that no file has."""
    candidate = path
    number = 1
    while candidate.exists():
        number += 1
        candidate = path.with_name(f"{path.stem} ({number}){path.suffix}")
    return candidate


def _digest(file: Path) -> str:
    """Return a digest of the cells of a notebook, without their outputs."""
    return sha256(json.dumps([cell["source"] for cell in _cells(file)]).encode()).hexdigest()


def _texts(file: Path) -> list[Any]:
    """Return the texts of a notebook, which readers seldom change."""
    return [cell.get("source") for cell in _cells(file) if cell.get("cell_type") == "markdown"]


def _cells(file: Path) -> list[dict[str, Any]]:
    """Return the cells of a notebook; none of a file that is not one, as an editor may leave it."""
    try:
        notebook = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError):
        return []
    cells = notebook.get("cells", []) if isinstance(notebook, dict) else []
    return [cell for cell in cells if isinstance(cell, dict)]


def _read_record(copy: Path) -> dict[str, Any]:
    """Read the record of a copy; that of an earlier version has none."""
    try:
        record = json.loads((copy / RECORD).read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) else {}


def _write_record(copy: Path, version: str, notebooks: Mapping[str, str]) -> None:
    text = json.dumps({"version": version, "notebooks": dict(notebooks)}, indent=1)
    write_file(copy / RECORD, text + "\n")
