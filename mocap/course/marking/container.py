"""Marking in a container, if that is asked for: the whole command runs there, without a network.

The image is made once for each version, from the package as it is installed here. The hand-ins are mounted so
that they can be read only, the folder of the marks so that it can be written, and nothing else of this
computer. The walls of this system are kept up inside as well, as far as the container lets them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import mocap
from mocap._shared.atomic import make_folder
from mocap.course.student_wheel import EXTRA, students_wheel
from mocap.errors import MocapError

ENGINES = ("podman", "docker")  # the first one that is installed is used
IMAGE = f"mocap-marking:{mocap.__version__}"
LIMITS = ("--memory", "5g", "--pids-limit", "128", "--cpus", "2", "--tmpfs", "/tmp:size=1g,exec")
RIGHTS = ("--network", "none", "--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges")
SAME_USER = {"podman": ["--userns", "keep-id"]}  # of engines that run without root's rights
FEEDBACK = "--feedback"  # the option that names a folder to write
INSIDE = "/marking"  # the folder in which the places of this computer are mounted
RECIPE = """FROM python:{python}-slim
COPY {wheel} /wheel/
RUN pip install --no-cache-dir "/wheel/{wheel}[{extra}]"
"""


def mark_in_container(
    read: Mapping[str, Path | None],
    written: Mapping[str, Path | None],
    options: Sequence[str],
    tell: Callable[[str], object] = str,
) -> int:
    """Run `mocap course mark` in a container, and return its exit status.

    Parameters
    ----------
    read : the folder of hand-ins at "", and files to read, by the options that name them.
    written : files and folders to write, by the options that name them.
    options : further words of the command.
    tell : gets a sentence before the image is made, and one before it runs.

    Raises
    ------
    MocapError : if there is no container engine, or the image cannot be made.
    """
    engine = _engine()
    if _run([engine, "image", "inspect", IMAGE]).returncode:
        tell(f"making the image {IMAGE} with {engine}, which takes minutes, once for each version")
        _build(engine)
    tell(f"marking in a container of {engine}: notebooks see no file of this computer but the hand-ins")
    mounts, words = _places(read, written)
    user = f"{os.getuid()}:{os.getgid()}"
    account = ["--env", "HOME=/tmp", "--user", user, *SAME_USER.get(engine, [])]
    command = [engine, "run", "--rm", *RIGHTS, *LIMITS, *account, *mounts, IMAGE]
    marking = ["mocap", "course", "mark", *words, *options]
    return subprocess.run([*command, *marking], check=False).returncode


def _engine() -> str:
    """Return the name of a container engine that is installed and answers."""
    installed = [engine for engine in ENGINES if shutil.which(engine)]
    for engine in installed:
        if _run([engine, "info"]).returncode == 0:
            return engine
    reason = f"{' and '.join(installed)} do not answer" if installed else "neither podman nor docker is here"
    raise MocapError(f"Marking in a container needs an engine, but {reason}: install or start one.")


def _build(engine: str) -> None:
    """Make the image from a wheel of this package, with the solutions, which students do not reach."""
    name, wheel = students_wheel(lambda file: file.read_text("utf-8"))
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, name).write_bytes(wheel)
        Path(folder, "Dockerfile").write_text(RECIPE.format(python=python, wheel=name, extra=EXTRA))
        building = _run([engine, "build", "--tag", IMAGE, folder])
    if building.returncode:
        last = building.stderr.decode(errors="replace").strip().splitlines()[-1:]
        raise MocapError(f"{engine} cannot make the image {IMAGE}: {''.join(last)}"[:200])


def _places(
    read: Mapping[str, Path | None], written: Mapping[str, Path | None]
) -> tuple[list[str], list[str]]:
    """Return the options that mount places, and the words that name them inside."""
    mounts: list[str] = []
    words: list[str] = []
    for option, place in _named(read):
        inside = f"{INSIDE}/read{len(mounts)}/{place.name}"
        mounts += _mount(place, inside, ",readonly")
        words += [option, inside] if option else [inside]
    for option, place in _named(written):
        is_folder = option == FEEDBACK
        folder = place if is_folder else place.parent
        make_folder(folder)
        inside = f"{INSIDE}/written{len(mounts)}"
        mounts += _mount(folder, inside, "")
        words += [option, inside if is_folder else f"{inside}/{place.name}"]
    return mounts, words


def _named(places: Mapping[str, Path | None]) -> list[tuple[str, Path]]:
    """List the options that are given, each with its whole path."""
    return [(option, place.resolve()) for option, place in places.items() if place is not None]


def _mount(place: Path, inside: str, access: str) -> list[str]:
    """Return the option that mounts a place."""
    if "," in f"{place}":
        raise MocapError(f"A container cannot mount {place}: choose a path without a comma.")
    return ["--mount", f"type=bind,source={place},target={inside}{access}"]


def _run(command: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    """Run a command and keep what it prints."""
    return subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, check=False)
