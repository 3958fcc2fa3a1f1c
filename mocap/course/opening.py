"""The course in JupyterLab, and in the browser alone, as a JupyterLite site with the package as a wheel."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from mocap import __version__
from mocap._shared.atomic import write_file
from mocap.course import copies
from mocap.course.notebooks import library, notebooks_in, read
from mocap.errors import MocapError, missing, shortened

PACKAGE = Path(__file__).parents[1]
FIRST = "00-quickstart.ipynb"


def stored() -> Path:
    """Find the folder of the notebooks: in the checkout, or in the installed package.

    Examples
    --------
    >>> (stored() / "00-quickstart.ipynb").exists()
    True
    """
    checkout = PACKAGE.parent / "notebooks"
    return checkout if (checkout / FIRST).exists() else PACKAGE / "notebooks"


def course_folder(copy: Path) -> Path:
    """Copy the notebooks to a folder to work in, so that those of a checkout stay as they are.

    The copies have no outputs of checks, because these say what an exercise must return before anybody has
    thought about it.

    Parameters
    ----------
    copy : the folder for the copy; notebooks that it holds already stay as they are.

    Returns
    -------
    The folder.
    """
    folder = stored()
    try:
        copy.mkdir(parents=True, exist_ok=True)
        for file in filter(Path.is_file, sorted(folder.iterdir())):
            if not (copy / file.name).exists():
                copy_file(file, copy / file.name)
    except OSError as error:
        raise MocapError(f"Cannot copy the notebooks to {copy}: {error.strerror}.") from error
    return copy


def copy_file(file: Path, copy: Path) -> None:
    """Copy a file; of a notebook, without what its checks have printed.

    Parameters
    ----------
    file : a notebook or a page.
    copy : the file to write.
    """
    text = file.read_text("utf-8") if file.suffix == ".ipynb" else ""
    if '"check:' in text:
        write_file(copy, without_verdicts(text))
    else:
        shutil.copy(file, copy)


def without_verdicts(text: str) -> str:
    """Remove the outputs of the cells that check an exercise from the text of a notebook.

    Examples
    --------
    >>> cell = {"metadata": {"tags": ["check:speed"]}, "outputs": ["not there yet"], "execution_count": 3}
    >>> json.loads(without_verdicts(json.dumps({"cells": [cell]})))["cells"][0]["outputs"]
    []
    """
    notebook = json.loads(text)
    for cell in notebook["cells"]:
        if any(tag.startswith("check:") for tag in cell["metadata"].get("tags", [])):
            cell["outputs"] = []
            cell["execution_count"] = None
    return json.dumps(notebook, ensure_ascii=False, indent=1) + "\n"


def news(copy: Path, reset: str = "") -> str:
    """Give a notebook anew if one is named, and say what is new in the course and what has been solved.

    Parameters
    ----------
    copy, reset : as for `open_course`.
    """
    sentences = []
    if reset:
        sentences.append(copies.reset_notebook(stored(), copy, reset, __version__))
    sentences.append(copies.record_copy(stored(), copy, __version__))
    sentences.append(copies.progress(copy / copies.MINE))
    return "\n".join(filter(None, sentences))


def open_course(copy: Path, options: Sequence[str] = (), reset: str = "") -> int:
    """Start JupyterLab on the first notebook, wait until it ends, and return its exit status.

    Before that, print what is new in the course, and what the reader has solved.

    Ctrl-C is JupyterLab's: it asks whether to shut down, and a second one ends it.

    Parameters
    ----------
    copy : as for `course_folder`.
    options : for JupyterLab, such as `--no-browser`. The administrator's account gets `--allow-root`, which
        JupyterLab asks for there.
    reset : the number of a notebook to give anew, with the reader's answers.

    Raises
    ------
    MocapError : if JupyterLab is not installed, and for a notebook that does not exist.
    """
    if find_spec("jupyterlab") is None:
        raise missing("The course runs in JupyterLab, which is missing", "notebooks")
    root = ["--allow-root"] if getattr(os, "geteuid", lambda: 1)() == 0 else []
    if reset:
        copies.notebook_file(stored(), reset)  # before anything is written
    first = str(course_folder(copy) / FIRST)
    print(news(copy, reset), flush=True)
    started = subprocess.Popen([sys.executable, "-m", "jupyterlab", first, *root, *options])
    while True:
        try:
            return started.wait()
        except KeyboardInterrupt:  # JupyterLab has it as well, and answers it
            continue


LOCAL: dict[str, Any] = {"text": True, "encoding": "locale", "errors": "replace"}  # what programs write
INSTALL = "%pip install -q motion-graphs anywidget ipywidgets"  # which the browser's Python does not have


def build_lite(notebooks: Path, out: Path) -> Path:
    """Build a site on which the notebooks run in the reader's browser, without a server for Python.

    The reader needs a network: the browser loads Python, numpy, scipy and matplotlib from it.

    Parameters
    ----------
    notebooks : the course's folder, in a checkout, of which a wheel is built.
    out : the folder for the site.

    Returns
    -------
    The first page.

    Raises
    ------
    MocapError : if JupyterLite is not installed, there is no checkout, or the build fails.
    """
    if not find_spec("jupyterlite_pyodide_kernel"):
        raise missing("The site needs JupyterLite, which is not installed", "lite")
    checkout = notebooks.parent
    if not (checkout / "pyproject.toml").exists():
        raise MocapError("A JupyterLite site is built from a checkout; this is an installed package.")
    with tempfile.TemporaryDirectory() as folder:
        wheels = Path(folder, "wheels")
        contents = Path(folder, "contents")
        _call(folder, ["pip", "wheel", "--no-deps", "--wheel-dir", wheels, checkout.resolve()])
        contents.mkdir()
        for file in notebooks_in(notebooks):
            notebook = library().reads(without_verdicts(library().writes(read(file))), as_version=4)
            notebook.cells.insert(1, library().v4.new_code_cell(INSTALL, id="install"))
            write_file(contents / file.name, library().writes(notebook))
        for page in notebooks.glob("[A-Z]*.md"):
            shutil.copy(page, contents)
        (wheel,) = wheels.glob("*.whl")
        parts: list[str | Path] = ["--contents", contents, "--piplite-wheels", wheel]
        _call(folder, ["jupyterlite_core", "build", *parts, "--output-dir", out.resolve()])
    return out / "lab" / "index.html"


def _call(folder: str, command: list[str | Path]) -> None:
    """Run a Python module in a folder, where it may leave files."""
    words = [sys.executable, "-m", *map(str, command)]
    process = subprocess.run(words, cwd=folder, capture_output=True, check=False, **LOCAL)
    if process.returncode:
        last = (process.stderr or process.stdout).strip().splitlines()[-1:]
        raise MocapError(f"'{command[0]} {command[1]}' failed: {shortened(''.join(last), 120)}")
