"""Read and write motions, whatever the format: the suffix of the file's name decides."""

import math
from pathlib import Path

from mocap import acclaim, amc, bvh
from mocap.errors import MocapError
from mocap.motion import Motion
from mocap.skeleton import Skeleton


def load(
    path: str | Path,
    *,
    skeleton: str | Path | None = None,
    fps: float | None = None,
    scale: float | None = None,
) -> Motion:
    """Read a motion from an `.amc` or `.bvh` file.

    Parameters
    ----------
    path : the file; capital letters in its suffix are fine.
    skeleton : for `.amc`, the `.asf` file of its skeleton. By default the one beside it that fits: of the
        same name, else of the name up to the first `_` (`16.asf` for `16_15.amc`), else the only one.
    fps : frames a second. An `.amc` tells none, and by default has 120 as most of the CMU database; for
        `.bvh` this goes before what the file says.
    scale : metres in one unit of the file; by default 0.01 for `.bvh`, and what the skeleton says for `.amc`.

    Returns
    -------
    The motion, named after the file.

    Raises
    ------
    MocapError : for a file that is missing or of another format, or when no skeleton fits.
    FormatError : for a file that breaks its format; it names the line.

    Examples
    --------
    >>> load("walk.fbx")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read walk.fbx: mocap reads .amc (with .asf) and .bvh.
    """
    path = Path(path)
    _check("fps", fps)
    _check("scale", scale)
    match path.suffix.lower():
        case ".amc":
            asf = _skeleton_for(path) if skeleton is None else Path(skeleton)
            return acclaim.read_amc(path, acclaim.read_skeleton(asf, scale=scale), fps=fps or 120.0)
        case ".bvh":
            return bvh.read(path, scale=scale or 0.01, fps=fps)
        case ".asf":
            raise MocapError(f"{path} is a skeleton without a motion: load_skeleton reads it.")
    raise MocapError(f"Cannot read {path}: mocap reads .amc (with .asf) and .bvh.")


def load_skeleton(path: str | Path) -> Skeleton:
    """Read a skeleton from an `.asf` file.

    Parameters
    ----------
    path : the file.

    Returns
    -------
    The joints, in metres.

    Raises
    ------
    MocapError, FormatError : as for `load`.

    Examples
    --------
    >>> load_skeleton("walk.amc")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read a skeleton from walk.amc: give an .asf file.
    """
    if Path(path).suffix.lower() != ".asf":
        raise MocapError(f"Cannot read a skeleton from {path}: give an .asf file.")
    return acclaim.read_skeleton(path).skeleton


def save(motion: Motion, path: str | Path, *, scale: float | None = None) -> None:
    """Write a motion to a `.bvh` file; a file that exists is replaced once the new one is whole.

    Marks (labels and contacts) have no place in the format and are left out.

    Parameters
    ----------
    motion : F frames.
    path : the file.
    scale : metres in one unit of the file, by default 0.01.

    Raises
    ------
    MocapError : for another format, a missing folder, or what the format cannot hold.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> still = Motion(bone, [[0, 0, 0]], [[[1, 0, 0, 0], [1, 0, 0, 0]]], 30.0)
    >>> with TemporaryDirectory() as folder:
    ...     save(still, f"{folder}/still.bvh")
    ...     load(f"{folder}/still.bvh")
    Motion('still', 1 frames at 30 Hz, 2 joints)
    """
    _check("scale", scale)
    if Path(path).suffix.lower() != ".bvh":
        raise MocapError(f"Cannot write {path}: mocap writes only .bvh yet.")
    bvh.write(motion, path, scale=scale or 0.01)


def _check(name: str, value: float | None) -> None:
    if value is not None and not (math.isfinite(value) and value > 0):
        raise MocapError(f"{name} must be a number above 0, got {value}.")


def _skeleton_for(path: Path) -> Path:
    """Choose among the `.asf` files beside an AMC file."""
    counts = amc.first_frame(path)
    beside = sorted(file for file in path.parent.iterdir() if file.suffix.lower() == ".asf")
    fitting = [file for file in beside if _fits(file, counts)]
    for stem in (path.stem, path.stem.split("_")[0]):
        for file in fitting:
            if file.stem.lower() == stem.lower():
                return file
    if len(fitting) == 1:
        return fitting[0]
    found = ", ".join(file.name for file in fitting or beside) or "no .asf file"
    problem = "several fit" if fitting else "none fits"
    raise MocapError(
        f"Which skeleton {path} has is not clear; beside it, {problem} ({found}): name it by skeleton=."
    )


def _fits(file: Path, counts: dict[str, int]) -> bool:
    try:
        asf = acclaim.read_skeleton(file)
    except MocapError:
        return False
    return amc.fits(counts, asf.dofs(), asf.needed())
