"""The course in JupyterLab."""

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from mocap.errors import MocapError, missing

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
                shutil.copy(file, copy)
    except OSError as error:
        raise MocapError(f"Cannot copy the notebooks to {copy}: {error.strerror}.") from error
    return copy


def open_course(copy: Path, options: Sequence[str] = ()) -> int:
    """Start JupyterLab on the first notebook, wait until it ends, and return its exit status.

    Ctrl-C is JupyterLab's: it asks whether to shut down, and a second one ends it.

    Parameters
    ----------
    copy : as for `course_folder`.
    options : for JupyterLab, such as `--no-browser`. The administrator's account gets `--allow-root`, which
        JupyterLab asks for there.

    Raises
    ------
    MocapError : if JupyterLab is not installed.
    """
    if importlib.util.find_spec("jupyterlab") is None:
        raise missing("The course runs in JupyterLab, which is missing", "notebooks")
    root = ["--allow-root"] if getattr(os, "geteuid", lambda: 1)() == 0 else []
    first = str(course_folder(copy) / FIRST)
    started = subprocess.Popen([sys.executable, "-m", "jupyterlab", first, *root, *options])
    while True:
        try:
            return started.wait()
        except KeyboardInterrupt:  # JupyterLab has it as well, and answers it
            continue
