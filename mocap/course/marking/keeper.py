"""The keeper of the students' processes: it starts each from a copy of itself, and kills all that it started.

The marker starts `python -m mocap.course.marking.keeper` once, with a socket as its standard input. The
keeper imports what notebooks import and never runs a student's code: so a student's process, which is a copy
of it made by `fork`, starts at once, with the package as it was before the first notebook. For each byte with
a socket that the marker sends, the keeper starts such a process on that socket, in a new home. At the next
byte, even if that is the end because the marker was killed, it ends all, removes the home, and writes back
why it had to stop the process before. On Linux it adopts the orphans among its descendants, so that none can
leave it.
"""

from __future__ import annotations

import gc
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from importlib import import_module
from itertools import islice
from pathlib import Path

from mocap.course.marking import walls

MEMORY = 4 << 30  # bytes of all processes of a student
PROCESSES = 16  # of a student, at a time
WATCHING = 0.1  # seconds between two looks at a student's processes
KILLING = 20  # seconds after which processes that cannot be killed are left alone
BLOCK = 512  # bytes, in which `os.stat` counts what a file takes
COMMON = ("matplotlib.pyplot", "scipy.optimize", "networkx", "mocap.plotting", "mocap.widgets")
OURS = ("marking.student", "checks.inputs", "diagrams", "lab.own")


def keep(control: socket.socket) -> None:
    """Read which walls to raise and what to hide; write which can be raised; run a process on each socket."""
    folder = Path(os.environ["HOME"]).parent
    wanted, hidden = json.loads(control.makefile().readline())
    walls.prctl(walls.ADOPT_ORPHANS, 1)
    forked = {name: walls.fork_behind([name], folder, hidden, int) for name in wanted}
    raised = [name for name, child in forked.items() if os.waitpid(child, 0)[1] == 0]
    control.sendall(f"{' '.join(raised)}\n".encode())
    try:
        while True:
            message, channels, _, _ = socket.recv_fds(control, 1, 1)
            if not message:  # the marker has ended
                break
            for module in (*COMMON, *(f"mocap.course.{name}" for name in OURS)):  # once, and if at all
                import_module(module)
            gc.freeze()
            for channel in channels:
                home = Path(tempfile.mkdtemp(prefix="student-", dir=folder))  # of a name that nobody knows
                student = walls.fork_behind(raised, home, hidden, partial(_serve, channel, home))
                os.close(channel)
                reason = _watch(control, student, home)
                _kill_all(student)
                remove(home)
                control.sendall(f"{reason}\n".encode())
    finally:
        remove(folder)


def remove(folder: Path) -> None:
    """Remove a folder, also with folders in it that may not be listed, or are deeper than Python can go.

    Examples
    --------
    >>> remove(Path("nowhere"))
    """
    if folder.exists():
        subprocess.run(["chmod", "-R", "u+rwX", folder], check=False)
        subprocess.run(["rm", "-rf", folder], check=False)


def _serve(channel: int, home: Path) -> None:
    """Hold nothing but the socket, print nowhere, and serve the marker."""
    from mocap.course.marking.student import serve

    os.environ |= dict.fromkeys(("HOME", "TMPDIR"), str(home))
    tempfile.tempdir = str(home)

    standard_streams = (0, 1, 2)
    channel = os.dup2(channel, len(standard_streams))
    os.closerange(channel + 1, os.sysconf("SC_OPEN_MAX"))
    null = os.open(os.devnull, os.O_RDWR)
    for stream in standard_streams:
        os.dup2(null, stream)
    os.chdir(home)
    sys.path.insert(0, str(home))
    with os.fdopen(channel, "rb") as requests, os.fdopen(os.dup(channel), "wb") as replies:
        serve(requests, replies)


def _watch(control: socket.socket, student: int, home: Path) -> str:
    """Wait for the end of the student's process or of the marker; return why it has to be stopped, if so."""
    while not select.select([control], [], [], WATCHING)[0]:
        if _has_ended(student):
            return ""
        if excess := _excess(home):
            return excess
    return ""


def _has_ended(student: int) -> bool:
    """Reap all children that have ended, orphans too; return whether the student's process is one of them."""
    while ended := os.waitpid(-1, os.WNOHANG)[0]:
        if ended == student:
            return True
    return False


def _excess(home: Path) -> str:
    """Return which limit the student's processes together exceed, if any."""
    memory = [*_descendants(os.getpid())]
    if len(memory) > PROCESSES:
        return f"starts more than {PROCESSES} processes"
    if sum(memory) > MEMORY:
        return f"takes more than {MEMORY >> 30} GB of memory"
    sizes = [*islice(_sizes(home), walls.INODES)]
    if len(sizes) == walls.INODES or sum(sizes) > walls.FILES:
        return f"writes {walls.INODES} files, or more than {walls.FILES >> 20} MB"
    return ""


def _children(pid: int) -> list[int]:
    """List the processes that a process started, or adopted; none where it is not Linux."""
    with suppress(OSError):  # it has ended
        files = Path(f"/proc/{pid}/task").glob("*/children")
        return [int(child) for file in files for child in file.read_text().split()]
    return []


def _descendants(pid: int) -> Iterator[int]:
    """Yield the bytes of memory of each descendant."""
    page = os.sysconf("SC_PAGE_SIZE")
    for child in _children(pid):
        with suppress(OSError):
            yield int(Path(f"/proc/{child}/statm").read_text().split()[1]) * page
        yield from _descendants(child)


def _sizes(home: Path) -> Iterator[int]:
    """Yield the bytes of all files in a folder, however deep; `os.walk` calls itself at each level."""
    folders = [f"{home}"]
    while folders:
        with suppress(OSError), os.scandir(folders.pop()) as entries:  # it is gone
            for entry in entries:
                if entry.is_dir(follow_symlinks=False):
                    folders.append(entry.path)
                yield BLOCK * entry.stat(follow_symlinks=False).st_blocks


def _kill_all(student: int) -> None:
    """Kill the student's process group, and children until there are none: orphans become children."""
    deadline = time.monotonic() + KILLING
    with suppress(ChildProcessError):
        while time.monotonic() < deadline:
            for kill, pid in [(os.killpg, student), *((os.kill, child) for child in _children(os.getpid()))]:
                with suppress(OSError):
                    kill(pid, signal.SIGKILL)
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


if __name__ == "__main__":
    keep(socket.socket(fileno=0))
