"""What each wall around a student's process keeps it from, and what it leaves alone."""

import ctypes
import errno
import os
import platform
import signal
import socket
import struct
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

import pytest

from mocap.course.marking import walls
from mocap.course.marking.sealed import protection

fcntl = pytest.importorskip("fcntl", reason="only Linux has these walls")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has these walls")
OURS = os.getpid()
FIOSETOWN = 0x8901  # <asm-generic/sockios.h>


def succeeds(raised, home, hidden, work):
    """Say whether a process behind walls does some work without an error."""
    return os.waitpid(walls.fork_behind(raised, home, [str(hidden)], work), 0)[1] == 0


@cache
def holds(wall):
    return succeeds([wall], Path("/var"), "/var", int)


def require(wall):
    if not holds(wall):
        pytest.skip(f"this system has no {wall}")


def library(name, *arguments):
    if ctypes.CDLL(None)[name](*arguments) < 0:
        raise OSError(name)


def changed(file, work):
    before = file.stat()
    work()
    assert (before.st_mode, before.st_mtime) != (file.stat().st_mode, file.stat().st_mtime)


@pytest.fixture(autouse=True)
def room(monkeypatch):
    """Leave a forked test process as much room beyond what it has already as a student's process has."""
    pages = Path("/proc/self/statm")
    used = int(pages.read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") if pages.exists() else 0
    monkeypatch.setitem(walls.LIMITS, "AS", used + walls.LIMITS["AS"])


@pytest.fixture
def place(tmp_path, monkeypatch):
    for name in ("home", "hidden"):
        (tmp_path / name).mkdir()
    (tmp_path / "hidden" / "file").write_text("1")
    (tmp_path / "file").write_text("1")
    (tmp_path / "alone").write_text("1")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as server:
        monkeypatch.chdir(tmp_path)  # a socket's path has 107 characters
        server.bind("server")
        yield tmp_path


def attempts(place):
    """List what a process might do outside of its home: by name, the work and the walls that forbid it."""
    file, hidden = place / "file", place / "hidden" / "file"
    return {
        "read": (file.read_text, "landlock"),
        "read what is hidden": (hidden.read_text, "landlock"),
        "read a hidden file": (lambda: 1 / len((place / "alone").read_text()), "landlock"),
        "list": (lambda: [*place.iterdir()], "landlock"),
        "write": (lambda: file.write_text("2"), "landlock"),
        "make": (lambda: (place / "new").write_text("2"), "landlock"),
        "cut": (lambda: os.truncate(file, 0), "landlock filter"),
        "cut by reading": (lambda: os.open(file, os.O_RDONLY | os.O_TRUNC), "landlock filter"),
        "cut by doing neither": (lambda: os.open(file, 3 | os.O_TRUNC), "landlock filter"),
        "remove": (file.unlink, "landlock"),
        "rename": (lambda: file.rename(place / "home" / "mine"), "landlock"),
        "link": (lambda: os.link(file, place / "other"), "landlock"),
        "share memory": (lambda: Path("/dev/shm", f"planted-{OURS}").write_text(""), "landlock"),
        "read another's memory": (lambda: Path(f"/proc/{OURS}/environ").read_bytes(), "landlock"),
        "signal": (lambda: os.kill(OURS, 0), "filter"),
        "trace": (lambda: library("ptrace", 16, OURS, 0, 0), "filter landlock"),
        "call a server": (lambda: socket.create_connection(("127.0.0.1", PORT)), "landlock filter"),
        "make a socket": (lambda: socket.socket(socket.AF_UNIX), "filter"),
        "mount": (lambda: library("mount", b"tmpfs", b"/mnt", b"tmpfs", 0, None), "landlock filter"),
        "lock": (lambda: changed(file, lambda: file.chmod(0o600)), "filter"),
        "age": (lambda: changed(file, lambda: os.utime(file, (1, 1))), "filter"),
        "read in memory": (lambda: os.memfd_create("a"), "filter"),
        "leave a message": (lambda: left("msgget", "msgctl", 0o1600), "filter"),
        "leave a semaphore": (lambda: left("semget", "semctl", 1, 0o1600), "filter"),
        "leave shared memory": (lambda: left("shmget", "shmctl", 64, 0o1600), "filter"),
        "slow another": (lambda: os.setpriority(os.PRIO_PROCESS, OURS, 19), "filter"),
        "slow itself": (lambda: os.nice(1), "filter"),
        "bind another": (lambda: os.sched_setaffinity(OURS, os.sched_getaffinity(0)), "filter"),
        "set a scheduler": (lambda: library("sched_setscheduler", OURS, 0, bytes(8)), "filter"),
        "set a file's owner": (lambda: fcntl.fcntl(os.pipe()[0], fcntl.F_SETOWN, OURS), "filter"),
        "choose its signal": (lambda: fcntl.fcntl(os.pipe()[0], fcntl.F_SETSIG, signal.SIGKILL), "filter"),
        "set a socket's owner": (lambda: fcntl.ioctl(pair(), FIOSETOWN, struct.pack("i", OURS)), "filter"),
        "lock a file": (lambda: fcntl.flock(os.open("/etc/passwd", 0), fcntl.LOCK_SH), "filter"),
        "lock a part": (lambda: fcntl.lockf(os.open("/etc/passwd", 0), fcntl.LOCK_SH), "filter"),
        "lease a file": (lambda: fcntl.fcntl(own(place), fcntl.F_SETLEASE, fcntl.F_RDLCK), "filter"),
        "send to a socket's file": (lambda: pair(socket.SOCK_DGRAM).sendto(b"a", "server"), "filter"),
        "hold another": (lambda: os.pidfd_open(OURS), "filter"),
        "outlive the keeper": (lambda: walls.prctl(walls.DIE_WITH_PARENT, 0), "filter"),
        "adopt orphans": (lambda: walls.prctl(walls.ADOPT_ORPHANS, 1), "filter"),
        "watch a folder": (lambda: library("inotify_init"), "filter"),
    }


def left(get, control, *arguments):
    """Make a queue, a set of semaphores or memory that outlives its process, and remove it again."""
    number = ctypes.CDLL(None)[get](0, *arguments)
    if number < 0:
        raise OSError(get)
    place_of_command = (0, 0) if get == "semget" else (0,)
    ctypes.CDLL(None)[control](number, *place_of_command[1:], 0, None)  # IPC_RMID


def pair(kind=socket.SOCK_STREAM):
    return socket.socketpair(socket.AF_UNIX, kind)[0]


def own(place):
    return os.open(place / "home" / "own", os.O_RDONLY | os.O_CREAT)


DEPENDS = {
    ("landlock", "signal"): "Linux: from 6.12 on it is forbidden",
    ("filter", "read another's memory"): "who asks: root's it may not",
}
if not hasattr(os, "geteuid") or os.geteuid() == 0:
    names = ("slow another", "bind another", "set a scheduler")
    DEPENDS |= {("landlock", name): "who asks: root's it may not" for name in names}
PORT = 0
NAMES = attempts(Path()).keys()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("wall", walls.ALL)
def test_a_wall_forbids_what_it_says_and_no_more(wall, name, place, monkeypatch):
    require(wall)
    with socket.create_server(("127.0.0.1", 0)) as server:
        monkeypatch.setattr(sys.modules[__name__], "PORT", server.getsockname()[1])
        work, forbidding = attempts(place)[name]
        hidden = place / ("alone" if name == "read a hidden file" else "hidden")
        if (wall, name) in DEPENDS:
            pytest.skip(f"depends on {DEPENDS[wall, name]}")
        assert succeeds([wall], place / "home", hidden, work) == (wall not in forbidding.split())
    assert (place / "hidden" / "file").read_text() == "1"
    for planted in Path("/dev/shm").glob(f"planted-{OURS}"):
        planted.unlink()


@pytest.fixture
def version(request, monkeypatch):
    """Let the kernel say that it has an older Landlock."""
    call, asked = walls._call, ("syscall", walls.RULESET, None, 0, 1)
    if request.param:
        monkeypatch.setattr(walls, "_call", lambda *given: request.param if given == asked else call(*given))


@pytest.mark.parametrize("version", [1, 2, 3, 4, 5, 6], indirect=True)
def test_with_each_version_of_landlock_both_walls_forbid_all(version, place):
    require("landlock"), require("filter")

    def attempt_all():
        for name, (work, _) in attempts(place).items():
            with suppress(Exception):
                work()
                os.write(2, f"{name} succeeds".encode())
                os._exit(1)

    assert succeeds(walls.ALL, place / "home", place / "hidden", attempt_all)


@pytest.mark.parametrize("version", [1, 2], indirect=True)
def test_before_linux_6_2_landlock_raises_the_filter_too(version, place):
    require("landlock"), require("filter")
    file = place / "file"
    assert not succeeds(["landlock"], place / "home", place / "hidden", lambda: os.truncate(file, 0))


@pytest.mark.parametrize("flags", [0x10000000, 0x20000000, 0x40000000, 0x8000000, 0x20000, 0x8000])
def test_no_child_gets_a_namespace_or_another_parent(flags, place):
    require("filter")
    clone = {"x86_64": 56, "aarch64": 220}[platform.machine()]

    def work():
        child = ctypes.CDLL(None, use_errno=True).syscall(clone, flags | signal.SIGCHLD, 0, 0, 0, 0)
        if child == 0:
            os._exit(0)
        assert child == -1 and ctypes.get_errno() == errno.ENOSYS

    assert succeeds(["filter"], place / "home", place / "hidden", work)


@pytest.mark.parametrize(
    ("wall", "version"), [("landlock", None), ("landlock", 2), ("filter", None)], indirect=["version"]
)
def test_at_home_all_works(wall, version, place):
    require(wall)

    def work():
        here = place / "home"
        (here / "folder").mkdir()
        (here / "a").write_text("3")
        (here / "a").chmod(0o600)
        (here / "a").rename(here / "folder" / "b")
        (here / "c").symlink_to("folder/b")
        assert (here / "c").read_text() == "3"
        assert os.system("echo > /dev/null && ls / > /dev/null || true") == 0

    assert succeeds([wall], place / "home", place / "hidden", work)


def test_the_teachers_folder_is_not_readable_although_python_finds_modules_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in ("", str(tmp_path)):
        monkeypatch.setattr(sys, "path", [path, *sys.path])
        assert tmp_path.resolve() not in walls.readable([])


@pytest.mark.parametrize(
    ("module", "name", "given", "wanted"),
    [(sys, "platform", "darwin", walls.ALL), (platform, "machine", lambda: "abacus", ["filter"])],
)
def test_where_a_wall_cannot_be_raised_nothing_runs(module, name, given, wanted, place, monkeypatch):
    monkeypatch.setattr(module, name, given)
    done = place / "home" / "done"
    assert not any(succeeds([wall], place / "home", place / "hidden", done.touch) for wall in wanted)
    assert not done.exists()


@pytest.mark.parametrize(
    ("raised", "says"),
    [
        (walls.ALL, "read Python and write in their home only, without a network"),
        (("bubblewrap", "filter"), "read Python and write in their home only, without a network"),
        (("filter",), "READ AND WRITE WHAT YOU CAN (the package is compared after each), without a network"),
        ((), "behind no walls: notebooks READ AND WRITE WHAT YOU CAN"),
    ],
)
def test_the_first_line_says_which_walls_there_are(raised, says):
    assert says in protection(raised)
