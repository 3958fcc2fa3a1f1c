"""Partially downloaded files: the received bytes, a record of their origin, and the space for the rest.

`NAME.part` beside the target contains the received bytes. `NAME.part.json` records their file on the server:
its address, its length, and its validator, which is an ETag or a date of modification. The record is written
before the bytes that it describes, therefore the process may be killed at any time.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from mocap.errors import MocapError

MEGABYTE = 10**6  # bytes
FULL_DISK = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC))


class Record(NamedTuple):
    """The file on the server to which received bytes belong."""

    url: str
    validator: str | None  # an ETag or a date, without which a download cannot resume
    length: int | None  # bytes, None if the server did not report it, and then a download cannot resume


class Part:
    """The received bytes of a file, beside the target path of the complete file.

    Parameters
    ----------
    target : the path of the complete file.
    url : its address. A download from another address is not resumed.
    """

    def __init__(self, target: Path, url: str) -> None:
        self.target = target
        self.url = url
        self.path = target.with_name(f"{target.name}.part")
        self.record_path = target.with_name(f"{target.name}.part.json")

    def size(self) -> int:
        """Return the number of received bytes."""
        return self.path.stat().st_size if self.path.exists() else 0

    def record(self) -> Record | None:
        """Read the record of the received bytes; None if it is missing, or belongs to another file."""
        try:
            stored = json.loads(self.record_path.read_text("utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        match stored:
            case {"url": self.url, "validator": str() | None, "length": int() | None}:
                return Record(self.url, stored["validator"], stored["length"])
        return None

    def is_whole(self) -> bool:
        """Return whether all bytes have been received."""
        record = self.record()
        return record is not None and record.length == self.size()

    def continuable(self) -> Record | None:
        """Return the record if the rest of the file can be requested, else None."""
        record = self.record()
        if record is None or record.validator is None or record.length is None:
            return None
        return record if 0 < self.size() < record.length else None

    def advice(self) -> str:
        """Return a message with the size of the received part, and the way to resume."""
        record = self.record()
        if self.is_whole():
            return "The whole file is here: fetch again to unpack it."
        if not self.size():
            copy = f"a copy of {self.target.parent.name}/{self.target.name}"
            return f"Nothing has come: try again later, or put {copy} into a folder that MOCAP_DATA names."
        if record is None or record.length is None or not self.continuable():
            return "No part of it can be continued: fetch again to start anew."
        kept = f"{self.size() / MEGABYTE:.0f} of {record.length / MEGABYTE:.0f} MB are kept"
        return f"{kept}: fetch again to continue from there."

    def write(self, record: Record) -> None:
        """Record to which file the bytes belong."""
        self.record_path.write_text(json.dumps(record._asdict()), "utf-8")

    def drop(self) -> None:
        """Remove the bytes and their record."""
        self.record_path.unlink(missing_ok=True)
        self.path.unlink(missing_ok=True)

    def tidy(self) -> None:
        """Remove the received bytes if no later call can resume the download."""
        if not self.continuable() and not self.is_whole():
            self.drop()

    def finish(self) -> None:
        """Sync the complete file to the disk, and move it to its target."""
        with self.path.open("rb+") as file:
            os.fsync(file.fileno())
        self.path.replace(self.target)
        self.record_path.unlink(missing_ok=True)


@contextmanager
def keeping(target: Path) -> Iterator[None]:
    """Convert errors of the system that prevent writing a file to `MocapError`.

    Examples
    --------
    >>> with keeping(Path("sets/walks.zip")):
    ...     raise OSError(errno.ENOSPC, "No space left on device")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot keep walks.zip in sets (No space left on device): free some space, and ...
    """
    try:
        yield
    except OSError as error:
        remedy = "let MOCAP_DATA name a folder you may write to"
        if error.errno in FULL_DISK:
            remedy = "free some space, and fetch again to continue"
        problem = f"Cannot keep {target.name} in {target.parent} ({error.strerror or error})"
        raise MocapError(f"{problem}: {remedy}.") from error


def require_space(target: Path, size: int) -> None:
    """Raise if the disk has no space for a file, before it is written.

    Parameters
    ----------
    target : the file, or one of several in the same folder.
    size : the number of bytes that will be written.

    Raises
    ------
    MocapError : with the megabytes that are needed, and those that are free.

    Examples
    --------
    >>> require_space(Path("walks.zip"), 10**18)
    Traceback (most recent call last):
    mocap.errors.MocapError: walks.zip needs 1000000000000 MB in ., and ... MB are free: free some ...
    """
    free = shutil.disk_usage(target.parent).free
    if size > free:
        raise MocapError(
            f"{target.name} needs {size / MEGABYTE:.0f} MB in {target.parent}, and {free / MEGABYTE:.0f} MB "
            f"are free: free some space, or let MOCAP_DATA name another folder."
        )


def sha256_of(path: Path) -> str:
    """Compute the SHA-256 of a file, in hexadecimal digits.

    Examples
    --------
    >>> sha256_of(Path(os.devnull))[:8]
    'e3b0c442'
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Lock a folder against downloads by other processes, as a context manager.

    The system releases the lock when this process ends in any way. On Windows, and on file systems without
    locks, nothing is locked.

    Raises
    ------
    MocapError : if another process or thread downloads to the folder.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    number = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        os.close(number)
        raise MocapError(f"Another process fetches into {folder}: wait until it has ended.") from error
    except OSError:  # no locks here
        pass
    try:
        yield
    finally:
        os.close(number)
