"""The marker's side: start the keeper, have students' processes, ask them, and stop them in time."""

from __future__ import annotations

import json
import os
import pickle
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import mocap
from mocap.course.marking import walls
from mocap.errors import MocapError

REPLY = 1 << 20  # bytes of an answer, of which the course's have some thousands
REPLIES: dict[str, tuple[type, ...]] = {"begin": (), "prepare": (bool, str), "call": (object, list, str, str)}
WANTED = walls.ALL
KEPT = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "PYTHONHOME", "TZ")
FIXED = {
    "MPLBACKEND": "Agg",
    "MOCAP_MINE": "",  # no function of a student is kept for the next one
    "PYTHONDONTWRITEBYTECODE": "1",
    **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
}


class Ended(BaseException):
    """The student's process has ended, or was stopped; its text says why.

    It is no `Exception`, because a check takes those for errors of the student's function.
    """


class Sealed:
    """A student's process, which answers requests until a deadline.

    Examples
    --------
    >>> with Keeper() as keeper, keeper.student() as student:
    ...     student.allow(60)
    ...     student.ask("begin", [((), "x = 3"), (("f",), "def f(a): return a + x")])
    ...     student.ask("prepare", "f"), student.ask("call", "f", (4,))
    ([True, ''], [7, [], '', ''])
    """

    def __init__(self, channel: socket.socket, end: Callable[[], str]) -> None:
        self.channel, self.end = channel, end
        self.seconds = self.deadline = 0.0
        self.read = bytearray()

    def allow(self, seconds: float) -> None:
        """Set the deadline, this many seconds from now."""
        self.seconds, self.deadline = seconds, time.monotonic() + seconds

    def ask(self, method: str, *arguments: object) -> Any:  # noqa: ANN401
        """Call a method of `student.Student` in the process, and return what it gives.

        Raises
        ------
        Ended : if the process ends, is too slow, or gives what is no answer.
        """
        try:
            self._wait()
            self.channel.sendall(pickle.dumps((method, *arguments)))
            while b"\n" not in self.read:
                self._wait()
                more = self.channel.recv(1 << 16)
                self.read += more
                if not more:
                    raise OSError
                if len(self.read) > REPLY:
                    raise Ended(f"gives an answer of more than {REPLY >> 20} MB")
            line, _, self.read = self.read.partition(b"\n")
            reply = json.loads(line)
            if not isinstance(reply, list) or len(reply) != len(REPLIES[method]):
                raise ValueError
            if not all(map(isinstance, reply, REPLIES[method])):
                raise ValueError
            return reply
        except TimeoutError:
            raise Ended(f"stopped after {self.seconds:g} s") from None
        except OSError:
            raise Ended(self.end() or "ends Python itself") from None
        except (ValueError, RecursionError):
            raise Ended("gives an answer that cannot be read") from None

    def _wait(self) -> None:
        left = self.deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self.channel.settimeout(left)


def protection(raised: Sequence[str]) -> str:
    """Say what walls keep a notebook from, as the first line that `mocap course mark` prints.

    Examples
    --------
    >>> protection(["landlock", "filter"])
    'marking behind landlock, filter: notebooks read Python and write in their home only, without a network'
    """
    files = "READ AND WRITE WHAT YOU CAN (the package is compared after each)"
    if "namespaces" in raised:
        files = "write in their home only, and read what you can but not what was handed in"
    if "landlock" in raised:
        files = "read Python and write in their home only"
    network = "without a" if {"namespaces", "filter"} & {*raised} else "WITH THE"
    return f"marking behind {', '.join(raised) or 'no walls'}: notebooks {files}, {network} network"


class Keeper:
    """The keeper of the students' processes, as a context manager.

    Parameters
    ----------
    hidden : files and folders that these processes must not read.

    Attributes
    ----------
    walls : what surrounds them, of `walls.ALL`.

    Raises
    ------
    MocapError : on Windows, which has no such limits.
    """

    def __init__(self, hidden: Iterable[Path] = ()) -> None:
        self.arguments = json.dumps([WANTED, [str(place.resolve()) for place in hidden]])

    def __enter__(self) -> Keeper:
        self.folder = _home()
        self.environment = self.folder.__enter__()
        self._start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        self.folder.__exit__(None, None, None)

    def _start(self) -> None:
        self.control, theirs = socket.socketpair()
        self.control.settimeout(30)
        command = [sys.executable, "-m", "mocap.course.marking.keeper", self.arguments]
        place, nothing = Path(self.environment["HOME"]).parent, subprocess.DEVNULL
        self.process = subprocess.Popen(
            command,
            stdin=theirs,
            stdout=nothing,
            stderr=nothing,
            cwd=place,
            env=self.environment,
            process_group=0,
        )
        theirs.close()
        self.walls = self._answer().split()

    def _stop(self) -> None:
        """Close the socket, at which the keeper kills what there is and ends; or kill it."""
        self.control.close()
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    @contextmanager
    def student(self) -> Iterator[Sealed]:
        """Start a student's process in a new folder, its home; at the end kill it and all that it started.

        Yields
        ------
        The process.
        """
        if self.process.poll() is not None:  # a notebook killed it, behind no walls
            self._stop()
            self._start()
        ours, theirs = socket.socketpair()
        with ours:
            with theirs:
                socket.send_fds(self.control, [b"s"], [theirs.fileno()])
            ended = cache(self._end)
            try:
                yield Sealed(ours, ended)
            finally:
                ended()

    def _end(self) -> str:
        """Have all killed that the student's process started; return why it was stopped before, if it was."""
        with suppress(OSError):
            self.process.send_signal(signal.SIGCONT)  # a notebook may have stopped it, behind no walls
            self.control.sendall(b"e")
        return self._answer()

    def _answer(self) -> str:
        """Read a line from the keeper; if none comes, kill it."""
        line = b""
        with suppress(OSError):
            while more := self.control.recv(100):
                line += more
                if line.endswith(b"\n"):
                    return line.decode().strip()
        self.process.kill()
        self.process.wait()
        return ""


@contextmanager
def _home() -> Iterator[dict[str, str]]:
    """Make a folder, and the few variables of an environment in which a folder in it is the home."""
    if os.name != "posix":
        raise MocapError("Marking needs Linux or macOS: on Windows, use WSL or a container.")
    folder = tempfile.mkdtemp(prefix="marking-")
    try:
        home = Path(folder).resolve() / "home"
        home.mkdir()
        kept = {name: os.environ[name] for name in KEPT if name in os.environ}
        yield {**kept, **FIXED, "HOME": str(home), "TMPDIR": str(home), "PYTHONPATH": _python_path()}
    finally:  # not by shutil.rmtree, which gives up on folders in folders in folders
        subprocess.run(["rm", "-rf", folder], check=False, stderr=subprocess.DEVNULL)


def _python_path() -> str:
    """Say where Python finds this package, and what the marker's own Python was given."""
    given = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    places = (Path(mocap.__file__).parents[1], *(Path(place).resolve() for place in given))
    return os.pathsep.join(map(str, places))
