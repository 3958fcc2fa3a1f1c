"""A file is written whole or not at all."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mocap.errors import MocapError


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Write a new file beside the old one, then replace the old one in a single step.

    If anything goes wrong inside the `with` block, even an interruption, the old file stays as it was,
    and the new one is removed.

    Parameters
    ----------
    path : the file to make or replace.

    Yields
    ------
    A path in the same folder, with the same suffix, to write to.

    Raises
    ------
    MocapError : when the folder is missing, or writing there is not allowed.

    Examples
    --------
    >>> with replacing("nowhere/walk.bvh") as beside:
    ...     beside.write_text("")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot write nowhere/walk.bvh: No such file or directory.
    """
    path = Path(path)
    try:
        folder = tempfile.TemporaryDirectory(prefix=".", dir=path.parent, ignore_cleanup_errors=True)
        with folder as beside:  # a folder: a file in it gets ordinary permissions
            yield Path(beside, path.name)
            Path(beside, path.name).replace(path)
    except OSError as error:
        raise MocapError(f"Cannot write {path}: {error.strerror or error}.") from error


def require_npz(path: str | Path) -> None:
    """Raise unless a file to write is called .npz, in small or capital letters."""
    if Path(path).suffix.lower() != ".npz":
        raise MocapError(f"This is written as .npz, got '{path}'.")


def require_writable(path: str | Path) -> None:
    """Raise, before any work is done for it, where a file could not be written.

    Examples
    --------
    >>> require_writable("nowhere/walk.bvh")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot write nowhere/walk.bvh: No such file or directory.
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise MocapError(f"Cannot write {path}: it is a folder.")
        tempfile.TemporaryDirectory(prefix=".", dir=path.parent).cleanup()
    except OSError as error:
        raise MocapError(f"Cannot write {path}: {error.strerror or error}.") from error


def write_text(path: str | Path, text: str) -> None:
    """Write a text file as UTF-8, whole or not at all."""
    with replacing(path) as beside:
        beside.write_text(text, encoding="utf-8", newline="\n")


def require_folder(path: Path) -> None:
    """Raise, before any work is done for it, where a folder could not be made or written into.

    Examples
    --------
    >>> require_folder(Path(__file__) / "below")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...below: Not a directory.
    """
    try:
        nearest = next((place for place in (path, *path.parents) if place.exists()), Path())
        tempfile.TemporaryDirectory(prefix=".", dir=nearest).cleanup()
    except OSError as error:
        raise MocapError(f"Cannot make the folder {path}: {error.strerror or error}.") from error


def make_folder(path: Path) -> None:
    """Make a folder and the folders above it, if they are missing.

    Examples
    --------
    >>> make_folder(Path(__file__))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...atomic.py: File exists.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MocapError(f"Cannot make the folder {path}: {error.strerror}.") from error
