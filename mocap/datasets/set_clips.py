"""Clips of named sets: from a copy of your own, or fetched once."""

from __future__ import annotations

import os
import re
import sys
from functools import cache
from pathlib import Path

from mocap._shared.atomic import make_folder, write_text
from mocap._shared.progress import Progress
from mocap.body.motion import Motion
from mocap.datasets.known_sets import known
from mocap.datasets.resumed_downloads import download
from mocap.datasets.unpacked_clips import check_clip, read_sums, unpack, write_sums
from mocap.errors import MocapError, shortened
from mocap.files.load_save import load

WHOLE = "TERMS.txt"  # written when all clips of a set are there


def folder_of(name: str) -> Path:
    """Give the folder in which a set is looked for, and into which it is fetched.

    Raises
    ------
    MocapError : for an unknown set.

    Examples
    --------
    >>> folder_of("lafan1").name
    'lafan1'
    """
    known(name)
    if os.environ.get("MOCAP_DATA"):
        return Path(os.environ["MOCAP_DATA"]) / name
    import pooch

    return Path(pooch.os_cache("mocap")) / name


def list_set(name: str) -> list[str]:
    """List the clips of a set that are at hand, by their files' names.

    Raises
    ------
    MocapError : for an unknown set.
    """
    return sorted(path.stem for path in folder_of(name).rglob("*.bvh"))


def fetch_set(name: str, progress: Progress = iter) -> list[str]:
    """Download all clips of a named set, unless they are at hand; its terms are printed first.

    A download that breaks off goes on from there at the next call. Where the checksum of the whole is known,
    it is checked; the checksum of each clip is kept, and a clip that changes later is refused.

    Parameters
    ----------
    name : the set, one of `SETS`; `SETS[name].size()` says how large it is.
    progress : shows how far it is, as `tqdm.tqdm` does.

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
    folder, archive = folder_of(name), known(name).archive
    packed = folder / f"{name}.zip"
    if not packed.exists():
        if (folder / WHOLE).exists() and all((folder / clip).exists() for clip in read_sums(folder)):
            return list_set(name)
        _show(known(name).terms())
        make_folder(folder)
        download(archive.url, packed, sha256=archive.sha256, progress=progress)
    clips = unpack(packed, folder, progress)
    write_text(folder / WHOLE, f"{known(name).terms()}\n")
    packed.unlink()
    return clips


def from_set(name: str, clip: str) -> Motion:
    """Read a clip of a named set, from your own copy or fetched; its terms are printed once.

    Parameters
    ----------
    name : the set, one of `SETS`, such as "lafan1".
    clip : the name of a file, such as "walk1_subject1"; it may lie in any folder of the set.

    Raises
    ------
    MocapError : for an unknown set, a clip that is not there, with how to get it, a clip that cannot be
        fetched, and a file that is not the one listed or not the one fetched first.

    Examples
    --------
    >>> from_set("100style", "Nobody_FW")
    Traceback (most recent call last):
    mocap.errors.MocapError: No clip 'Nobody_FW' ...: `mocap data fetch 100style` gets the set (1469 MB) ...
    """
    folder = folder_of(name)
    found = sorted(path for path in folder.rglob("*.bvh") if path.stem == clip)
    _show(known(name).terms())
    path = found[0] if found else _fetch_clip(name, clip)
    check_clip(path, path.read_bytes(), read_sums(folder))
    return load(path)


def _fetch_clip(name: str, clip: str) -> Path:
    """Download a single clip where the set shares clips singly."""
    folder, one = folder_of(name), known(name)
    named = re.fullmatch(r"dataset-([12])_[\w-]+", clip)
    if not one.clip_url or not named:
        raise MocapError(
            f"No clip '{shortened(clip, 40)}' in {folder}: `mocap data fetch {name}` gets the set "
            f"({one.size()}) from {one.address}, or unpack it there."
        )
    make_folder(folder)
    fetched = folder / f"{clip}.bvh.new"
    download(one.clip_url.format(part=named[1], clip=clip), fetched)
    path, sums = fetched.with_suffix(""), read_sums(folder)
    try:
        sums[path.name] = check_clip(path, fetched.read_bytes(), sums)
        write_sums(folder, sums)
        fetched.replace(path)
    finally:
        fetched.unlink(missing_ok=True)
    return path


@cache
def _show(terms: str) -> None:
    print(terms, file=sys.stderr)
