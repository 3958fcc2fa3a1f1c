"""The motion files that are read: one table, which `load_save`, folders, messages and the command share.

A new format is a line of `READ` and a reader above it. A reader imports its module when it is called, so that
the help of the command can print the table without NumPy.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mocap.errors import FormatError, MocapError, Remedy

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

    skeleton = options.skeleton or skeleton_beside(path)
    return acclaim.read(path, asf.read_skeleton(skeleton, scale=options.scale), fps=options.fps)


def skeleton_beside(path: Path) -> Path:
    """Choose among the `.asf` files in the folder of an AMC file the one whose bones fit its first frame.

    That of the same name comes first, then that of the name up to the first `_`, then the only one that fits.

    Raises
    ------
    FormatError : where none fits, or several do and none has such a name.
    """
    from mocap.files import acclaim, asf
    from mocap.files.text import read_text

    counts = acclaim.first_frame(read_text(path, most=100_000))
    skeletons = sorted(file for file in path.parent.iterdir() if file.suffix.lower() == ".asf")
    fitting = []
    for file in skeletons:
        with suppress(MocapError):
            if acclaim.fits(counts, asf.read_skeleton(file)):
                fitting.append(file)
    stems = (path.stem.lower(), path.stem.lower().split("_")[0])
    named = [file for stem in stems for file in fitting if file.stem.lower() == stem]
    if named or len(fitting) == 1:
        return (named or fitting)[0]
    names = ", ".join(file.name for file in fitting or skeletons)
    problem = "none"
    if skeletons:
        problem = f"{'several that fit' if fitting else 'none that fits'} ({names})"
    raise FormatError(
        path, None, "its .asf file beside it", problem, remedy=Remedy("name it by {}", "skeleton")
    )


def read_bvh(path: Path, options: ReadOptions) -> Recording:
    """Read a BVH file, by default in centimetres."""
    from mocap.files import bvh

    scale = options.scale or bvh.SCALE
    return bvh.read(path, scale=scale, fps=options.fps, stretch=options.stretch)


def read_npz(path: Path, options: ReadOptions) -> Recording:
    """Read an AMASS archive, which is in metres."""
    from mocap.files import amass

    if options.scale not in (None, 1.0):
        problem = f"All .npz files are in metres, got a scale of {options.scale:g} for {path}."
        raise MocapError(problem, remedy=Remedy("leave out {}", "scale"))
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
