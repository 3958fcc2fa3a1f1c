"""Walls around a student's process, kept up by the Linux kernel: what it can read, write, reach and call.

Both work without an administrator's rights, in containers as well, and each may be missing on a system:

- `landlock`: it reads Python, programs and libraries, and writes in its home; nothing else can be opened.
- `filter`: it makes the system calls of `system_calls` only. It opens no sockets, sends no signals, changes
  no priorities, leaves no messages, mounts nothing, changes nobody's rights to a file, and cuts none that it
  has not opened for writing, which Landlock before Linux 6.2 does not forbid.

`bubblewrap` can put a third wall around both.
"""

from __future__ import annotations

import ctypes
import os
import platform
import signal
import socket
import struct
import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

import mocap
from mocap.course.marking.call_filter import STEP, call_filter
from mocap.course.marking.system_calls import MACHINES
from mocap.errors import MocapError

ALL = ("landlock", "filter")
FILES = 500 << 20  # bytes of all files in the home
INODES = 2000  # files and folders in the home
LIMITS = {
    "AS": 2 << 30,  # bytes of memory
    "FSIZE": 50 << 20,  # bytes of a file
    "NOFILE": 256,  # open files
    "CORE": 0,  # bytes of memory that are written when the process crashes
}

# <linux/prctl.h>: options of a process.
DIE_WITH_PARENT = 1
SET_FILTER = 22
ADOPT_ORPHANS = 36
NO_NEW_RIGHTS = 38
BY_PROGRAM = 2  # for SET_FILTER: a filter in BPF
CAPABILITIES_VERSION = 0x20080522  # <linux/capability.h>

# Numbers of Landlock's system calls, on all machines.
RULESET = 444
RULE = 445
RESTRICT = 446

# <linux/landlock.h>
ASK_VERSION = 1
BENEATH_PATH = 1  # the kind of a rule for a folder or file

EXECUTE = 1 << 0
WRITE_FILE = 1 << 1
READ_FILE = 1 << 2
READ_FOLDER = 1 << 3
MAKE_CHARACTER_DEVICE = 1 << 6
MAKE_BLOCK_DEVICE = 1 << 11
FIRST_RIGHTS = (1 << 13) - 1  # those of version 1
REFER = 1 << 13  # move or link a file to another folder
TRUNCATE = 1 << 14
CONTROL_DEVICE = 1 << 15
RIGHTS_SINCE = {1: FIRST_RIGHTS, 2: REFER, 3: TRUNCATE, 5: CONTROL_DEVICE}  # by version

TCP = 0b11  # bind and connect
SCOPES = 0b11  # abstract Unix sockets, and signals
TRUNCATE_SINCE = 3  # version of Landlock, in Linux 6.2
TCP_SINCE = 4
SCOPES_SINCE = 6

READ = EXECUTE | READ_FILE | READ_FOLDER
USE = READ_FILE | WRITE_FILE | TRUNCATE
OF_A_FILE = USE | EXECUTE  # other rights are those of folders

SYSTEM = [f"/{name}" for name in ("usr", "lib", "lib32", "lib64", "bin", "sbin", "nix/store", "etc/fonts")]
SYSTEM += [f"/etc/{name}" for name in ("localtime", "ld.so.cache", "passwd", "group", "nsswitch.conf")]
SYSTEM += ["/etc/mime.types"]  # of Python's `mimetypes`
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")


def require_sealing() -> None:
    """Raise if a student's code cannot run in a process that has limits and can be ended as a whole.

    The limits are those of `resource`, the process starts by `fork`, and its socket is sent to it. Windows
    and the Python of a browser have none of the three.

    Raises
    ------
    MocapError : if one of them is missing. No notebook runs without them.

    Examples
    --------
    >>> require_sealing()
    """
    if not (hasattr(os, "fork") and hasattr(socket, "send_fds") and find_spec("resource")):
        raise MocapError(
            "Marking seals each student's code by means that this system lacks: run it on Linux or macOS, on"
            " Windows in WSL, or in a container."
        )


def fork_behind(walls: Sequence[str], home: Path, hidden: Sequence[str], work: Callable[[], object]) -> int:
    """Fork a process that raises walls and then works; it does not work where one cannot be raised.

    Parameters
    ----------
    walls : some of `ALL`.
    home : the folder where it may write.
    hidden : files and folders that it must not read.
    work : what it does.

    Returns
    -------
    The number of the process; it dies with this one, and ends with 0 if the work is done.
    """
    import resource  # Windows has none, and is refused by `require_sealing`

    if child := os.fork():
        return child
    status = 1
    try:
        os.setsid()
        with suppress(OSError):  # where memory is short, Linux ends this process first
            Path("/proc/self/oom_score_adj").write_text("1000")
        prctl(DIE_WITH_PARENT, signal.SIGKILL)
        prctl(NO_NEW_RIGHTS, 1)
        _call("capset", struct.pack("II", CAPABILITIES_VERSION, 0), bytes(24))  # no rights, not even root's
        for name, limit in LIMITS.items():
            with suppress(OSError, ValueError):  # not every system has all of them
                resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (limit, limit))
        needs_filter = "filter" in walls
        if "landlock" in walls:
            version = _lock(home, readable(hidden), listable(hidden))
            needs_filter = needs_filter or version < TRUNCATE_SINCE
        if needs_filter:
            _filter()
        work()
        status = 0
    finally:
        os._exit(status)


