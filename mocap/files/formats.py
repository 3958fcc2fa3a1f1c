"""The formats of motion files, in tables used by `load_save`, folders, errors and commands.

A new format to read takes a row of `READ` and a reader above it. A reader imports its module when it is
called, so that the help of the command can print the table without NumPy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mocap.errors import FormatError, MocapError, Remedy, shortened
from mocap.files.read_options import ReadOptions

if TYPE_CHECKING:
    from mocap.files.recordings import Recording


class Format(NamedTuple):
    """A format that can be read: its `name` in messages, and its reader."""

    name: str
    read: Callable[[Path, ReadOptions], Recording]


def read_amc(path: Path, options: ReadOptions) -> Recording:
    """Read an Acclaim motion and its skeleton, by default a matching `.asf` file in the same folder."""
    from mocap.files import acclaim, asf

    if options.up not in (None, "y"):
        problem = f"All .amc files have y up, got {options.up} up for {path}."
        raise MocapError(problem, remedy=Remedy("leave out {}", "up"))
    _require_single_body(path, options)
    skeleton = options.skeleton or skeleton_beside(path)
    return acclaim.read(path, asf.read_skeleton(skeleton, scale=options.scale), fps=options.fps)


def skeleton_beside(path: Path) -> Path:
    """Find the `.asf` file in the folder of an AMC file whose bones match its first frame.

    Of several that fit, that with the longest name with which the motion's name begins is taken: `HDM_bd.asf`
    for `HDM_bd_walk_001.amc`, `16.asf` for `16_15.amc`.

    Raises
    ------
    FormatError : if there is no match, with the first difference, or several matches of which none has such a
        name.
    """
    from mocap.files import acclaim, asf
    from mocap.files.text import read_text

    counts = acclaim.first_frame(read_text(path, most=100_000))
    skeletons = sorted(file for file in path.parent.iterdir() if file.suffix.lower() == ".asf")
    skeletons.sort(key=lambda file: -len(file.stem) if begins(path.stem, file.stem) else 0)
    differences = {}
    for file in skeletons:
        with suppress(MocapError):
            skeleton = asf.read_skeleton(file)
            missing = acclaim.missing_bones(counts, skeleton)
            differences[file] = (acclaim.difference(counts, skeleton), len(missing))
    fewest = min((missing for difference, missing in differences.values() if not difference), default=0)
    fitting = [file for file, result in differences.items() if result == ("", fewest)]
    if len(fitting) == 1 or (fitting and begins(path.stem, fitting[0].stem)):
        return fitting[0]
    names = ", ".join(file.name for file in fitting or skeletons)
    problem = "none"
    if fitting:
        problem = f"several that fit ({names})"
    elif skeletons:
        reasons = [f"{file.name} has {difference}" for file, (difference, _) in differences.items()]
        problem = f"none that fits ({shortened((reasons or [names])[0], 70)})"
    raise FormatError(
        path, None, "its .asf file beside it", problem, remedy=Remedy("name it by {}", "skeleton")
    )


def begins(name: str, beginning: str) -> bool:
    """Check whether a name begins with whole words of another, whatever the case.

    Examples
    --------
    >>> begins("HDM_bd_walk_001", "hdm_bd"), begins("16_15", "16"), begins("161_5", "16")
    (True, True, False)
    """
    rest = name.lower().removeprefix(beginning.lower())
    return name.lower().startswith(beginning.lower()) and not rest[:1].isalnum()


def has_fixed_space(path: Path) -> bool:
    """Return whether the format of a file says its unit and its vertical axis.

    Examples
    --------
    >>> has_fixed_space(Path("walk.amc")), has_fixed_space(Path("walk.bvh"))
    (True, False)
    """
    return path.suffix.lower() == ".amc"


def read_bvh(path: Path, options: ReadOptions) -> Recording:
    """Read a BVH file."""
    from mocap.files import bvh

    return bvh.read(path, options)


def read_npz(path: Path, options: ReadOptions) -> Recording:
    """Read an archive of AMASS or mocap, which is in metres."""
    from mocap.files import motion_archives

    if options.scale not in (None, 1.0):
        problem = f"All .npz files are in metres, got a scale of {options.scale:g} for {path}."
        raise MocapError(problem, remedy=Remedy("leave out {}", "scale"))
    _require_single_body(path, options)
    return motion_archives.read(path, fps=options.fps, up=options.up)


def _require_single_body(path: Path, options: ReadOptions) -> None:
    """Raise if another body than the first is asked of a format that has one."""
    if options.body not in (None, 1):
        problem = f"{path} holds 1 body, as all {path.suffix.lower()} files do, got {options.body}."
        raise MocapError(problem, remedy=Remedy("leave out {}", "body"))


READ: dict[str, Format] = {
    ".amc": Format(".amc (with .asf)", read_amc),
    ".bvh": Format(".bvh", read_bvh),
    ".npz": Format(".npz (AMASS, mocap)", read_npz),
}
"""The formats that can be read, by the lower-case suffix of their files."""

WRITTEN = (".bvh", ".glb", ".npz", ".csv")
"""The suffixes of the formats that `save` writes."""


_BY_BLENDER = "in Blender, import it and export Motion Capture (.bvh) first"
_MARKERS = "markers have no bones: solve a skeleton first, and export it as .bvh"
_PICKLE = "a pickle may run code: save poses, trans and mocap_framerate by numpy.savez as an .npz first"
_POSITIONS = "positions alone have no bones: fit a body to them first, such as SMPL (an AMASS .npz)"
_TABLE = "a table of positions has no rotations: export or save the motion itself first, as .bvh or .npz"

OTHERS: dict[str, str] = dict.fromkeys(
    (".fbx", ".gltf", ".dae", ".usd", ".usda", ".usdc", ".usdz", ".vrma"), _BY_BLENDER
)
OTHERS |= dict.fromkeys((".zip", ".7z", ".rar", ".gz", ".tar", ".tgz", ".bz2"), "unpack it (unzip) first")
OTHERS |= dict.fromkeys((".c3d", ".trc"), _MARKERS)
OTHERS |= dict.fromkeys((".pkl", ".pickle", ".pt", ".pth"), _PICKLE)
OTHERS |= {".npy": _POSITIONS, ".csv": _TABLE, ".glb": f"mocap only writes it; {_BY_BLENDER}"}
OTHERS |= {".blend": "open it in Blender and export Motion Capture (.bvh) first"}
OTHERS |= {".vmd": "in Blender, import it with MMD Tools and export Motion Capture (.bvh) first"}
OTHERS |= {".bip": "in 3ds Max, save the Biped's motion as .bvh first"}
"""What to do with files of other formats that hold motions, by suffix in small letters."""


def listed(last: str = "and") -> str:
    """Format the names of the formats that can be read as an enumeration for a sentence.

    Examples
    --------
    >>> listed()
    '.amc (with .asf), ...'
    """
    return enumerated([form.name for form in READ.values()], last)


def enumerated(names: Sequence[str], last: str = "or") -> str:
    """Format names as an enumeration for a sentence.

    Examples
    --------
    >>> enumerated([".bvh", ".glb", ".npz"]), enumerated([".html"])
    ('.bvh, .glb or .npz', '.html')
    """
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
