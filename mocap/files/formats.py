"""The motion files that are read: one table, which `load_save`, folders, messages and the command share.

A new format is a line of `READ` and a reader above it. A reader imports its module when it is called, so that
the help of the command can print the table without NumPy.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mocap.errors import MocapError

if TYPE_CHECKING:
    from mocap.files.recordings import Recording


class ReadOptions(NamedTuple):
    """The options of `load`; a reader uses those that its format has, and refuses what it cannot obey.

    skeleton : the file of the skeleton, for formats that have one.
    fps : frames per second, which replace those of the file.
    scale : metres in one unit of the file.
    stretch : metres by which bones may change their lengths.
    """

    skeleton: Path | None
    fps: float | None
    scale: float | None
    stretch: float


class Format(NamedTuple):
    """A format that is read: its `name` in messages, and its reader."""

    name: str
    read: Callable[[Path, ReadOptions], Recording]


def read_amc(path: Path, options: ReadOptions) -> Recording:
    """Read an Acclaim motion and its skeleton, by default the `.asf` file beside it that fits."""
    from mocap.files import acclaim, asf

    skeleton = options.skeleton or acclaim.skeleton_beside(path)
    return acclaim.read(path, asf.read_skeleton(skeleton, scale=options.scale), fps=options.fps)


def read_bvh(path: Path, options: ReadOptions) -> Recording:
    """Read a BVH file, by default in centimetres."""
    from mocap.files import bvh

    scale = options.scale or bvh.SCALE
    return bvh.read(path, scale=scale, fps=options.fps, stretch=options.stretch)


def read_npz(path: Path, options: ReadOptions) -> Recording:
    """Read an AMASS archive, which is in metres."""
    from mocap.files import amass

    if options.scale not in (None, 1.0):
        raise MocapError(f"All .npz files are in metres: leave out scale={options.scale:g}.")
    return amass.read(path, fps=options.fps)


READ: dict[str, Format] = {
    ".amc": Format(".amc (with .asf)", read_amc),
    ".bvh": Format(".bvh", read_bvh),
    ".npz": Format("AMASS .npz", read_npz),
}
"""The formats that are read, by the suffix of their files in small letters."""


def listed(last: str = "and") -> str:
    """List the names of the formats that are read, as in a sentence.

    Examples
    --------
    >>> listed()
    '.amc (with .asf), ...'
    """
    *first, final = (form.name for form in READ.values())
    return f"{', '.join(first)} {last} {final}"
