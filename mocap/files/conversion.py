"""Search for motion files in folders, and their conversion in parallel."""

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from mocap import files
from mocap._shared.atomic import UNFINISHED, make_folder
from mocap._shared.progress import Progress
from mocap.errors import MocapError
from mocap.files import formats

if TYPE_CHECKING:
    from mocap.body.motion import Motion

Result = TypeVar("Result")

MOST_WORKERS = 61  # processes of a pool; Windows cannot wait for more


def is_clip(path: Path) -> bool:
    """Return whether a file contains a motion, by its suffix and, for `.npz`, by its content.

    Examples
    --------
    >>> is_clip(Path("walk.BVH")), is_clip(Path("walk.asf")), is_clip(Path("graph.npz"))
    (True, False, False)
    """
    from mocap.files.motion_archives import is_motion  # the help of the command needs no NumPy

    suffix = path.suffix.lower()
    return suffix in formats.READ and (suffix != ".npz" or is_motion(path))


def find_files(paths: Iterable[Path]) -> list[Path]:
    """List files, and all motion files in folders and the folders inside them, except hidden ones.

    Parameters
    ----------
    paths : files and folders.

    Raises
    ------
    MocapError : for a folder without such files, or one that cannot be read.

    Examples
    --------
    >>> [path.name for path in find_files([Path("walk.amc"), Path("run.bvh")])]
    ['walk.amc', 'run.bvh']
    """
    clips: list[Path] = []
    for path in paths:
        try:
            inside = sorted(_motions_in(path)) if path.is_dir() else [path]
        except OSError as error:
            raise MocapError(f"Cannot read {path}: {error.strerror}.") from error
        if not inside:
            raise MocapError(f"The folder {path} holds no {formats.listed('or')} file.")
        clips += inside
    return clips


def _motions_in(folder: Path) -> Iterator[Path]:
    """Yield the motion files in a folder and the folders inside it."""
    next(folder.iterdir(), None)  # raises for a folder that cannot be read, which `rglob` leaves out
    for path in folder.rglob("*"):
        is_hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
        if not is_hidden and UNFINISHED not in str(path) and path.is_file() and is_clip(path):
            yield path


def names_apart(paths: Sequence[Path]) -> list[str]:
    """Name each motion file by its stem; files of one stem also by the folders in which they differ.

    Examples
    --------
    >>> names_apart([Path("01/walk.bvh"), Path("02/walk.bvh"), Path("02/run.bvh")])
    ['01-walk', '02-walk', 'run']
    """
    names = [path.stem for path in paths]
    for depth in range(2, max((len(path.parts) for path in paths), default=0) + 1):
        repeated = {name for name, count in Counter(names).items() if count > 1}
        for index, path in enumerate(paths):
            if names[index] in repeated:
                names[index] = "-".join(path.with_suffix("").parts[-depth:])
    return names


def plan(source: str | Path, target: str | Path, suffix: str = ".bvh") -> list[tuple[Path, Path]]:
    """Pair each motion file with the file to be written.

    Parameters
    ----------
    source : a file, or a folder, which is searched recursively.
    target : another file, or for a folder another folder, which gets the same subfolders.
    suffix : the format that is written for a folder.

    Raises
    ------
    MocapError : if there is nothing to convert, a file would replace one of the sources, or two files would
        have the same target.

    Examples
    --------
    >>> [(source.name, target.name) for source, target in plan("walk.amc", "walk.bvh")]
    [('walk.amc', 'walk.bvh')]
    """
    source = Path(source)
    target = Path(target)
    pairs = [(source, target)]
    if source.is_dir():
        clips = find_files([source])
        pairs = [(path, (target / path.relative_to(source)).with_suffix(suffix)) for path in clips]
    require_apart(pairs)
    return pairs


def require_apart(pairs: Sequence[tuple[Path, Path]], read: Iterable[Path] = ()) -> None:
    """Raise if two source files have the same target, or a target is one of the source files.

    Examples
    --------
    >>> require_apart([(Path("a/walk.bvh"), Path("walk.bvh")), (Path("b/walk.bvh"), Path("walk.bvh"))])
    Traceback (most recent call last):
    mocap.errors.MocapError: a/walk.bvh and b/walk.bvh would both become walk.bvh: take them one by one.
    """
    sources = {os.path.realpath(path) for path in (*read, *(path for path, _ in pairs))}
    sources_of: dict[Path, Path] = {}
    for path, new in pairs:
        if os.path.realpath(new) in sources:
            raise MocapError(f"{new} is one of the files to read: choose another name or folder.")
        first = sources_of.setdefault(new, path)
        if first != path:
            raise MocapError(f"{first} and {path} would both become {new}: take them one by one.")


def convert(
    pairs: Sequence[tuple[Path, Path]], load: Callable[[Path], "Motion"], *, progress: Progress = iter
) -> list[str]:
    """Convert files in parallel processes. An error in one file does not stop the others.

    Parameters
    ----------
    pairs : source and target files, from `plan`.
    load : a function that returns the motion of a file, such as `files.load`; it is sent to other processes.
    progress : wraps the pairs while they are converted, to show a progress bar.

    Returns
    -------
    An error message for each file that failed, with its name.

    Examples
    --------
    >>> convert([(Path("gone.amc"), Path("walk.bvh"))], files.load)
    ['Cannot read gone.amc: No such file or directory.']
    """
    return list(filter(None, run_in_processes(partial(_convert, load), pairs, progress=progress)))


def run_in_processes(
    work: Callable[..., Result], tasks: Sequence[tuple[Path, ...]], *, progress: Progress = iter
) -> list[Result]:
    """Call a function for each task in parallel processes; a single task is executed in this process.

    Parameters
    ----------
    work : the function. It is sent to other processes, as its results are sent back.
    tasks : the arguments of each call.
    progress : wraps the tasks while they are executed, to show a progress bar.

    Raises
    ------
    MocapError : if a process ends before its work is done.

    Examples
    --------
    >>> run_in_processes(Path.exists, [(Path("gone.amc"),)])
    [False]
    """
    if len(tasks) == 1:
        return [work(*tasks[0])]
    from concurrent.futures import BrokenExecutor, ProcessPoolExecutor  # imported here, because it is slow

    from mocap._shared.tasks import serve

    workers = min(len(tasks), os.cpu_count() or 1, MOST_WORKERS)
    with ProcessPoolExecutor(workers, initializer=serve) as pool:
        outcomes = pool.map(work, *zip(*tasks, strict=True))
        try:
            return [next(outcomes) for _ in progress(tasks)]
        except BrokenExecutor as error:
            raise MocapError("A worker was ended from outside: is there enough memory?") from error
        finally:  # after an interruption, pending tasks are not executed
            pool.shutdown(cancel_futures=True)


def _convert(load: Callable[[Path], "Motion"], source: Path, target: Path) -> str:
    """Convert a file. Return the error message, or "" if there is none."""
    try:
        motion = load(source)
        make_folder(target.parent)
        files.save(motion, target)
    except MocapError as error:
        named = any(str(path) in str(error) for path in (source, target))
        return str(error) if named else f"{source}: {error}"
    return ""
