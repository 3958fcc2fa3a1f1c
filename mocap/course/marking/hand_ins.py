"""What students handed in: notebooks in folders and in archives, and everything else, which is listed."""

from __future__ import annotations

import os
import re
import stat
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path, PurePosixPath

from mocap._shared.records import NamedTuple
from mocap.errors import MocapError

LARGEST = 100 << 20  # bytes of a notebook's file, and of all notebooks of an archive together
MOST_MEMBERS = 10_000  # files in an archive
MOST_NOTEBOOKS = 100  # notebooks in an archive

SENT = re.compile(r"(.+?)_(?:LATE_)?(\d+)_(?:assignsubmission_|\d+_).*", re.DOTALL)
"""How Moodle and Canvas call what was handed in: NAME_NUMBER_assignsubmission_…, and NAME_NUMBER_NUMBER_…"""

NOTEBOOK = ".ipynb"
ARCHIVE = ".zip"
ANSWERS = (
    ARCHIVE,
    ".py",
    ".html",
    ".htm",
    ".md",
    ".pdf",
    ".txt",
    ".docx",
    ".odt",
    ".rar",
    ".7z",
    ".gz",
    ".tar",
)
"""Endings of what students hand in without a folder; other files beside the folders are the teacher's."""

Student = tuple[str, str]
"""The name of a student, and the number in Moodle or Canvas, if any."""


class Sent(NamedTuple):
    """A notebook that was handed in.

    Attributes
    ----------
    path : below the folder of all, with slashes; an archive is a folder in it.
    read : returns its bytes, or raises a MocapError that says what is wrong.
    """

    path: str
    read: Callable[[], bytes]


class Collected(NamedTuple):
    """All that is in a folder of hand-ins.

    Attributes
    ----------
    notebooks : in the order of their paths.
    without_notebook : the folders and files of students without any notebook, and the names of their files.
    """

    notebooks: list[Sent]
    without_notebook: dict[str, list[str]]


def sent_by(handed_in: str) -> Student:
    """Return the name of the student who handed a file in, and the number in Moodle or Canvas, if any.

    Examples
    --------
    >>> sent_by("ada/02.ipynb"), sent_by("Ada Lovelace_815_assignsubmission_file/02.ipynb")
    (('ada', ''), ('Ada Lovelace', '815'))
    >>> sent_by("lovelaceada_LATE_815_4711_02-matching.ipynb")
    ('lovelaceada', '815')
    """
    sent = handed_in.split("/")[0]
    if match := SENT.fullmatch(sent):
        return match[1], match[2]
    stem, dot, suffix = sent.rpartition(".")
    return (stem if f"{dot}{suffix.lower()}" in (NOTEBOOK, *ANSWERS) else sent), ""


def collect(folder: Path) -> Collected:
    """Find the notebooks in a folder, in the folders inside it and in archives, and who sent none.

    Suffixes are read without case. Nothing is unpacked: the notebooks of an archive are read from it, with
    limits on their number and size, and whatever their names are, no file is written. An archive in an
    archive is not opened.

    Parameters
    ----------
    folder : a folder for each student, or their files as Canvas gives them.

    Raises
    ------
    MocapError : if the folder cannot be read.

    Examples
    --------
    >>> collect(Path("nowhere"))
    Traceback (most recent call last):
    mocap.errors.MocapError: nowhere: No such file or directory.
    """
    try:
        entries = sorted(entry for entry in folder.iterdir() if not _is_hidden(entry.name))
    except OSError as error:
        raise MocapError(f"{folder}: {error.strerror}.") from error
    notebooks: list[Sent] = []
    rest: dict[Student, tuple[str, list[str]]] = {}
    for entry in entries:
        files = [entry] if not entry.is_dir() or entry.is_symlink() else list(_files_in(entry))
        is_file = files == [entry]
        if is_file and not _is_handed_in(entry.name):
            continue
        sent = [notebook for file in files for notebook in _notebooks_of(file, folder)]
        notebooks += sent
        if not sent:
            _, names = rest.setdefault(sent_by(entry.name), (entry.name, []))
            names += [file.name for file in files]
    students = {sent_by(notebook.path) for notebook in notebooks}
    without = {place: names for student, (place, names) in rest.items() if student not in students}
    return Collected(notebooks, without)


