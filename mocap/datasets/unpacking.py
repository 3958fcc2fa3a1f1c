"""Clips out of an archive from the network: all of them or none, within bounds on its size.

A .zip file of 3 MB can claim, and unpack to, 3 GB. Its directory is therefore checked before anything is
unpacked, and `zipfile` unpacks no more of a member than the directory claims. The clips are unpacked into a
folder beside their place, and moved when all of them are there.
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

# Twice the ratio of the BVH file that shrinks most of 18 from seven sources (2.3 to 4.9, all together 2.8).
# The 1469 MB of 100STYLE may become 15 GB.
RATIO = 10

# Bytes that any archive may unpack to. A few small clips, whose rows repeat, shrink further.
ROOM = 2**20

# Six times the files of Bandai-Namco's set, which has the most: 3 077 clips.
MEMBERS = 20_000

# Others are rarely written, and some make their readers take gigabytes of memory.
METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)

ENCRYPTED = 1  # the bit of a member's flags
MODE = 16  # the bit of a member's attributes where the mode of Unix begins
NO_KIND = 0  # of a member written by a system without modes
DIRECTORY_ENTRY = b"PK\x01\x02"  # begins the entry of each member in the directory
PIECE = 2**20  # bytes read at once


class BadArchive(MocapError):
    """An archive that is damaged, or that no set of clips can be; nothing of it has been unpacked."""


def unpack(archive: Path, folder: Path, progress: Progress = iter) -> list[str]:
    """Write all .bvh files of an archive into a folder, without the archive's own folders.

    Parameters
    ----------
    archive : a .zip file. Its size bounds what it may unpack to.
    folder : the folder for the clips, which exists.
    progress : shows how many clips are unpacked, as `tqdm.tqdm` does.

    Returns
    -------
    The names of the files.

    Raises
    ------
    BadArchive : for an archive that is damaged, holds no clip, claims to hold too much, or has a path outside
        the folder.
    MocapError : if the disk has no space, or the folder cannot be written into.

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
    """Report a damaged archive in one sentence, whatever `zipfile` and zlib raise."""
    problem = f"{archive.name} is damaged, or no .zip file: get it anew."
    try:
        yield
    except MocapError:
        raise
    except OSError as error:
        if error.errno == errno.EINVAL:  # a place before the beginning of the file
            raise BadArchive(problem) from error
        raise
    except Exception as error:
        raise BadArchive(problem) from error


def _require_few_members(archive: Path) -> None:
    """Refuse an archive with too many members before `zipfile` makes an object of each."""
    count = 0
    tail = b""  # shorter than what is counted, so that nothing counts twice
    with archive.open("rb") as file:
        while piece := file.read(PIECE):
            data = tail + piece
            count += data.count(DIRECTORY_ENTRY)
            tail = data[1 - len(DIRECTORY_ENTRY) :]
    if count > MEMBERS:
        raise BadArchive(f"{archive.name} has more than {MEMBERS} files, which no set has: get it anew.")


def _check_members(archive: Path, members: list[zipfile.ZipInfo]) -> dict[str, zipfile.ZipInfo]:
    """Refuse an archive by its directory.

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
    """Return the reason why no honest set has such a member; None if one may have it."""
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
    spelled: dict[str, zipfile.ZipInfo] = {}  # as file systems compare names that ignore capitals
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
    """Unpack clips into a folder of their own, then move them to their place."""
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
