"""Atomic writing: a file is written completely or not at all.

It is written in a temporary folder next to its path, and moved once it is complete. A process that is killed
leaves that folder behind. A process that writes there at least a day later removes it.
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

UNFINISHED = ".mocap-unfinished-"  # the names of temporary folders begin with it
DAY = 86_400  # seconds, longer than it takes to write any file


@contextmanager
def _explained(action: str) -> Iterator[None]:
    """Convert an error of the operating system to a `MocapError` with the action that it prevents."""
    try:
        yield
    except OSError as error:
        raise MocapError(f"Cannot {action}: {error.strerror or error}.") from error


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Write a new file next to the old one, then replace the old one in a single step.

    After an error or an interruption inside the `with` block, the old file is unchanged and the new one is
    removed. After the block, the new file has been synced to the disk.

    Parameters
    ----------
    path : the file to create or replace, or a symbolic link to it.

    Yields
    ------
    A path on the same disk, with the same name, to write to.

    Raises
    ------
    MocapError : for a folder that is missing, or in which writing is not allowed.

    Examples
    --------
    >>> with replacing("nowhere/walk.bvh") as beside:
    ...     beside.write_text("")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot write nowhere/walk.bvh: No such file or directory.
    """
    real = Path(os.path.realpath(path))
    with _explained(f"write {path}"), _temporary_folder(real) as folder:
        new = folder / Path(path).name
        yield new
        _sync(new, os.O_RDWR)
        new.replace(real)
        with suppress(OSError):  # not every system can sync a folder
            _sync(real.parent, os.O_RDONLY)


def _sync(path: Path, flags: int) -> None:
    """Sync a file or folder to the disk."""
    descriptor = os.open(path, flags)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def _temporary_folder(path: Path) -> Iterator[Path]:
    """Create a temporary folder next to a file to be written. A file in it has the usual permissions."""
    if path.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    _remove_unfinished(path.parent)
    temporary = tempfile.TemporaryDirectory(prefix=UNFINISHED, dir=path.parent, ignore_cleanup_errors=True)
    with temporary as folder:
        yield Path(folder)


@cache
def _remove_unfinished(parent: Path) -> None:
    """Remove the temporary folders of processes that were killed, once for each parent."""
    for folder in parent.glob(f"{UNFINISHED}*"):
        with suppress(OSError):  # another process may remove it at the same time
            if time.time() - folder.stat().st_mtime > DAY:
                shutil.rmtree(folder)


def require_writable(path: str | Path) -> None:
    """Raise if a file cannot be written, before its content is computed.

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
        with _temporary_folder(real):
            pass


def write_file(path: str | Path, content: str | bytes) -> None:
    """Write bytes, or text as UTF-8, to a file atomically."""
    with replacing(path) as new:
        new.write_bytes(content.encode() if isinstance(content, str) else content)


def require_folder(path: Path) -> None:
    """Raise if a folder cannot be created or written to, before its content is computed.

    Examples
    --------
    >>> require_folder(Path(__file__) / "below")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...below: Not a directory.
    """
    with _explained(f"make the folder {path}"):
        existing = next((folder for folder in (path, *path.parents) if folder.exists()), Path())
        with _temporary_folder(existing / UNFINISHED):
            pass


def make_folder(path: Path) -> None:
    """Create a folder and the folders above it, if they are missing.

    Examples
    --------
    >>> make_folder(Path(__file__))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot make the folder ...atomic.py: File exists.
    """
    with _explained(f"make the folder {path}"):
        path.mkdir(parents=True, exist_ok=True)