def prctl(option: int, *values: int | bytes) -> None:
    """Set an option of this process, where it is Linux."""
    _call("prctl", option, *values, 0, 0, 0)


def _call(name: str, *arguments: int | bytes | None) -> int:
    """Call a function of the C library that Python has no name for; return 0 if the system is not Linux."""
    if sys.platform != "linux":
        return 0
    passed = [ctypes.c_long(value) if isinstance(value, int) else value for value in arguments]
    result = int(ctypes.CDLL(None, use_errno=True)[name](*passed))
    if result < 0:
        raise OSError(ctypes.get_errno(), name)
    return result


def _lock(home: Path, places: Iterable[Path], listed: Iterable[Path]) -> int:
    """Open only these places for reading, and the home for writing; call no server, signal nobody outside.

    Before Linux 6.2 Landlock keeps no file from being cut, which needs the filter.

    Parameters
    ----------
    home : the folder to write in.
    places : files and folders to read.
    listed : folders whose names may be listed, in which only some files may be read.

    Returns
    -------
    The version of Landlock.

    Raises
    ------
    OSError : where there is no Landlock.
    """
    version = _call("syscall", RULESET, None, 0, ASK_VERSION)
    rights = sum(right for since, right in RIGHTS_SINCE.items() if since <= version)
    handled = [rights]  # `struct landlock_ruleset_attr`: all that is forbidden where no rule allows it
    if version >= TCP_SINCE:
        handled.append(TCP)
    if version >= SCOPES_SINCE:
        handled.append(SCOPES)
    attributes = struct.pack(f"{len(handled)}Q", *handled)
    rules = _call("syscall", RULESET, attributes, len(attributes), 0)
    allowed = dict.fromkeys(listed, READ_FOLDER) | dict.fromkeys(places, READ)
    allowed |= dict.fromkeys(map(Path, DEVICES), USE)
    allowed[home] = rights & ~(MAKE_CHARACTER_DEVICE | MAKE_BLOCK_DEVICE)
    for place, right in allowed.items():
        with suppress(FileNotFoundError, PermissionError):  # what one cannot open needs no rule
            _allow(rules, place, rights & right)
    _call("syscall", RESTRICT, rules, 0)
    os.close(rules)
    return version


def _allow(rules: int, place: Path, rights: int) -> None:
    """Add a rule of Landlock: these rights for a folder and all that is in it, or for a file."""
    descriptor = os.open(place, os.O_PATH)
    applicable = rights if place.is_dir() else rights & OF_A_FILE
    rule = struct.pack("=Qi", applicable, descriptor)  # `struct landlock_path_beneath_attr`
    _call("syscall", RULE, rules, BENEATH_PATH, rule, 0)
    os.close(descriptor)


def readable(hidden: Sequence[str]) -> list[Path]:
    """List the places that a student's process may read: Python, this package, programs and libraries.

    A checkout of this package is on Python's path for the package's sake; the rest of it is left out.

    Examples
    --------
    >>> Path("/dev") in readable([])
    False
    """
    kept_out = [Path(place).resolve() for place in hidden]
    return [part for place in _needed() for part in _without(place, kept_out)]


def listable(hidden: Sequence[str]) -> list[Path]:
    """List the folders above hidden places, in which Python must find the modules beside them.

    Examples
    --------
    >>> listable([])
    []
    """
    above = {folder for place in hidden for folder in Path(place).resolve().parents}
    return [folder for folder in sorted(above) if any(map(folder.is_relative_to, _needed()))]


def _needed() -> set[Path]:
    """Return the places that a student's process needs: Python, this package, programs and libraries.

    The current folder may be on Python's path, but is that of the teacher.
    """
    package = Path(mocap.__file__).parent
    of_others = (package.parent, Path.cwd())
    path = [place for place in map(Path, filter(None, sys.path)) if _is_library(place, of_others)]
    needed: list[str | Path] = [sys.prefix, sys.base_prefix, *path, package, *SYSTEM]
    return {Path(place).resolve() for place in needed}


def _is_library(place: Path, of_others: Sequence[Path]) -> bool:
    """Return whether a folder of Python's path holds libraries only."""
    return place.resolve() not in of_others or "-packages" in place.name


def _without(place: Path, hidden: Sequence[Path]) -> Iterable[Path]:
    """Yield the largest folders at and below a place that hold none of the hidden ones."""
    if not any(hidden_place.is_relative_to(place) for hidden_place in hidden):
        yield place
    elif place not in hidden:
        for part in place.iterdir():
            if not part.is_symlink():  # which may lead to what is hidden
                yield from _without(part, hidden)


def _filter() -> None:
    """Raise `call_filter` around this process and what it starts.

    Raises
    ------
    OSError : where the kernel has no filters, or their numbers are unknown.
    """
    if sys.platform != "linux" or platform.machine() not in MACHINES:
        raise OSError("no filter for this machine")
    program = call_filter(platform.machine())
    memory = ctypes.create_string_buffer(program)
    steps = len(program) // STEP
    prctl(SET_FILTER, BY_PROGRAM, struct.pack("HxxxxxxQ", steps, ctypes.addressof(memory)))
