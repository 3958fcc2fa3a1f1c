"""Clips that commands read together: what is left out, what they are called, and the space of all."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mocap.errors import MocapError, warn
from mocap.files.conversion import names_apart

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.files.recordings import Recording

SHOWN_PROBLEMS = 3  # files that are left out, each with its reason; the others are counted


def read_found(
    read: "Callable[[Path], Recording]",
    paths: Iterable[Path],
    named: Sequence[Path],
    options: Mapping[str, str],
) -> "tuple[list[Recording], list[Path]]":
    """Read the files that `find_files` found; one in a folder that cannot be read is left out.

    Parameters
    ----------
    read : reads a file.
    paths : the files.
    named : the files and folders that the user named; a file that is named must be readable.
    options : the names of options, by parameters, for errors.

    Returns
    -------
    The recordings, and their files.

    Raises
    ------
    MocapError : for a file that the user named, or when no file can be read.

    Warns
    -----
    MocapWarning : for each of the first files that are left out, and how many more there are.
    """
    recordings: list[Recording] = []
    files_read: list[Path] = []
    problems: list[MocapError] = []
    for path in paths:
        try:
            recordings.append(read(path))
            files_read.append(path)
        except MocapError as error:
            if path in named:
                raise
            problems.append(error)
    if problems and not recordings:
        raise problems[0]
    for problem in problems[:SHOWN_PROBLEMS]:
        warn(f"Left out: {problem.worded(options)}")
    if len(problems) > SHOWN_PROBLEMS:
        count = len(problems) - SHOWN_PROBLEMS
        warn(f"Left out: {count} more files that cannot be read; mocap info --json says why.")
    return recordings, files_read


def named_apart(recordings: "Sequence[Recording]", paths: Sequence[Path]) -> "list[Motion]":
    """Return the motions, named as their files are, and by their folders if several files have one name."""
    names = names_apart(paths)
    return [replace(recording.motion, name=name) for recording, name in zip(recordings, names, strict=True)]


def warn_of_space(path: Path, recording: "Recording", options: Mapping[str, str]) -> None:
    """State the space that a clip was read in, if it is unusual or in doubt, and the body of several."""
    for notice in recording.notices(options):
        warn(f"{path}: {notice}")


def warn_of_spaces(
    paths: Sequence[Path], recordings: "Sequence[Recording]", options: Mapping[str, str]
) -> None:
    """State the space of clips that were read together, once for each skeleton."""
    skeletons = set()
    for path, recording in zip(paths, recordings, strict=True):
        if recording.motion.skeleton.names not in skeletons:
            skeletons.add(recording.motion.skeleton.names)
            warn_of_space(path, recording, options)
