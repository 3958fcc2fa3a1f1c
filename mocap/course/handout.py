"""For teachers: copies of the notebooks without solutions."""

from __future__ import annotations

from pathlib import Path

from mocap._shared.atomic import make_folder, write_text
from mocap.course.notebooks import library, notebooks_in, read, tagged
from mocap.errors import MocapError

PAGES = ("GLOSSARY.md", "FORMULAS.md")  # the README is for teachers


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
    nbformat, files = library(), notebooks_in(notebooks)
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
