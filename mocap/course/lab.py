"""Opening the course in JupyterLab."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

from mocap.errors import MocapError

PACKAGE = Path(__file__).parents[1]
FIRST = "00-quickstart.ipynb"


def stored() -> Path:
    """Find the notebooks as they are stored: in the checkout, or else in the installed package."""
    checkout = PACKAGE.parent / "notebooks"
    return checkout if (checkout / FIRST).exists() else PACKAGE / "notebooks"


def course_folder(copy: Path) -> Path:
    """Find the notebooks: those of the checkout, or else a copy of the package's own that may be edited.

    Parameters
    ----------
    copy : where to put the copy; notebooks that are there already stay as they are.

    Returns
    -------
    The folder that holds them.
    """
    folder = stored()
    if folder != PACKAGE / "notebooks":
        return folder
    try:
        copy.mkdir(parents=True, exist_ok=True)
        for file in sorted(folder.iterdir()):
            if not (copy / file.name).exists():
                shutil.copy(file, copy)
    except OSError as error:
        raise MocapError(f"Cannot copy the notebooks to {copy}: {error.strerror}.") from error
    return copy


def open_course(copy: Path) -> int:
    """Start JupyterLab on the first notebook, wait until it ends, and give its exit status.

    Raises
    ------
    MocapError : where JupyterLab is not installed, saying what to install.
    """
    if importlib.util.find_spec("jupyterlab") is None:
        raise MocapError("The course runs in JupyterLab, which is not here: pip install 'mocap[notebooks]'.")
    folder = course_folder(copy)
    return subprocess.run([sys.executable, "-m", "jupyterlab", str(folder / FIRST)], check=False).returncode
