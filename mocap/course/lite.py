"""The course in the browser alone: a JupyterLite site that holds the package as a wheel."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

from mocap._shared.atomic import write_text
from mocap.course.notebooks import read
from mocap.errors import MocapError, missing, shortened

WIDGETS = ["anywidget", "ipywidgets"]  # that the browser's Python does not have


def found() -> bool:
    """Check whether JupyterLite is installed."""
    return importlib.util.find_spec("jupyterlite_pyodide_kernel") is not None


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
    if not found():
        raise missing("The site needs JupyterLite, which is not installed", "lite")
    checkout = notebooks.parent
    if not (checkout / "pyproject.toml").exists():
        raise MocapError("A JupyterLite site is built from a checkout; this is an installed package.")
    with tempfile.TemporaryDirectory() as folder:
        wheels, contents = Path(folder, "wheels"), Path(folder, "contents")
        _call(folder, ["pip", "wheel", "--no-deps", "--wheel-dir", wheels, checkout.resolve()])
        _copy(notebooks, contents)
        (wheel,) = wheels.glob("*.whl")
        parts: list[str | Path] = ["--contents", contents, "--piplite-wheels", wheel]
        _call(folder, ["jupyterlite_core", "build", *parts, "--output-dir", out.resolve()])
    return out / "lab" / "index.html"


def _copy(notebooks: Path, contents: Path) -> None:
    """Copy the notebooks, each with a first cell that installs the package."""
    import nbformat

    contents.mkdir()
    install = f"%pip install -q motion-graphs {' '.join(WIDGETS)}"
    for file in sorted(notebooks.glob("*.ipynb")):
        notebook = read(file)
        notebook.cells.insert(1, nbformat.v4.new_code_cell(install, id="install"))
        write_text(contents / file.name, nbformat.writes(notebook))
    for page in notebooks.glob("[A-Z]*.md"):
        write_text(contents / page.name, page.read_text("utf-8"))


def _call(folder: str, command: list[str | Path]) -> None:
    """Run a Python module in a folder, where it may leave files."""
    whole = [sys.executable, "-m", *map(str, command)]
    done = subprocess.run(whole, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        last = (done.stderr or done.stdout).strip().splitlines()[-1:]
        raise MocapError(f"'{command[0]} {command[1]}' failed: {shortened(''.join(last), 120)}")
