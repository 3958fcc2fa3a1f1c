"""Licences of clips: those that a user states, and those of known data sets."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from mocap.datasets.clip_origins import LONGEST_LICENCE, Origin
from mocap.errors import MocapError, shortened

COLUMNS = ("clip", "licence")
NON_COMMERCIAL = re.compile(r"\bNC\b|non-?\s?commercial|not for commercial", re.IGNORECASE)
CMU = "the terms of mocap.cs.cmu.edu: free for all uses, but not to sell the data"


def known_licence(path: Path) -> str:
    """Return the licence of a file that belongs to a known data set, or "".

    A file is identified by its content, or by the folder into which `mocap data fetch` unpacked it.

    Examples
    --------
    >>> known_licence(Path(__file__))
    ''
    """
    from mocap.datasets.cmu_database import is_listed
    from mocap.datasets.named_sets import HASHES, SETS, folder_of
    from mocap.datasets.partial_files import sha256_of

    folders = [folder.resolve() for folder in path.resolve().parents]
    for name, row in SETS.items():
        if folder_of(name).resolve() in folders:
            return row.licence
    digest = sha256_of(path)
    if digest == HASHES.get(path.stem):
        return SETS["bandai_namco"].licence
    return CMU if is_listed(path.name, digest) else ""


def read_licences(path: Path, names: Sequence[str]) -> dict[str, str]:
    """Read the licences of clips from a `.csv` file with the columns clip and licence.

    Parameters
    ----------
    path : the file.
    names : the names of the clips. A row for another clip is refused.

    Raises
    ------
    MocapError, FormatError : as for `files.named_tables.read_table`, and for unknown clips.
    """
    from mocap.files.named_tables import read_table

    licences = {}
    for row in read_table(path, COLUMNS):
        clip = row.cells["clip"]
        if clip not in names:
            shown = shortened(", ".join(names), 80)
            raise MocapError(f"{path}, line {row.line}: no clip is called '{clip[:40]}'; there are: {shown}.")
        licences[clip] = row.cells["licence"]
    return licences


def with_licences(
    origins: Sequence[Origin], names: Sequence[str], stated: str | Mapping[str, str]
) -> list[Origin]:
    """Return origins with the licences of their clips.

    Parameters
    ----------
    origins, names : the files of clips, and the names of the clips.
    stated : the licence of all clips, or those of some clips by name. A clip without one has that of the data
        set to which its file belongs, or "".

    Raises
    ------
    MocapError : for a licence of more than 200 characters.

    Examples
    --------
    >>> [origin] = with_licences([Origin(Path("walk.bvh"))], ["walk"], "CC0")
    >>> origin.licence
    'CC0'
    """
    chosen = []
    for origin, name in zip(origins, names, strict=True):
        licence = stated if isinstance(stated, str) else stated.get(name, "")
        if len(licence) > LONGEST_LICENCE:
            raise MocapError(f"A licence has at most {LONGEST_LICENCE} characters, got {len(licence)}.")
        if not licence and origin.path.is_file():
            licence = known_licence(origin.path)
        chosen.append(origin._replace(licence=licence))
    return chosen


def is_non_commercial(licence: str) -> bool:
    """Return whether a licence excludes commercial use, by its wording.

    Examples
    --------
    >>> [is_non_commercial(text) for text in ("CC BY-NC-ND 4.0", "CC BY 4.0", "for non-commercial use", "")]
    [True, False, True, False]
    """
    return NON_COMMERCIAL.search(licence) is not None
