"""For teachers: copies of the notebooks without solutions, hints and outcomes, and the folder of nbgrader."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

from mocap._shared.atomic import make_folder, write_file
from mocap.course.notebooks import library, notebooks_in, read, solution, tagged
from mocap.course.opening import stored
from mocap.errors import MocapError, requirement

PAGES = ("GLOSSARY.md", "FORMULAS.md")  # the README is for teachers
TELLING = re.compile(r"checks\.|lab\.(bets?|quiz)\(")  # how cells begin whose outputs hold hints or outcomes
INSTALL = 'try:\n    import mocap\nexcept ImportError:  # as in Colab\n    %pip install -q "{}"'
MARKS = (
    "### BEGIN HIDDEN TESTS\nfrom mocap.course.checks import {0} as c\nc.require({0})\n### END HIDDEN TESTS"
)
CONFIG = """c = get_config()
c.CourseDirectory.course_id = "motion-graphs"
c.ClearSolutions.code_stub = {"python": "return ..."}
c.Execute.timeout = 120
"""


def hand_out(
    notebooks: Sequence[Path], out: Path, points: Mapping[str, float] | None = None, *, nbgrader: bool = False
) -> list[Path]:
    """Copy notebooks without their solutions, and with a first cell that installs the package.

    What runs them finds beside them what it asks for: a hub and Binder a `requirements.txt`, Binder the
    version of Python, too. Colab runs the first cell.

    Parameters
    ----------
    notebooks : files; by default those of the course.
    out : the folder for the copies; no file in it is replaced, as it may be a student's work.
    points : of exercises, by their names, for nbgrader; 1 for those that are not named.
    nbgrader : make the folder of a course for nbgrader instead, with the solutions marked. It has an
        assignment for each notebook, and after each check a cell that gives its points.

    Returns
    -------
    The copied notebooks.

    Raises
    ------
    MocapError : if there are no notebooks, or a copy would replace a file.

    Examples
    --------
    >>> hand_out([Path("nowhere.ipynb")], Path("out"))
    Traceback (most recent call last):
    mocap.errors.MocapError: nowhere.ipynb: No such file or directory.
    """
    course = stored()
    need = requirement("notebooks")
    copies = []
    files: dict[Path, str] = {}  # what is to be written, and where
    for file in notebooks or notebooks_in(course):
        folder = out / "source" / file.stem if nbgrader else out
        files[folder / file.name] = _without_solutions(file, need, points or {}, nbgrader=nbgrader)
        copies.append(folder / file.name)
        for page in PAGES:
            files[folder / page] = (course / page).read_text("utf-8")
        files[folder / "requirements.txt"] = f"{need}\n"
        files[folder / "runtime.txt"] = "python-3.11\n"
    if nbgrader:
        files[out / "nbgrader_config.py"] = CONFIG
    for path in files:
        if path.exists():
            raise MocapError(f"{path} exists already; choose another folder.")
    for path, text in files.items():
        make_folder(path.parent)
        write_file(path, text)
    return copies


def _without_solutions(file: Path, need: str, points: Mapping[str, float], *, nbgrader: bool) -> str:
    """Return a notebook for students: no solutions, no outputs that tell them, and a cell that installs."""
    notebook = read(file)
    solutions = list(tagged(notebook, "solution"))
    cells_with_solutions = [cell for _, cell in solutions]
    notebook.cells = [cell for cell in notebook.cells if cell not in cells_with_solutions]
    for cell in notebook.cells:
        if cell.cell_type == "code" and TELLING.match(cell.source):
            cell.outputs = []
            cell.execution_count = None
    if nbgrader:
        _prepare(notebook, {name: solution(cell) for name, cell in solutions}, points)
    nbformat = library()
    notebook.cells.insert(0, nbformat.v4.new_code_cell(INSTALL.format(need), id="install"))
    return str(nbformat.writes(notebook)) + "\n"


def _prepare(notebook: Any, solutions: Mapping[str, str], points: Mapping[str, float]) -> None:  # noqa: ANN401
    """Mark solutions and lock questions and checks, as nbgrader wants it; add cells that give points."""
    new_cell = library().v4.new_code_cell
    for name, cell in tagged(notebook, "exercise"):
        cell.source = _merged(cell.source, solutions[name])
        cell.metadata.nbgrader = _role(f"exercise-{name}", solution=True)
    for name, cell in tagged(notebook, "ask"):
        cell.metadata.nbgrader = _role(f"ask-{name}", locked=True)
    for name, cell in tagged(notebook, "check"):
        cell.metadata.nbgrader = _role(f"check-{name}", locked=True)
        role = _role(f"marks-{name}", locked=True, grade=True, points=points.get(name, 1))
        marks = new_cell(MARKS.format(name), id=f"marks-{name}"[:64], metadata={"nbgrader": role})
        notebook.cells.insert(notebook.cells.index(cell) + 1, marks)


def _role(name: str, **fields: float) -> dict[str, Any]:
    """Return what nbgrader reads about a cell."""
    plain = {"schema_version": 3, "grade": False, "locked": False, "solution": False, "task": False}
    return plain | {"grade_id": name} | fields


def _merged(stub: str, right: str) -> str:
    """Mark in a solution what the stub of its function does not have."""
    head = stub[: stub.index("...")].rpartition("\n")[0] + "\n"  # with the docstring
    if not right.startswith(head):
        right = head + right.partition("\n")[2]
    solution_lines = right.strip().splitlines()
    matcher = SequenceMatcher(None, stub.splitlines(), solution_lines, autojunk=False)
    merged: list[str] = []
    for kind, *_, start, stop in matcher.get_opcodes():
        lines = solution_lines[start:stop]
        if kind == "equal":
            merged += lines
        elif lines:
            indent = " " * min(len(line) - len(line.lstrip()) for line in lines if line)
            merged += [f"{indent}### BEGIN SOLUTION", *lines, f"{indent}### END SOLUTION"]
    return "\n".join(merged)
