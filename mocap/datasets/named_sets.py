"""Datasets of other laboratories, from a local copy or downloaded once."""

from __future__ import annotations

import hashlib
import os
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mocap._shared.atomic import UNFINISHED, write_file
from mocap._shared.progress import Progress
from mocap.datasets.downloads import kept_in, show_once
from mocap.datasets.partial_files import alone_in, keeping, sha256_of
from mocap.datasets.resumed_downloads import Listing, download
from mocap.datasets.unpacking import BadArchive, unpack
from mocap.errors import MocapError, shortened, warn

if TYPE_CHECKING:
    from mocap.body.motion import Motion

CENTIMETRE = 0.01  # metres: the unit of all sets, which have y up
WHOLE = "TERMS.txt"  # written once all clips of a dataset are unpacked
_TABLES = tomllib.loads(Path(__file__).with_name("sets.toml").read_text("utf-8"))


class NamedSet(NamedTuple):
    """A dataset; `sets.toml` describes the fields."""

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
        """Describe the owner, the licence, and the use that it allows."""
        return f"These clips come from {self.title} ({self.address}), under {self.licence}: {self.allows}."

    def size(self) -> str:
        """Format the size of the archive."""
        return f"{self.megabytes} MB" if self.megabytes else "some hundred MB"


SETS = {name: NamedSet(**row) for name, row in _TABLES["sets"].items()}
"""The datasets by the names of their folders."""

HASHES: dict[str, str] = _TABLES["clips"]


def folder_of(name: str) -> Path:
    """Return the folder of a dataset in the cache.

    Raises
    ------
    MocapError : for an unknown dataset.

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
    """Find the files of a dataset in its folder, by the names of their clips.

    Of several files with the same name, the first is returned.

    Raises
    ------
    MocapError : for an unknown dataset.
    """
    paths = (path for path in folder_of(name).rglob("*.bvh") if UNFINISHED not in str(path))
    return {path.stem: path for path in sorted(paths, reverse=True)}


def fetch_set(name: str, progress: Progress = iter) -> list[str]:
    """Download all clips of a dataset, unless they are in its folder. Its terms are printed first.

    The next call resumes an interrupted download. The archive is removed once all clips are unpacked. If no
    checksum is listed, that of each archive is stored in `<set>.zip.sha256`.

    Parameters
    ----------
    name : the dataset, one of `SETS`; `SETS[name].size()` is the size of its archive.
    progress : shows the progress of the download and of unpacking, as `tqdm.tqdm` does.

    Returns
    -------
    The names of the clips.

    Raises
    ------
    MocapError : for an unknown dataset, without a network or if the environment variable `MOCAP_OFFLINE` is
        set, for an archive that differs from the one listed or is implausible, and without permission to
        write or space on the disk.

    Warns
    -----
    MocapWarning : if an archive without a listed checksum differs from those downloaded before.

    Examples
    --------
    >>> fetch_set("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    folder = folder_of(name)
    if not (folder / WHOLE).exists():
        show_once(SETS[name].terms())
        packed = folder / f"{name}.zip"
        with keeping(packed):
            folder.mkdir(parents=True, exist_ok=True)
        with alone_in(folder):
            _fetch_and_unpack(name, packed, progress)
    return sorted(clips_of(name))


def _fetch_and_unpack(name: str, packed: Path, progress: Progress) -> None:
    """Download the archive of a dataset, unless it is there, unpack it in its folder, and remove it."""
    named_set = SETS[name]
    listing = Listing(named_set.archive, named_set.megabytes, named_set.sha256)
    at_hand = packed.exists()
    if at_hand:
        digest = _require_listed(packed, named_set)
    elif os.environ.get("MOCAP_OFFLINE"):
        raise MocapError(
            f"{name}/{packed.name} is not here, and MOCAP_OFFLINE forbids downloads: unset it, or put a copy "
            f"of {name}/{packed.name} into a folder that MOCAP_DATA names."
        )
    else:
        digest = download(listing, packed, progress)
    try:
        unpack(packed, packed.parent, progress)
    except BadArchive:
        if not at_hand:  # the next call downloads it again
            packed.unlink()
        raise
    except KeyboardInterrupt as interruption:
        interruption.add_note("The archive is kept: fetch again to unpack it.")
        raise
    if named_set.sha256 is None:
        _note_checksum(packed, digest)
    write_file(packed.parent / WHOLE, f"{named_set.terms()}\n")
    packed.unlink()


def _require_listed(packed: Path, named_set: NamedSet) -> str:
    """Return the checksum of an archive. Raise if it differs from that listed."""
    with keeping(packed):
        digest = sha256_of(packed)
    if named_set.sha256 not in (None, digest):
        raise MocapError(
            f"{packed} is not the file listed: its checksum differs. Delete it, and fetch again."
        )
    return digest


def _note_checksum(packed: Path, digest: str) -> None:
    """Add a checksum to those of the archives downloaded before, and warn if it differs from them.

    The format is that of `sha256sum`. It is not an error, because a host may pack the same clips again.
    """
    notes = packed.with_name(f"{packed.name}.sha256")
    earlier = notes.read_text("utf-8") if notes.exists() else ""
    if digest in earlier:
        return
    write_file(notes, f"{earlier}{digest}  {packed.name}\n")
    if earlier:
        warn(
            f"{packed.name} is not the file downloaded before: its host changed it, or packed it anew. "
            f"{notes.name} lists both checksums."
        )


def from_set(name: str, clip: str) -> Motion:
    """Read a clip of a dataset, from a local or downloaded copy. Its terms are printed once.

    Parameters
    ----------
    name : the dataset, one of `SETS`, such as "lafan1".
    clip : the name of a file in any folder of the dataset, such as "walk1_subject1".

    Raises
    ------
    MocapError : for an unknown dataset, a missing clip, with the command to download it, and a file with
        another checksum than listed.

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
    return load(path, scale=CENTIMETRE, up="y")
