"""Clips that commands read together: what is left out, what they are called, and the space of all.

The space of a clip is its unit and its vertical axis. `files.clip_sets` decides which files belong together,
and the space of each set. A command that changes one clip after the other does not keep them all in memory:
it reads them twice, first for `surveyed_spaces`.
"""

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from mocap._shared.progress import Progress
from mocap.errors import MocapError, MocapWarning, warn
from mocap.files.conversion import names_apart, run_in_processes
from mocap.files.formats import has_fixed_space

if TYPE_CHECKING:
    from mocap.body.motion import Motion
    from mocap.files.clip_sets import Hierarchy, SetMember
    from mocap.files.recordings import Recording
    from mocap.files.spaces import Space

Spaces = Mapping[Path, "Space | None"]
"""The space of each file; None for one whose format or user says it, and for one that shows none."""


Choices = tuple[float, str, str | None]
"""The scale, the axis that points up, and the use of the root's offset, as `Space.choices` returns them."""


class Read(Protocol):
    """A function that reads a file, in a space if one is given, and otherwise as its frames show."""

    def __call__(self, path: Path, space: "Space | None" = None) -> "Recording":
        """Read a file."""
        ...


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


def read_set(
    read: Read, paths: Iterable[Path], named: Sequence[Path], options: Mapping[str, str]
) -> "tuple[list[Recording], list[Path]]":
    """Read files as `read_found` does, those that belong together in one space, which is stated.

    Parameters
    ----------
    read : reads a file.
    paths, named, options : as for `read_found`.
    """
    from mocap.files.clip_sets import agree, agreed_spaces, set_member  # the help needs no NumPy

    recordings, files_read = read_found(read, paths, named, options)
    for path, recording in zip(files_read, recordings, strict=True):
        warn_of_bodies(path, recording, options)
    members = [set_member(recording) for recording in recordings]
    spaces = agreed_spaces(members)
    recordings = agree(recordings, spaces, lambda number, space: read(files_read[number], space))
    _warn_of_spaces(files_read, members, spaces, options)
    return recordings, files_read


def surveyed_spaces(
    read: Read, paths: Sequence[Path], options: Mapping[str, str], *, progress: Progress = iter
) -> Spaces:
    """Decide and state the spaces of files that are read again later, those that belong together in one.

    Files that cannot be read have no space here: they are reported when they are read again.

    Parameters
    ----------
    read : reads a file; it is sent to other processes.
    paths : the files. A single one has the space that it shows, without being read here.
    options : the names of options, by parameters.
    progress : wraps the files while they are read, to show a progress bar.
    """
    from mocap.files.clip_sets import agreed_spaces  # the help needs no NumPy

    surveyed = [path for path in dict.fromkeys(paths) if not has_fixed_space(path)]
    if len(surveyed) < 2:
        return {}
    members = run_in_processes(partial(_survey, read), [(path,) for path in surveyed], progress=progress)
    spaces = agreed_spaces(members)
    _warn_of_spaces(surveyed, members, spaces, options)
    return dict(zip(surveyed, spaces, strict=True))


def _survey(read: Read, path: Path) -> "SetMember | None":
    """Return the content of a file on which the space of its set depends; None without any."""
    from mocap.files.clip_sets import set_member  # the help needs no NumPy

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)  # they are shown when the file is read again
        try:
            return set_member(read(path))
        except MocapError:
            return None


def warn_of_space(path: Path, recording: "Recording", options: Mapping[str, str]) -> None:
    """State the space that a clip was read in, if it is unusual or in doubt."""
    stated = recording.space.sentence(options) if recording.space else ""
    if stated:
        warn(f"{path}: {stated}")


def warn_of_bodies(path: Path, recording: "Recording", options: Mapping[str, str]) -> None:
    """State that the first of several bodies was read, if a file has several."""
    stated = recording.body_notice(options)
    if stated:
        warn(f"{path}: {stated}")


def _warn_of_spaces(
    paths: Sequence[Path],
    members: "Sequence[SetMember | None]",
    spaces: "Sequence[Space | None]",
    options: Mapping[str, str],
) -> None:
    """State the spaces of files in one line for each hierarchy, if they are unusual, in doubt, or differ."""
    of_hierarchy: dict[Hierarchy, dict[Space, list[Path]]] = {}
    for path, member, space in zip(paths, members, spaces, strict=True):
        if member is not None and space is not None:
            of_hierarchy.setdefault(member.hierarchy, {}).setdefault(space, []).append(path)
    for files in of_hierarchy.values():
        if len({space.choices() for space in files}) > 1:
            warn(_differing(files, options))
            continue
        for space, alike in files.items():
            stated = space.sentence(options)
            if stated:
                warn(f"{_listed(alike)}: {stated}")


def _differing(files: "Mapping[Space, Sequence[Path]]", options: Mapping[str, str]) -> str:
    """State the different spaces of files of one hierarchy: each is read as it is by itself."""
    alike: dict[Choices, list[Path]] = {}
    spaces: dict[Choices, Space] = {}
    for space, paths in files.items():
        alike.setdefault(space.choices(), []).extend(paths)
        spaces.setdefault(space.choices(), space)
    clauses = [f"{_listed(paths)} as {spaces[choice].clause()}" for choice, paths in alike.items()]
    remedy = next(iter(files)).overruled_by(options)
    return f"Clips of the same joints are read differently: {', and '.join(clauses)}. {remedy}"


def _listed(paths: Sequence[Path]) -> str:
    """Name the first of some files, and count the others.

    Examples
    --------
    >>> _listed([Path("a.bvh"), Path("b.bvh"), Path("c.bvh")])
    'a.bvh and 2 more'
    """
    return f"{paths[0]} and {len(paths) - 1} more" if len(paths) > 1 else f"{paths[0]}"
