"""Walls around a student's process, kept up by the Linux kernel: what it can read, write, reach and call.

Both work without an administrator's rights, in containers as well, and each may be missing on a system:

- `landlock`: it reads Python, programs and libraries, and writes in its home; nothing else can be opened.
- `filter`: it opens no sockets, sends no signals, mounts nothing, changes nobody's rights to a file, and cuts
  none that it has not opened for writing, which Landlock before Linux 6.2 does not forbid.
"""

from __future__ import annotations

import ctypes
import errno
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
from mocap.errors import MocapError

ALL = ("landlock", "filter")
FILES, INODES = 500 << 20, 2000  # bytes and number of files in the home
LIMITS = {"AS": 2 << 30, "FSIZE": 50 << 20, "NOFILE": 256, "CORE": 0}  # bytes of memory, of a file; files
DIE_WITH_PARENT, SET_FILTER, ADOPT_ORPHANS, NO_NEW_RIGHTS = 1, 22, 36, 38  # of prctl(2)
RULESET, RULE, RESTRICT = 444, 445, 446  # numbers of system calls
READ, USE = 0b1101, 0b100000000000110  # of Landlock: execute, read and list; read, write and cut a file
SYSTEM = [f"/{name}" for name in ("usr", "lib", "lib32", "lib64", "bin", "sbin", "nix/store", "etc/fonts")]
SYSTEM += [f"/etc/{name}" for name in ("localtime", "ld.so.cache", "passwd", "group", "nsswitch.conf")]
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")
# kill, tkill, tgkill, rt_sigqueueinfo, rt_tgsigqueueinfo, prlimit64, ptrace, process_vm_readv and _writev;
# socket, memfd_create, shmget, mq_open, truncate; unshare, setns, mount, umount2, pivot_root, chroot;
# add_key, request_key, keyctl, bpf, perf_event_open
X86 = [62, 200, 234, 129, 297, 302, 101, 310, 311, 41, 319, 29, 240, 76, 272, 308, 165, 166, 155, 161]
ARM = [129, 130, 131, 138, 240, 261, 117, 270, 271, 198, 279, 194, 180, 45, 97, 268, 40, 39, 41, 51]
# pidfd_send_signal, io_uring_setup, open_tree, move_mount, fsopen, openat2, pidfd_getfd, mount_setattr
BOTH = [424, 425, 428, 429, 430, 437, 438, 442]
# chmod, chown, utime and setxattr, and their kin: they seem to succeed, because much copies a file by them
DENIED = {
    "x86_64": (
        0xC000003E,
        [*X86, 248, 249, 250, 321, 298, *BOTH],
        [*range(90, 95), 260, 268, 452, 132, 235, 261, 280, *range(188, 191)],
    ),
    "aarch64": (0xC00000B7, [*ARM, 217, 218, 219, 280, 241, *BOTH], [*range(52, 56), 88, *range(5, 8), 452]),
}
FLAGS = {"x86_64": ((257, 32), (2, 24)), "aarch64": ((56, 32),)}  # of openat and open: where they stand


