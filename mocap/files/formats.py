"""The formats of motion files that can be read, in a table used by `load_save`, folders, errors and commands.

A new format takes a row of `READ` and a reader above it. A reader imports its module when it is called, so
that the help of the command can print the table without NumPy.
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
    """The options of `load`, of which a reader uses those that apply to its format.

    skeleton : the file of the skeleton, for formats with separate skeletons.
    fps : frames per second, which replace those of the file.
    scale : metres in one unit of the file.
    stretch : the largest change of the length of a bone, metres.
    """

    skeleton: Path | None
    fps: float | None
    scale: float | None
    stretch: float


class Format(NamedTuple):
    """A format that can be read: its `name` in messages, and its reader."""

    name: str
    read: Callable[[Path, ReadOptions], Recording]


def read_amc(path: Path, options: ReadOptions) -> Recording:
    """Read an Acclaim motion and its skeleton, by default a matching `.asf` file in the same folder."""
    from mocap.files import acclaim, asf

    skeleton = options.skeleton or skeleton_beside(path)
    return acclaim.read(path, asf.read_skeleton(skeleton, scale=options.scale), fps=options.fps)


def skeleton_beside(path: Path) -> Path:
    """Find the `.asf` file in the folder of an AMC file whose bones match its first frame.

    The file of the same name is preferred, then that of the name up to the first `_`, then the only match.

    Raises
    ------
    FormatError : if there is no match, or several matches of which none has such a name.
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
"""The formats that can be read, by the lower-case suffix of their files."""


def listed(last: str = "and") -> str:
    """Format the names of the formats that can be read as an enumeration for a sentence.

    Examples
    --------
    >>> listed()
    '.amc (with .asf), ...'
    """
    *first, final = (form.name for form in READ.values())
    return f"{', '.join(first)} {last} {final}"
