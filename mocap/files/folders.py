"""Which motion files there are: named ones, and those in folders."""

from collections.abc import Sequence
from pathlib import Path

from mocap._shared.atomic import UNFINISHED
from mocap._shared.progress import Progress
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.files.amass import is_amass
from mocap.files.load_save import load

FORMATS = (".amc", ".bvh", ".npz")  # suffixes of the motion files that are found in folders


def is_clip(path: Path) -> bool:
    """Check whether a file holds a motion, by its suffix; an `.npz` may hold a graph or anything else.

    Examples
    --------
    >>> is_clip(Path("walk.BVH")), is_clip(Path("walk.asf")), is_clip(Path("graph.npz"))
    (True, False, False)
    """
    suffix = path.suffix.lower()
    return suffix in FORMATS and (suffix != ".npz" or is_amass(path))


def find_files(paths: Sequence[Path], *, deep: bool = False) -> list[Path]:
    """List files, and every motion file of folders.

    Parameters
    ----------
    paths : files and folders.
    deep : whether to look into the folders inside the folders, too.

    Raises
    ------
    MocapError : for a folder without such files, or one that cannot be read.

    Examples
    --------
    >>> find_files([Path("walk.amc"), Path("run.bvh")]) == [Path("walk.amc"), Path("run.bvh")]
    True
    """
    found: list[Path] = []
    for path in paths:
        try:
            within = path.rglob("*") if deep else path.iterdir()
            clips = (p for p in within if UNFINISHED not in str(p) and p.is_file() and is_clip(p))
            inside = sorted(clips) if path.is_dir() else [path]
        except OSError as error:
            raise MocapError(f"Cannot read {path}: {error.strerror}.") from error
        if not inside:
            raise MocapError(f"The folder {path} holds no .amc, .bvh or AMASS .npz file.")
        found += inside
    return found


def load_all(
    paths: Sequence[Path], *, skeleton: Path | None, scale: float | None, progress: Progress
) -> list[Motion]:
    """Load files, and every motion file of folders.

    Parameters
    ----------
    paths : as for `find_files`.
    skeleton, scale : as for `load`.
    progress : wraps the files while they are read.

    Raises
    ------
    MocapError, FormatError : as for `load` and `find_files`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     load_all([Path(folder)], skeleton=None, scale=None, progress=iter)
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder ... holds no .amc, .bvh or AMASS .npz file.
    """
    return [load(path, skeleton=skeleton, scale=scale) for path in progress(find_files(paths))]
