"""Sets of clips that other labs share: from a copy of your own, or fetched once."""

from __future__ import annotations

import hashlib
import tomllib
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from mocap._shared.atomic import UNFINISHED, write_file
from mocap._shared.progress import Progress
from mocap.datasets.downloads import fetch, kept_in, show_once
from mocap.errors import MocapError, shortened

if TYPE_CHECKING:
    from mocap.body.motion import Motion

WHOLE = "TERMS.txt"  # written when all clips of a set are there
_TABLES = tomllib.loads(Path(__file__).with_name("sets.toml").read_text("utf-8"))


class NamedSet(NamedTuple):
    """A set of clips; `sets.toml` says what the fields are."""

    title: str
    licence: str
    allows: str
    address: str
    archive: str
    fps: float
    hips: str
    legs: list[str]
    megabytes: int | None = None
    sha256: str | None = None

    def terms(self) -> str:
        """Say whose clips they are, under which licence, and what that allows."""
        return f"These clips come from {self.title} ({self.address}), under {self.licence}: {self.allows}."

    def size(self) -> str:
        """Say how large the archive is."""
        return f"{self.megabytes} MB" if self.megabytes else "some hundred MB"


SETS = {name: NamedSet(**row) for name, row in _TABLES["sets"].items()}
"""The sets by the names of their folders."""

HASHES: dict[str, str] = _TABLES["clips"]


def folder_of(name: str) -> Path:
    """Give the folder in which a set is looked for, and into which it is fetched.

    Raises
    ------
    MocapError : for an unknown set.

    Examples
    --------
    >>> folder_of("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    if name not in SETS:
        raise MocapError(f"No set '{shortened(name, 40)}' is known; there are: {', '.join(SETS)}.")
    return kept_in() / name


def clips_of(name: str) -> dict[str, Path]:
    """Find the clips of a set that are at hand: their files by their names; of one name, the first file.

    Raises
    ------
    MocapError : for an unknown set.
    """
    paths = (path for path in folder_of(name).rglob("*.bvh") if UNFINISHED not in str(path))
    return {path.stem: path for path in sorted(paths, reverse=True)}


def fetch_set(name: str, progress: Progress = iter) -> list[str]:
    """Download all clips of a named set, unless they are at hand; its terms are printed first.

    Where the checksum of the whole is known, it is checked.

    Parameters
    ----------
    name : the set, one of `SETS`; `SETS[name].size()` says how large it is.
    progress : shows how far the unpacking is, as `tqdm.tqdm` does.

    Returns
    -------
    The clips' names.

    Raises
    ------
    MocapError : for an unknown set, without a network, and for an archive that is not the one listed.

    Examples
    --------
    >>> fetch_set("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    folder = folder_of(name)
    if not (folder / WHOLE).exists():
        named_set = SETS[name]
        show_once(named_set.terms())
        packed = fetch(f"{name}/{name}.zip", named_set.archive, named_set.sha256, named_set.terms())
        _unpack(packed, folder, progress)
        write_file(folder / WHOLE, f"{named_set.terms()}\n")
        packed.unlink()
    return sorted(clips_of(name))


def _unpack(archive: Path, folder: Path, progress: Progress) -> None:
    """Write all .bvh files of an archive into a folder, without the archive's own folders."""
    try:
        with zipfile.ZipFile(archive) as files:
            names = [name for name in files.namelist() if name.lower().endswith(".bvh")]
            clips = [name for name in names if not PurePosixPath(name).name.startswith("._")]  # of macOS
            for name in progress(clips):
                write_file(folder / PurePosixPath(name).name, files.read(name))
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError) as error:
        raise MocapError(f"{archive} is damaged, or no .zip file: delete it, and try again.") from error
    if not clips:
        raise MocapError(f"{archive} holds no .bvh file.")


def from_set(name: str, clip: str) -> Motion:
    """Read a clip of a named set, from your own copy or the one fetched; its terms are printed once.

    Parameters
    ----------
    name : the set, one of `SETS`, such as "lafan1".
    clip : the name of a file, such as "walk1_subject1"; it may lie in any folder of the set.

    Raises
    ------
    MocapError : for an unknown set, a clip that is not there, with how to get it, and a file that is not the
        one listed.

    Examples
    --------
    >>> from_set("100style", "Nobody_FW")
    Traceback (most recent call last):
    mocap.errors.MocapError: No clip 'Nobody_FW' ...: `mocap data fetch 100style` gets the set (1469 MB) ...
    """
    from mocap.files.load_save import load

    folder = folder_of(name)
    named_set = SETS[name]
    show_once(named_set.terms())
    path = clips_of(name).get(clip)
    if path is None:
        gets = f"`mocap data fetch {name}` gets the set ({named_set.size()}) from {named_set.address}"
        raise MocapError(f"No clip '{shortened(clip, 40)}' in {folder}: {gets}, or unpack it there.")
    if clip in HASHES and hashlib.sha256(path.read_bytes()).hexdigest() != HASHES[clip]:
        raise MocapError(f"{path} is not the file listed: its checksum differs. Get it anew.")
    return load(path)
