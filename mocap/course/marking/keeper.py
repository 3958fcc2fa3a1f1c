"""The keeper of a student's process: it sets the limits, and at the end kills all that it started.

The marker starts `python -m mocap.course.marking.keeper`, which forks: the child is the student's process.
The marker holds the keeper's standard input; when that closes, even because the marker was killed, the keeper
ends all. On Linux it adopts the orphans among its descendants, so that none can leave it.
"""

from __future__ import annotations

import ctypes
import os
import resource
import select
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

MEMORY = 2 << 30  # bytes of a process; all together may hold twice that
PROCESSES = 16
FILE, FILES = 50 << 20, 500 << 20  # bytes of a file, and of all in the folder
MOST = 2000  # files
LIMITS = {"RLIMIT_AS": MEMORY, "RLIMIT_FSIZE": FILE, "RLIMIT_NOFILE": 256, "RLIMIT_CORE": 0}
LINUX = sys.platform == "linux"
DIE_WITH_PARENT, ADOPT_ORPHANS, NO_NEW_RIGHTS = 1, 36, 38  # of prctl(2)
NEW_USER, NEW_NET = 0x10000000, 0x40000000  # of unshare(2)


def keep(channel: int, *, offline: bool) -> None:
    """Run a student's process on a socket, and write to standard output why it was stopped, if it was.

    Parameters
    ----------
    channel : the number of the open socket.
    offline : whether the process has no network; if that cannot be, it does not run.
    """
    _prctl(ADOPT_ORPHANS, 1)
    student = os.fork()
    if not student:
        _be_student(channel, offline)
    os.close(channel)
    why = _watch(student)
    _kill_all(student)
    os.write(1, why.encode())


def _prctl(option: int, value: int) -> None:
    if LINUX:
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def cut_off() -> None:
    """Leave the network: from here on this process and its children see none, not even this machine's own.

    Linux gives the process a network of its own, which leads nowhere, and for the right to that a table of
    users in which it is what it was before. Sockets that are files can still be opened.

    Raises
    ------
    OSError : where the system does not allow it, or is not Linux.
    """
    if not LINUX:
        raise OSError("no namespaces here")
    user, group = os.getuid(), os.getgid()
    if ctypes.CDLL(None, use_errno=True).unshare(NEW_USER | NEW_NET):
        raise OSError(ctypes.get_errno(), "unshare")
    own = Path("/proc/self")
    (own / "setgroups").write_text("deny")
    (own / "uid_map").write_text(f"{user} {user} 1")
    (own / "gid_map").write_text(f"{group} {group} 1")


def _be_student(channel: int, offline: bool) -> None:
    """Take the limits, print nowhere, get no new rights, and serve the marker; never return."""
    os.setpgid(0, 0)
    try:
        if offline:
            cut_off()
        _prctl(DIE_WITH_PARENT, signal.SIGKILL)
        _prctl(NO_NEW_RIGHTS, 1)
        nothing = os.open(os.devnull, os.O_RDWR)
        for standard in (0, 1, 2):
            os.dup2(nothing, standard)
        for name, limit in LIMITS.items():
            with suppress(OSError, ValueError):  # not every system has all of them
                resource.setrlimit(getattr(resource, name), (limit, limit))
        from mocap.course.marking.student import serve

        with os.fdopen(channel, "rb") as requests, os.fdopen(os.dup(channel), "wb") as replies:
            serve(requests, replies)
    finally:
        os._exit(0)


def _watch(student: int) -> str:
    """Wait for the end of the student's process or of the marker; return why it has to be stopped, if so."""
    while not select.select([0], [], [], 0.1)[0]:
        if student in _reap():
            return ""
        family = _descendants()
        if len(family) > PROCESSES:
            return f"starts more than {PROCESSES} processes"
        if sum(family.values()) > 2 * MEMORY:
            return f"takes more than {2 * MEMORY >> 30} GB of memory"
        sizes = _sizes()
        if len(sizes) == MOST or sum(sizes) > FILES:
            return f"writes {MOST} files, or more than {FILES >> 20} MB"
    return ""


def _reap() -> set[int]:
    ended: set[int] = set()
    with suppress(ChildProcessError):
        while (pid := os.waitpid(-1, os.WNOHANG)[0]) != 0:
            ended.add(pid)
    return ended


def _descendants() -> dict[int, int]:
    """Return the descendants of this process and their bytes of memory; nothing where /proc is missing."""
    parents, sizes = {}, {}
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended
            pid, fields = int(folder.name), (folder / "stat").read_text("latin-1").rpartition(")")[2].split()
            parents[pid], sizes[pid] = int(fields[1]), int(fields[21]) * resource.getpagesize()
    family = {os.getpid()}
    while more := {pid for pid, parent in parents.items() if parent in family} - family:
        family |= more
    return {pid: sizes[pid] for pid in family - {os.getpid()} if pid in sizes}


def _sizes() -> list[int]:
    """Return the bytes on disk of the files in this folder and those in it, up to the most there may be."""
    sizes: list[int] = []
    for place, _, names in os.walk("."):
        for name in names[: MOST - len(sizes)]:
            with suppress(OSError):  # it is gone
                sizes.append(512 * os.lstat(f"{place}/{name}").st_blocks)
    return sizes


def _kill_all(student: int) -> None:
    """Kill the student's process group, and all descendants until none is left."""
    with suppress(OSError):
        os.killpg(student, signal.SIGKILL)
    for _ in range(500):
        _reap()
        family = _descendants()
        for pid in family:
            with suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        if not family:
            return
        time.sleep(0.01)


if __name__ == "__main__":
    if sys.argv[1] == "cut_off":
        cut_off()
    else:
        keep(int(sys.argv[1]), offline="offline" in sys.argv)
