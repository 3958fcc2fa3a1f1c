"""What is known of each named set: its licence, where it is, and which joints its hips and legs are."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mocap.errors import MocapError, shortened

if TYPE_CHECKING:
    from mocap.body.limbs import Leg
    from mocap.body.skeleton import Skeleton

_TABLES = tomllib.loads(Path(__file__).with_name("sets.toml").read_text("utf-8"))


class Archive(NamedTuple):
    """A .zip of all clips: its address, its size in megabytes, and its SHA-256 where it is known."""

    url: str
    megabytes: int | None = None
    sha256: str | None = None


class NamedSet(NamedTuple):
    """A set of clips; `sets.toml` says what the fields are."""

    title: str
    licence: str
    allows: str
    address: str
    archive: Archive
    fps: float
    hips: str
    legs: list[str]
    clip_url: str = ""

    def find_legs(self, skeleton: Skeleton) -> tuple[Leg, Leg]:
        """Give the left and the right leg of a body of this set."""
        from mocap.body.limbs import name_leg  # the command line lists the sets without numpy

        right = [name.replace("Left", "Right").replace("_L", "_R") for name in self.legs]
        return name_leg(skeleton, *self.legs), name_leg(skeleton, *right)

    def terms(self) -> str:
        """Say whose clips they are, under which licence, and what that allows."""
        return f"These clips come from {self.title} ({self.address}), under {self.licence}: {self.allows}."

    def size(self) -> str:
        """Say how large the archive is."""
        return f"{self.archive.megabytes} MB" if self.archive.megabytes else "some hundred MB"


SETS = {
    name: NamedSet(**known | {"archive": Archive(**known["archive"])})
    for name, known in _TABLES["sets"].items()
}
"""The sets by the names of their folders."""

HASHES: dict[str, str] = _TABLES["clips"]


def known(name: str) -> NamedSet:
    """Give what is known of a set.

    Raises
    ------
    MocapError : for an unknown set.

    Examples
    --------
    >>> known("100style").terms()
    "These clips come from the 100STYLE dataset ... under CC BY 4.0: free with the authors' names."
    >>> known("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    if name not in SETS:
        raise MocapError(f"No set '{shortened(name, 40)}' is known; there are: {', '.join(SETS)}.")
    return SETS[name]
