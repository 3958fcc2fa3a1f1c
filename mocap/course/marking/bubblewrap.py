"""A third wall, where bubblewrap is installed: the keeper runs in namespaces of its own.

It sees no processes, no network, no queues and no files of the system but those that students' processes may
read, and a folder to write in. Landlock and the filter surround each student's process inside it.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from mocap.course.marking import walls

NAME = "bubblewrap"
PROGRAM = "bwrap"
STARTING = 60  # seconds in which a program that does nothing must have ended
LINKED = ("bin", "sbin", "lib", "lib32", "lib64")  # folders that are links into /usr on most systems
NAMESPACES = ("--unshare-all", "--die-with-parent", "--new-session")


def wrapped(
    command: Sequence[str], folder: Path, hidden: Sequence[str], environment: Mapping[str, str]
) -> list[str]:
    """Return a command that runs another one in bubblewrap; an empty one if that does not work here.

    Parameters
    ----------
    command : what to run; its first word must run with the one more argument `--version`.
    folder : where it may write.
    hidden : files and folders that it must not see.
    environment : variables of the command.

    Examples
    --------
    >>> wrapped(["no-such-program"], Path("/tmp"), [], {})
    []
    """
    if not shutil.which(PROGRAM):
        return []
    prefix = [PROGRAM, *NAMESPACES, *_places(folder, hidden), "--chdir", str(folder), "--"]
    trial = [*prefix, command[0], "--version"]
    try:
        tried = subprocess.run(trial, capture_output=True, env=environment, timeout=STARTING, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return []
    return [*prefix, *command] if tried.returncode == 0 else []


def _places(folder: Path, hidden: Sequence[str]) -> list[str]:
    """Return the options that show places inside: devices, processes, what is read, and the folder."""
    options = ["--dev", "/dev", "--proc", "/proc"]
    for place in [*walls.readable(hidden), Path("/etc/alternatives")]:
        options += ["--ro-bind-try", str(place), str(place)]
    for link in (Path("/", name) for name in LINKED):
        if link.is_symlink():
            options += ["--symlink", str(link.readlink()), str(link)]
    return [*options, "--bind", str(folder), str(folder)]
