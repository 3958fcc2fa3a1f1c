"""A file is written whole or not at all.

It is made in a folder beside its place, and moved when it is complete. A process that is killed leaves that
folder; who writes there a day later removes it.
"""

import errno
import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from mocap.errors import MocapError

UNFINISHED = ".mocap-unfinished-"  # and some letters: the folders of files that are being written
DAY = 86_400  # seconds; nobody writes one file for so long


@contextmanager
def _explained(action: str) -> Iterator[None]:
    """Say of an error of the system what it hinders."""
    try:
        yield
    except OSError as error:
        raise MocapError(f"Cannot {action}: {error.strerror or error}.") from error


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Write a new file beside the old one, then replace the old one in a single step.

    If anything goes wrong inside the `with` block, even an interruption, the old file stays as it was,
    and the new one is removed. Afterwards the new one is on the disk, even if the power fails.

    Parameters
    ----------
    path : the file to make or replace; of a symbolic link, the file that it leads to.

    Yields
    ------
    A path on the same disk, with the same name, to write to.

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
    real = Path(os.path.realpath(path))
    with _explained(f"write {path}"), _workshop(real) as folder:
        new = folder / Path(path).name
        yield new
        _sync(new, os.O_RDWR)
        new.replace(real)
        with suppress(OSError):  # not every system can
            _sync(real.parent, os.O_RDONLY)


def _sync(path: Path, flags: int) -> None:
    number = os.open(path, flags)
    try:
        os.fsync(number)
    finally:
        os.close(number)


@contextmanager
def _workshop(path: Path) -> Iterator[Path]:
    """Make a folder beside a file to write: a file in it gets ordinary permissions."""
    if path.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    _tidy(path.parent)
    temporary = tempfile.TemporaryDirectory(prefix=UNFINISHED, dir=path.parent, ignore_cleanup_errors=True)
    with temporary as folder:
        yield Path(folder)


@cache
def _tidy(place: Path) -> None:
    """Remove the folders of processes that were killed."""
    for folder in place.glob(f"{UNFINISHED}*"):
        with suppress(OSError):  # another process may do so as well
            if time.time() - folder.stat().st_mtime > DAY:
                shutil.rmtree(folder)


def require_writable(path: str | Path) -> None:
    """Raise, before any work is done for it, where a file could not be written.

    Examples
    --------
    >>> require_writable("nowhere/walk.bvh")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot write nowhere/walk.bvh: No such file or directory.
    """
    with _explained(f"write {path}"):
        real = Path(os.path.realpath(path))
        if real.is_dir():
            raise MocapError(f"Cannot write {path}: it is a folder.")
        with _workshop(real):
            pass


def write_file(path: str | Path, content: str | bytes) -> None:
    """Write bytes, or a text as UTF-8, whole or not at all."""
    with replacing(path) as new:
        new.write_bytes(content.encode() if isinstance(content, str) else content)


def require_folder(path: Path) -> None:
    """Raise, before any work is done for it, where a folder could not be made or written into.

    Examples
    --------
    >>> require_folder(Path(__file__) / "below")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...below: Not a directory.
    """
    with _explained(f"make the folder {path}"):
        nearest = next((place for place in (path, *path.parents) if place.exists()), Path())
        with _workshop(nearest / UNFINISHED):
            pass


def make_folder(path: Path) -> None:
    """Make a folder and the folders above it, if they are missing.

    Examples
    --------
    >>> make_folder(Path(__file__))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...atomic.py: File exists.
    """
    with _explained(f"make the folder {path}"):
        path.mkdir(parents=True, exist_ok=True)