def require_sealing() -> None:
    """Raise where a student's code cannot run in a process that has limits and can be ended as a whole.

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
        _call("capset", struct.pack("II", 0x20080522, 0), bytes(24))  # not even root's
        for name, limit in LIMITS.items():
            with suppress(OSError, ValueError):  # not every system has all of them
                resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (limit, limit))
        if "landlock" in walls:
            _lock(home, readable(hidden))
        if "filter" in walls:
            _filter()
        work()
        status = 0
    finally:
        os._exit(status)


def prctl(option: int, *values: int | bytes) -> None:
    """Set an option of this process, where it is Linux."""
    _call("prctl", option, *values, 0, 0, 0)


def _call(name: str, *arguments: int | bytes | None) -> int:
    """Call a function of the C library that Python has no name for; where it is not Linux, give 0."""
    given = [ctypes.c_long(one) if isinstance(one, int) else one for one in arguments]
    result = int(ctypes.CDLL(None, use_errno=True)[name](*given)) if sys.platform == "linux" else 0
    if result < 0:
        raise OSError(ctypes.get_errno(), name)
    return result


def _lock(home: Path, places: Iterable[Path]) -> None:
    """Open only these places for reading, and the home for writing; call no server, signal nobody outside.

    Raises
    ------
    OSError : where there is no Landlock, or one before Linux 6.2, but no filter to keep files from being cut.
    """
    version = _call("syscall", RULESET, None, 0, 1)
    if version < 3:
        _filter()
    rights = (1 << (min(version + 12, 15) + (version >= 5))) - 1
    made = struct.pack("QQQ", rights, 0b11, 0b11)[: 8 * (1 + (version >= 4) + (version >= 6))]
    rules = _call("syscall", RULESET, made, len(made), 0)
    allowed = dict.fromkeys(places, READ) | dict.fromkeys(map(Path, DEVICES), USE)
    allowed[home] = rights & ~0b100001000000  # but make no devices
    for place, right in allowed.items():
        with suppress(FileNotFoundError):
            at = os.open(place, os.O_PATH)
            own = struct.pack("=Qi", rights & (right if place.is_dir() else right & (USE | 1)), at)
            _call("syscall", RULE, rules, 1, own, 0)
            os.close(at)
    _call("syscall", RESTRICT, rules, 0)
    os.close(rules)


def readable(hidden: Sequence[str]) -> list[Path]:
    """List what a student's process may read: Python, this package, programs and libraries.

    A checkout of this package is on Python's path for the package's sake; the rest of it is left out.

    Examples
    --------
    >>> Path("/dev") in readable([])
    False
    """
    package, kept_out = Path(mocap.__file__).parent, [Path(place).resolve() for place in hidden]
    path = [place for place in map(Path, sys.path) if place != package.parent or "-packages" in place.name]
    places = {Path(f"{each}").resolve() for each in (sys.prefix, sys.base_prefix, *path, package, *SYSTEM)}
    return [part for place in places for part in _without(place, kept_out)]


def _without(place: Path, hidden: Sequence[Path]) -> Iterable[Path]:
    """Yield the largest folders at and below a place that hold none of the hidden ones."""
    if not any(other.is_relative_to(place) for other in hidden):
        yield place
    elif place not in hidden:
        for part in place.iterdir():
            if not part.is_symlink():  # which may lead to what is hidden
                yield from _without(part, hidden)


def _filter() -> None:
    """Refuse the system calls `DENIED` to this process and what it starts, and to cut a file opened to read.

    Raises
    ------
    OSError : where the kernel has no filters, or their numbers are unknown.
    """
    if sys.platform != "linux" or platform.machine() not in DENIED:
        raise OSError("no filter for this machine")
    machine, numbers, without_effect = DENIED[platform.machine()]
    allow, fail, pretend = 0x7FFF0000, 0x50000 | errno.EPERM, 0x50000
    program = [(0x20, 0, 0, 4), (0x15, 1, 0, machine), (0x06, 0, 0, fail)]  # fail, if for another machine
    program += [(0x20, 0, 0, 0), (0x35, 0, 1, 1 << 30), (0x06, 0, 0, fail)]
    for answer, group in ((fail, numbers), (pretend, without_effect)):
        program += [step for one in group for step in ((0x15, 0, 1, one), (0x06, 0, 0, answer))]
    for one, flags in FLAGS[platform.machine()]:  # O_TRUNC may not go with O_RDONLY, nor 3, which is neither
        cut = [(0x20, 0, 0, flags), (0x54, 0, 0, 0o1003), (0x15, 1, 0, 0o1000), (0x15, 0, 1, 0o1003)]
        program += [(0x15, 0, 6, one), *cut, (0x06, 0, 0, fail), (0x06, 0, 0, allow)]
    program += [(0x06, 0, 0, allow)]
    code = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *step) for step in program))
    prctl(SET_FILTER, 2, struct.pack("HxxxxxxQ", len(program), ctypes.addressof(code)))
