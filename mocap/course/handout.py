"""For teachers: copies of the notebooks without solutions, hints and outcomes, and the folder of nbgrader."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

from mocap._shared.atomic import make_folder, require_folder, write_file
from mocap.course.notebooks import library, notebooks_in, read, solution, tagged
from mocap.course.opening import stored
from mocap.course.student_wheel import EXTRA, requirement_from, students_wheel
from mocap.course.written import KIND, TEMPLATE, questions_of
from mocap.errors import MocapError

PAGES = ("GLOSSARY.md", "FORMULAS.md", "HOMEWORK.md")  # the README is for teachers
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


WHEEL = "wheel"
"""The origin of the package if it is put beside the notebooks."""


def hand_out(
    notebooks: Sequence[Path],
    out: Path,
    origin: str = "",
    points: Mapping[str, float] | None = None,
    *,
    nbgrader: bool = False,
) -> list[Path]:
    """Copy notebooks without their solutions, and with a first cell that installs the package.

    Beside them are the files from which a hub and Binder learn what to install, and Binder the version of
    Python. Colab runs the first cell.

    Parameters
    ----------
    notebooks : files; by default those of the course.
    out : the folder for the copies; no file in it is replaced, as it may be a student's work.
    origin : from where the first cell installs the package: `WHEEL` puts it beside the notebooks, an address
        is one for pip, and "" is its name in pip's index. An address and the name are tried first.
    points : of exercises, by their names, for nbgrader; 1 for those that are not named.
    nbgrader : make the folder of a course for nbgrader instead, with the solutions marked. It has an
        assignment for each notebook, and after each check a cell that gives its points.

    Returns
    -------
    The copied notebooks.

    Raises
    ------
    MocapError : if there are no notebooks, a copy would replace a file, or the package cannot be installed
        from its origin.

    Examples
    --------
    >>> hand_out([Path("nowhere.ipynb")], Path("out"), WHEEL)
    Traceback (most recent call last):
    mocap.errors.MocapError: nowhere.ipynb: No such file or directory.
    """
    shown = [(file, read(file)) for file in notebooks or notebooks_in(stored())]
    require_folder(out)
    need, extras = _installed_from(origin)
    files: dict[Path, str | bytes] = {}  # what is to be written, and where
    copies = []
    for file, notebook in shown:
        folder = out / "source" / file.stem if nbgrader else out
        copied = _for_nbgrader(notebook, points or {}) if nbgrader else _for_students(notebook)
        copied.cells.insert(0, library().v4.new_code_cell(INSTALL.format(need), id="install"))
        files[folder / file.name] = _text(copied)
        files |= {folder / name: content for name, content in extras.items()}
        copies.append(folder / file.name)
    if nbgrader:
        files[out / "nbgrader_config.py"] = CONFIG
    write_new(files)
    return copies


def write_new(files: Mapping[Path, str | bytes]) -> None:
    """Write files, none of which exists.

    Raises
    ------
    MocapError : if one exists.
    """
    for path in files:
        if path.exists():
            raise MocapError(f"{path} exists already; choose another folder.")
    for path, content in files.items():
        make_folder(path.parent)
        write_file(path, content)


def _installed_from(origin: str) -> tuple[str, dict[str, str | bytes]]:
    """Return the requirement that installs the package, and the files for each folder of notebooks."""
    extras: dict[str, str | bytes] = {page: (stored() / page).read_text("utf-8") for page in PAGES}
    if origin == WHEEL:
        wheel, packed = students_wheel(lambda file: _text(_for_students(read(file))))
        extras[wheel] = packed
        need = f"./{wheel}[{EXTRA}]"
    else:
        need = requirement_from(origin)
    return need, extras | {"requirements.txt": f"{need}\n", "runtime.txt": "python-3.11\n"}


def _for_students(notebook: Any) -> Any:  # noqa: ANN401
    """Remove the solutions from a notebook and the outputs that tell them, and ask for answers in words."""
    cells_with_solutions = [cell for _, cell in tagged(notebook, "solution")]
    notebook.cells = [cell for cell in notebook.cells if cell not in cells_with_solutions]
    for cell in notebook.cells:
        if cell.cell_type == "code" and TELLING.match(cell.source):
            cell.outputs = []
            cell.execution_count = None
    for name, question in list(questions_of(notebook)):
        tags = [f"{KIND}:{name}"]
        answer = library().v4.new_markdown_cell(TEMPLATE, id=f"{KIND}-{name}", metadata={"tags": tags})
        notebook.cells.insert(notebook.cells.index(question) + 1, answer)
    return notebook


def _for_nbgrader(notebook: Any, points: Mapping[str, float]) -> Any:  # noqa: ANN401
    """Mark what nbgrader removes, locks and gives points for; a person gives those of answers in words."""
    solutions = {name: solution(cell) for name, cell in tagged(notebook, "solution")}
    copied = _for_students(notebook)
    _prepare(copied, solutions, points)
    for name, cell in tagged(copied, KIND):
        worth = points.get(KIND, 0)
        cell.metadata.nbgrader = _role(f"{KIND}-{name}", solution=True, grade=True, points=worth)
    return copied


def _text(notebook: Any) -> str:  # noqa: ANN401
    """Return the text of a notebook's file."""
    return str(library().writes(notebook)) + "\n"


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
