"""The package as a wheel for students, and the requirement by which a copy of a notebook installs it.

The wheel is put together from the files that are installed here, or from the checkout, without a build and
without a network. Its notebooks have no solutions, and a teacher's answers to the exam are left out.
"""

from __future__ import annotations

import base64
import hashlib
import io
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator, Mapping
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from importlib.util import find_spec
from pathlib import Path

from mocap.course.opening import PACKAGE, stored
from mocap.errors import MocapError, shortened

NAME = "motion-graphs"
EXTRA = "notebooks"
TAG = "py3-none-any"
NOTEBOOKS = "mocap/notebooks"  # where an installed package has them
PRIVATE = "answers"  # how a teacher's files with answers to the exam begin, in the folder `teaching`
FOLDERS = ("", "examples", "slides", "teaching")  # of the notebooks
SUFFIXES = (".ipynb", ".md", ".png", ".mp4", ".py")
KEPT = "my_graph.py"  # functions of whoever works in this checkout
ENTRY = "entry_points.txt"
EARLIEST = (1980, 1, 1, 0, 0, 0)  # the date of all files, so that the same package gives the same wheel
TRYING = 120  # seconds for pip to find a package
SHOWN = 60  # characters of an address in an error


class NotInstallable(MocapError):
    """The package cannot be installed from the place that a handout would name.

    Attributes
    ----------
    obstacle : what cannot be installed, without a remedy.
    """

    def __init__(self, obstacle: str) -> None:
        self.obstacle = obstacle
        super().__init__(
            f"{obstacle}: hand out with origin='wheel', which puts the package beside the notebooks."
        )


def students_wheel(without_solutions: Callable[[Path], str]) -> tuple[str, bytes]:
    """Put the package together as a wheel for students.

    Parameters
    ----------
    without_solutions : from the file of a notebook to its text for students.

    Returns
    -------
    The name of the file, and its bytes.

    Raises
    ------
    MocapError : if the package is not installed, so that what it requires is unknown.
    """
    try:
        installed = distribution(NAME)
    except PackageNotFoundError as error:
        raise MocapError("A wheel needs the package's metadata: install it with pip.") from error
    stem = f"{NAME.replace('-', '_')}-{installed.version}"
    info = f"{stem}.dist-info"
    files = dict(_package_files()) | dict(_notebook_files(without_solutions))
    files |= _metadata_files(installed, info)
    rows = [f"{path},sha256={_digest(content)},{len(content)}" for path, content in files.items()]
    files[f"{info}/RECORD"] = "\n".join([*rows, f"{info}/RECORD,,", ""]).encode()
    wheel = io.BytesIO()
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            archive.writestr(_entry(path), content)
    return f"{stem}-{TAG}.whl", wheel.getvalue()


def _entry(path: str) -> zipfile.ZipInfo:
    """Return the entry of a file that all can read."""
    entry = zipfile.ZipInfo(path, EARLIEST)
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = 0o644 << 16
    return entry


def _digest(content: bytes) -> str:
    """Return the hash of a file, as a wheel's RECORD writes it."""
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")


def _package_files() -> Iterator[tuple[str, bytes]]:
    """Yield the files of the package, except its notebooks, by their paths in a wheel."""
    for file in sorted(PACKAGE.rglob("*")):
        path = f"{PACKAGE.name}/{file.relative_to(PACKAGE).as_posix()}"
        hidden = any(part.startswith(".") or part == "__pycache__" for part in path.split("/"))
        if file.is_file() and not hidden and not path.startswith(f"{NOTEBOOKS}/"):
            yield path, file.read_bytes()


def _notebook_files(without_solutions: Callable[[Path], str]) -> Iterator[tuple[str, bytes]]:
    """Yield the notebooks without solutions, and the pages and pictures that belong to them."""
    course = stored()
    for folder in FOLDERS:
        for file in sorted((course / folder).glob("*")):
            if _is_for_students(file):
                is_exercise = file.suffix == ".ipynb" and not folder
                content = without_solutions(file).encode() if is_exercise else file.read_bytes()
                yield f"{NOTEBOOKS}/{file.relative_to(course).as_posix()}", content


def _is_for_students(file: Path) -> bool:
    """Return whether students get a file of the notebooks' folder.

    Examples
    --------
    >>> _is_for_students(Path("notebooks/teaching/answers.md"))
    False
    """
    is_private = file.parent.name == "teaching" and file.name.startswith(PRIVATE)
    return file.suffix in SUFFIXES and file.name != KEPT and not is_private


def _metadata_files(installed: Distribution, info: str) -> Mapping[str, bytes]:
    """Return the files about a wheel: what the package requires, its commands and its licence."""
    wheel = f"Wheel-Version: 1.0\nGenerator: mocap\nRoot-Is-Purelib: true\nTag: {TAG}\n"
    copied = ("METADATA", ENTRY, "licenses/LICENSE")
    texts = {"WHEEL": wheel} | {name: installed.read_text(name) or "" for name in copied}
    return {f"{info}/{name}": text.encode() for name, text in texts.items()}


def requirement_from(address: str) -> str:
    """Return the requirement that installs the package from an address, or by its name if there is none.

    It is tried on this machine, without installing anything.

    Raises
    ------
    MocapError : if pip cannot find the package there.

    Examples
    --------
    >>> requirement_from("here")
    Traceback (most recent call last):
    mocap.errors.MocapError: 'here' is no address: one is such as git+https://HOST/OWNER/mocap.
    """
    if address and (":" not in address or '"' in address):
        raise MocapError(
            f"'{shortened(address, SHOWN)}' is no address: one is such as git+https://HOST/OWNER/mocap."
        )
    needed = f"{NAME}[{EXTRA}] @ {address}" if address else f"{NAME}[{EXTRA}]=={distribution(NAME).version}"
    if not _is_installable(needed):
        raise NotInstallable(f"pip cannot install '{shortened(needed, SHOWN)}' on this machine")
    return needed


def _is_installable(needed: str) -> bool:
    """Return whether pip finds a package; nothing is installed, and no dependency is looked for."""
    if find_spec("pip") is None:
        return False
    options = ["--dry-run", "--no-deps", "--ignore-installed", "--quiet", "--disable-pip-version-check"]
    command = [sys.executable, "-m", "pip", "install", *options, needed]
    try:
        tried = subprocess.run(
            command, capture_output=True, stdin=subprocess.DEVNULL, timeout=TRYING, check=False
        )
    except subprocess.TimeoutExpired:
        return False
    return tried.returncode == 0
