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
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import mocap
from mocap.course.checks import ANSWERS
from mocap.course.marking import bubblewrap, walls
from mocap.course.marking.keeper import remove

REPLY = 1 << 20  # bytes of an answer, of which the course's have some thousands
# The types of a reply, by the method of `student.Student` that is called.
REPLIES: dict[str, tuple[type, ...]] = {"begin": (), "prepare": (bool, str)}
REPLIES["call"] = (object, list, str, str)
CHUNK = 1 << 16  # bytes that are received at a time
ANSWERING = 30  # seconds in which the keeper must answer
WANTED = (bubblewrap.NAME, *walls.ALL)
KEPT = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "PYTHONHOME", "TZ")
FIXED = {f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL")}
FIXED |= {"MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"}
FIXED["MOCAP_MINE"] = ""  # no function of a student is kept for the next one


class Ended(BaseException):
    """The student's process has ended, or was stopped; its text says why.

    It is no `Exception`, because a check takes those for errors of the student's function.
    """


class Sealed:
    """A student's process behind walls, which answers requests until a deadline; one after the other.

    Parameters
    ----------
    hidden : files and folders that these processes must not read, in addition to the answers of exercises.

    Attributes
    ----------
    walls : what surrounds them, of `WANTED`.

    Raises
    ------
    MocapError : where `walls.require_sealing` raises it, as on Windows.

    Examples
    --------
    >>> from contextlib import closing
    >>> with closing(Sealed()) as student:
    ...     student.renew()
    ...     student.allow(60)
    ...     student.ask("begin", [((), "x = 3"), (("f",), "def f(a): return a + x")])
    ...     student.ask("prepare", "f"), student.ask("call", "f", (4,))
    []
    ([True, ''], [7, [], '', ''])
    """

    def __init__(self, hidden: Iterable[Path] = ()) -> None:
        walls.require_sealing()
        self.hidden = [str(place.resolve()) for place in (ANSWERS, *hidden)]
        self.folder = Path(tempfile.mkdtemp(prefix="marking-")).resolve()
        self.running = False
        self._start()

    def _start(self) -> None:
        """Start the keeper, in a folder and with few variables in its environment."""
        home = self.folder / "keeper"
        home.mkdir(parents=True, exist_ok=True)  # a keeper that ends removes them
        inherited = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
        path = [Path(mocap.__file__).parents[1], *(Path(place).resolve() for place in inherited)]
        environment = {name: os.environ[name] for name in KEPT if name in os.environ}
        environment |= dict.fromkeys(("HOME", "TMPDIR"), str(home))
        environment["PYTHONPATH"] = os.pathsep.join(map(str, path))
        environment |= FIXED
        keeper = [
            sys.executable,
            "-P",
            "-m",
            "mocap.course.marking.keeper",
        ]  # -P: the folder is no path of it
        wraps = bubblewrap.NAME in WANTED
        in_bubblewrap = bubblewrap.wrapped(keeper, self.folder, self.hidden, environment) if wraps else []
        self.control, theirs = socket.socketpair()
        self.control.settimeout(ANSWERING)
        self.lines = self.control.makefile()
        null = subprocess.DEVNULL
        start = partial(subprocess.Popen, stdin=theirs.fileno(), stdout=null, stderr=null)
        command = in_bubblewrap or keeper
        with theirs:
            self.process = start(command, cwd=self.folder, env=environment, start_new_session=True)
        wanted = [wall for wall in WANTED if wall in walls.ALL]
        self.control.sendall(f"{json.dumps([wanted, self.hidden])}\n".encode())
        outer = [bubblewrap.NAME] if in_bubblewrap else []
        self.walls = outer + self._answer().split()

    def renew(self) -> None:
        """End the process and all that it started, and start another one in a new home."""
        self._end()
        if self.process.poll() is not None:  # a notebook killed the keeper, behind no walls
            self._start()
        self.received = bytearray()
        self.running = True
        self.channel, theirs = socket.socketpair()
        with theirs:
            socket.send_fds(self.control, [b"s"], [theirs.fileno()])

    def close(self) -> None:
        """End the process and all that it started, and the keeper, which removes the folder."""
        self._end()
        self.lines.close()
        self.control.close()
        self.process.wait()
        remove(self.folder)  # a keeper that did not start has left it

    def _end(self) -> str:
        """Let the keeper kill all that the process started; return why it was stopped before, if it was."""
        if not self.running:
            return ""
        self.running = False
        self.channel.close()
        with suppress(OSError):
            self.process.send_signal(signal.SIGCONT)  # a notebook may have stopped it, behind no walls
            self.control.sendall(b"e")
        return self._answer()

    def _answer(self) -> str:
        """Read a line from the keeper; if none comes, kill it."""
        with suppress(OSError):
            if line := self.lines.readline():
                return line.strip()
        self.process.kill()
        self.process.wait()
        return ""

    def allow(self, seconds: float) -> None:
        """Set the deadline, this many seconds from now."""
        self.seconds = seconds
        self.deadline = time.monotonic() + seconds

    def ask(self, method: str, *arguments: object) -> Any:  # noqa: ANN401
        """Call a method of `student.Student` in the process, and return its reply.

        Raises
        ------
        Ended : if the process ends, is too slow, or gives what is no answer.
        """
        try:
            self._wait()
            self.channel.sendall(pickle.dumps((method, *arguments)))
            reply = json.loads(self._receive_line())
            for value, kind in zip(reply, REPLIES[method], strict=True):  # a notebook may have forged it
                if not isinstance(value, kind):
                    raise TypeError
            return reply
        except TimeoutError:
            raise Ended(f"stopped after {self.seconds:.3g} s") from None
        except OSError:
            raise Ended(self._end() or "ends Python itself") from None
        except (ValueError, TypeError, RecursionError):
            raise Ended("gives an answer that cannot be read") from None

    def _receive_line(self) -> bytearray:
        """Receive the process's answer up to the end of its line."""
        while b"\n" not in self.received:
            self._wait()
            chunk = self.channel.recv(CHUNK)
            self.received += chunk
            if not chunk:
                raise OSError
            if len(self.received) > REPLY:
                raise Ended(f"gives an answer of more than {REPLY >> 20} MB")
        line, _, self.received = self.received.partition(b"\n")
        return line

    def _wait(self) -> None:
        """Let the next call of the socket wait until the deadline; raise TimeoutError if that has passed."""
        remaining = self.deadline - time.monotonic()
        if remaining <= 0:
            raise TimeoutError
        self.channel.settimeout(remaining)


def protection(raised: Sequence[str]) -> str:
    """Describe what the walls keep a notebook from, as the first line that `mocap course mark` prints.

    Examples
    --------
    >>> protection(["landlock", "filter"])
    'marking behind landlock, filter: notebooks read Python and write in their home only, without a network'
    """
    files = "READ AND WRITE WHAT YOU CAN (the package is compared after each)"
    files = "read Python and write in their home only" if guards_files(raised) else files
    network = "without a" if {"filter", bubblewrap.NAME} & {*raised} else "WITH THE"
    return f"marking behind {', '.join(raised) or 'no walls'}: notebooks {files}, {network} network"


def guards_files(raised: Sequence[str]) -> bool:
    """Return whether one of the walls keeps notebooks from changing the installed package.

    Examples
    --------
    >>> guards_files(["filter"])
    False
    """
    return bool({"landlock", bubblewrap.NAME} & {*raised})
