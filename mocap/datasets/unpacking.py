"""Unpacking of the clips in a downloaded archive: all of them or none, with limits on their size.

A .zip file of 3 MB may unpack to 3 GB. Its directory is therefore checked before anything is unpacked, and
`zipfile` unpacks at most the size of a member in the directory. The clips are unpacked to a temporary folder
beside their target, and moved once all of them are complete.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import tempfile
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from mocap._shared.atomic import UNFINISHED
from mocap._shared.progress import Progress
from mocap.datasets.partial_files import MEGABYTE, keeping, require_space
from mocap.errors import MocapError, shortened

# The largest compression ratio, twice the maximum for 18 BVH files from seven sources (2.3 to 4.9, together
# 2.8). The 1469 MB of 100STYLE may become 15 GB.
RATIO = 10

# Bytes to which any archive may unpack, because a few small clips with repeated rows have larger ratios.
ROOM = 2**20

# The largest number of members, six times that of the Bandai-Namco dataset, which has the most: 3 077 clips.
MEMBERS = 20_000

# Other methods are rarely used, and some require gigabytes of memory for reading.
METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)

ENCRYPTED = 1  # bit mask of a member's flags
MODE = 16  # shift of the Unix mode in a member's attributes
NO_KIND = 0  # file type of a member from a system without Unix modes
DIRECTORY_ENTRY = b"PK\x01\x02"  # signature of a member's entry in the directory
PIECE = 2**20  # bytes read at a time


class BadArchive(MocapError):
    """An archive that is damaged or implausible as a dataset, and of which nothing has been unpacked."""


def unpack(archive: Path, folder: Path, progress: Progress = iter) -> list[str]:
    """Unpack all .bvh files of an archive to a folder, without the folders in the archive.

    Parameters
    ----------
    archive : a .zip file. Its size limits the size of its content.
    folder : an existing folder for the clips.
    progress : shows the number of clips that are unpacked, as `tqdm.tqdm` does.

    Returns
    -------
    The names of the files.

    Raises
    ------
    BadArchive : for an archive that is damaged, contains no clip, is too large when unpacked, or has a path
        outside the folder.
    MocapError : if the disk has no space, or the folder cannot be written to.

    Examples
    --------
    >>> unpack(Path(__file__), Path())
    Traceback (most recent call last):
    mocap.datasets.unpacking.BadArchive: ...unpacking.py is damaged, or no .zip file: get it anew.
    """
    with keeping(folder / archive.name), _explained(archive):
        _require_few_members(archive)
        with zipfile.ZipFile(archive) as opened:
            clips = _check_members(archive, opened.infolist())
            require_space(folder / archive.name, sum(clip.file_size for clip in clips.values()))
            _write_all(opened, clips, folder, progress)
    return sorted(clips)


@contextmanager
def _explained(archive: Path) -> Iterator[None]:
    """Convert any error of `zipfile` and zlib to `BadArchive`."""
    problem = f"{archive.name} is damaged, or no .zip file: get it anew."
    try:
        yield
    except MocapError:
        raise
    except OSError as error:
        if error.errno == errno.EINVAL:  # an offset before the start of the file
            raise BadArchive(problem) from error
        raise
    except Exception as error:
        raise BadArchive(problem) from error


def _require_few_members(archive: Path) -> None:
    """Reject an archive with too many members, before `zipfile` creates an object for each."""
    count = 0
    tail = b""  # shorter than a signature, therefore none is counted twice
    with archive.open("rb") as file:
        while piece := file.read(PIECE):
            data = tail + piece
            count += data.count(DIRECTORY_ENTRY)
            tail = data[1 - len(DIRECTORY_ENTRY) :]
    if count > MEMBERS:
        raise BadArchive(f"{archive.name} has more than {MEMBERS} files, which no set has: get it anew.")


def _check_members(archive: Path, members: list[zipfile.ZipInfo]) -> dict[str, zipfile.ZipInfo]:
    """Check the directory of an archive.

    Returns
    -------
    The members that are clips, by the names of their files.
    """
    bound = RATIO * archive.stat().st_size + ROOM
    claimed = sum(member.file_size for member in members)
    if claimed > bound:
        plausible = f"clips of its size unpack to {bound / MEGABYTE:.0f} MB at most"
        raise BadArchive(
            f"{archive.name} claims to unpack to {claimed / MEGABYTE:.0f} MB, but {plausible}: get it anew."
        )
    for member in members:
        if problem := _problem_of(member):
            name = shortened(member.orig_filename, 60)
            raise BadArchive(f"{archive.name} holds '{name}', which {problem}: get it anew.")
    return _find_clips(archive, members)


def _problem_of(member: zipfile.ZipInfo) -> str | None:
    """Return the reason for which a member is rejected; None if it is acceptable."""
    folder, *folders = re.split(r"[/\\]", member.orig_filename)
    kind = stat.S_IFMT(member.external_attr >> MODE)
    if folder == "" or ".." in (folder, *folders) or set(":\0") & set(member.orig_filename):
        return "leads out of the folder"
    if kind not in (NO_KIND, stat.S_IFREG, stat.S_IFDIR):
        return "is a link or a device"
    if member.flag_bits & ENCRYPTED:
        return "is encrypted"
    if member.compress_type not in METHODS:
        return "is packed by a method other than deflate"
    return None


def _find_clips(archive: Path, members: Iterable[zipfile.ZipInfo]) -> dict[str, zipfile.ZipInfo]:
    """Return the members that are clips, by the names of their files."""
    clips: dict[str, zipfile.ZipInfo] = {}
    spelled: dict[str, zipfile.ZipInfo] = {}  # by names as compared on case-insensitive file systems
    for member in members:
        name = re.split(r"[/\\]", member.orig_filename)[-1]
        if not name.lower().endswith(".bvh") or name.startswith("._"):  # macOS adds such files to archives
            continue
        if not name.isprintable():
            raise BadArchive(f"{archive.name} holds '{shortened(name, 60)}', which is no name: get it anew.")
        namesake = spelled.setdefault(name.casefold(), member)
        if (namesake.CRC, namesake.file_size) != (member.CRC, member.file_size):
            raise BadArchive(
                f"{archive.name} holds two clips '{shortened(name, 60)}' that differ: unpack a copy yourself."
            )
        if namesake is member:
            clips[name] = member
    if not clips:
        raise BadArchive(f"{archive.name} holds no .bvh file: get it anew.")
    return clips


def _write_all(
    opened: zipfile.ZipFile, clips: dict[str, zipfile.ZipInfo], folder: Path, progress: Progress
) -> None:
    """Unpack clips to a temporary folder, then move them to their target."""
    for unfinished in folder.glob(f"{UNFINISHED}*"):  # of a process that was killed
        shutil.rmtree(unfinished, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix=UNFINISHED, dir=folder, ignore_cleanup_errors=True) as temporary:
        for name in progress(list(clips)):
            with opened.open(clips[name]) as packed, Path(temporary, name).open("wb") as file:
                shutil.copyfileobj(packed, file)
                file.flush()
                os.fsync(file.fileno())
        for name in clips:
            Path(temporary, name).replace(folder / name)