def _is_hidden(name: str) -> bool:
    """Return whether a system has put a file or folder there, and no student."""
    return name.startswith(".") or name in ("__MACOSX", "__pycache__", "Thumbs.db", "desktop.ini")


def _is_handed_in(name: str) -> bool:
    """Return whether a file beside the students' folders is one that a student handed in."""
    return name.lower().endswith((NOTEBOOK, *ANSWERS)) or SENT.fullmatch(name) is not None


def _files_in(folder: Path) -> Iterator[Path]:
    """Yield the files in a folder and in the folders inside it, in order; links are not followed."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not _is_hidden(name))
        yield from (Path(place, name) for name in sorted(names) if not _is_hidden(name))


def _notebooks_of(file: Path, folder: Path) -> list[Sent]:
    """List the notebook that a file is, or the notebooks in the archive that it is."""
    path = file.relative_to(folder).as_posix()
    if file.name.lower().endswith(NOTEBOOK):
        return [Sent(path, partial(_read_file, file))]
    if not file.name.lower().endswith(ARCHIVE):
        return []
    try:
        members = _members(file)
    except MocapError as error:
        return [Sent(path, partial(_fail, str(error)))]
    return [Sent(f"{path}/{_inside(member)}", partial(_read_member, file, member)) for member in members]


def _fail(message: str) -> bytes:
    raise MocapError(message)


def _read_file(file: Path) -> bytes:
    """Read a notebook's file; a link is none, as it may lead to another's notebook."""
    status = file.lstat()
    if not stat.S_ISREG(status.st_mode) or status.st_size > LARGEST:
        raise MocapError(f"is no plain file, or one of more than {LARGEST >> 20} MB.")
    return file.read_bytes()


def _members(file: Path) -> list[zipfile.ZipInfo]:
    """List the notebooks in an archive."""
    if not stat.S_ISREG(file.lstat().st_mode):
        raise MocapError("is no plain file.")
    try:
        with zipfile.ZipFile(file) as archive:
            members = archive.infolist()
    except (OSError, ValueError, zipfile.BadZipFile, NotImplementedError) as error:
        raise MocapError("is an archive that cannot be opened.") from error
    notebooks = [
        member
        for member in members
        if member.filename.lower().endswith(NOTEBOOK) and not any(map(_is_hidden, _parts(member)))
    ]
    size = sum(member.file_size for member in notebooks)
    if len(members) > MOST_MEMBERS or len(notebooks) > MOST_NOTEBOOKS or size > LARGEST:
        limits = f"{MOST_MEMBERS} files, {MOST_NOTEBOOKS} notebooks or {LARGEST >> 20} MB of them"
        raise MocapError(f"is an archive of more than {limits}.")
    if len({parts[0] for parts in map(_parts, notebooks) if SENT.fullmatch(parts[0])}) > 1:
        raise MocapError("is an archive of several students: unpack it into the folder.")
    return notebooks


def _parts(member: zipfile.ZipInfo) -> list[str]:
    """Return the folders and the name of a member, without any that lead out of the archive."""
    parts = PurePosixPath(member.filename.replace("\\", "/")).parts
    return [part for part in parts if part not in ("/", "..", ".")]


def _inside(member: zipfile.ZipInfo) -> str:
    return "/".join(_parts(member))


def _read_member(file: Path, member: zipfile.ZipInfo) -> bytes:
    """Read a notebook from an archive, no more of it than the archive states."""
    try:
        with zipfile.ZipFile(file) as archive, archive.open(member) as opened:
            return opened.read(member.file_size)
    except RuntimeError as error:  # a password
        raise MocapError("is in an archive with a password.") from error
    except Exception as error:  # zlib, lzma and zipfile raise errors of their own
        raise MocapError("cannot be read from its archive.") from error
