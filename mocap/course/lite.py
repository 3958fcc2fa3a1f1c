"""The course in a browser alone: JupyterLite, with the package as a wheel inside."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

from mocap._shared.atomic import write_text
from mocap.course.notebooks import read
from mocap.errors import MocapError

WIDGETS = ["anywidget", "ipywidgets"]  # and whatever else the browser's Python does not bring along


def found() -> bool:
    """Tell whether JupyterLite is installed."""
    return importlib.util.find_spec("jupyterlite_pyodide_kernel") is not None


def build_lite(notebooks: Path, out: Path) -> Path:
    """Build a site on which the notebooks run without a server; Python comes with the first page.

    Whoever opens it needs a network: the browser's Python, numpy, scipy and matplotlib come from there.

    Parameters
    ----------
    notebooks : the course's folder, in a checkout: its wheel goes in.
    out : where the site goes.

    Returns
    -------
    The first page.

    Raises
    ------
    MocapError : where JupyterLite is not installed, there is no checkout, or the building fails.
    """
    if not found():
        raise MocapError("The site needs JupyterLite, which is not here: pip install 'mocap[lite]'.")
    checkout = notebooks.parent
    if not (checkout / "pyproject.toml").exists():
        raise MocapError("A JupyterLite site is built from a checkout of the package, which is not here.")
    with tempfile.TemporaryDirectory() as folder:
        wheels, contents = Path(folder, "wheels"), Path(folder, "contents")
        _call(folder, ["pip", "wheel", "--no-deps", "--wheel-dir", wheels, checkout.resolve()])
        _copy(notebooks, contents)
        (wheel,) = wheels.glob("mocap-*.whl")
        parts: list[str | Path] = ["--contents", contents, "--piplite-wheels", wheel]
        _call(folder, ["jupyterlite_core", "build", *parts, "--output-dir", out.resolve()])
    return out / "lab" / "index.html"


def _copy(notebooks: Path, contents: Path) -> None:
    """Copy the notebooks, each with a first cell that installs the package."""
    import nbformat

    contents.mkdir()
    install = f"%pip install -q mocap {' '.join(WIDGETS)}"
    for file in sorted(notebooks.glob("*.ipynb")):
        notebook = read(file)
        notebook.cells.insert(1, nbformat.v4.new_code_cell(install, id="install"))
        write_text(contents / file.name, nbformat.writes(notebook))
    for page in notebooks.glob("[A-Z]*.md"):
        write_text(contents / page.name, page.read_text("utf-8"))


def _call(folder: str, command: list[str | Path]) -> None:
    """Run a module of Python's in a folder, where it may leave what it likes."""
    done = subprocess.run(
        [sys.executable, "-m", *map(str, command)], cwd=folder, capture_output=True, text=True, check=False
    )
    if done.returncode:
        last = (done.stderr or done.stdout).strip().splitlines()[-1:]
        raise MocapError(f"'{command[0]} {command[1]}' failed: {''.join(last)}")
