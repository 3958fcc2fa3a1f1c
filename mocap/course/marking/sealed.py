"""The marker's side of a student's process: start it, ask it, and stop it in time."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import mocap
from mocap.errors import MocapError

REPLY = 1 << 20  # bytes of an answer, of which the course's have some thousands
KEEPER = (sys.executable, "-m", "mocap.course.marking.keeper")
KEPT = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "PYTHONHOME", "TZ")
FIXED = {
    "MPLBACKEND": "Agg",
    "MOCAP_MINE": "",  # no function of a student is kept for the next one
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
    >>> with sealed() as student:
    ...     student.allow(60)
    ...     student.ask("begin", [((), "x = 3"), (("f",), "def f(a): return a + x")])
    ...     student.ask("prepare", "f"), student.ask("call", "f", (4,))
    ({'found': True, 'error': ''}, {'given': 7, 'changed': []})
    """

    def __init__(self, channel: socket.socket, why: Callable[[], str]) -> None:
        self.channel, self.why = channel, why
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
            return json.loads(line)
        except TimeoutError:
            raise Ended(f"stopped after {self.seconds:g} s") from None
        except OSError:
            raise Ended(self.why() or "ends Python itself") from None
        except (ValueError, RecursionError):
            raise Ended("gives an answer that cannot be read") from None

    def _wait(self) -> None:
        left = self.deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self.channel.settimeout(left)


@cache
def offline() -> bool:
    """Try whether this system can run a process without a network.

    Examples
    --------
    >>> offline() in (True, False)
    True
    """
    environment = os.environ | {"PYTHONPATH": _python_path()}
    tried = subprocess.run([*KEEPER, "cut_off"], env=environment, check=False, capture_output=True)
    return tried.returncode == 0


@contextmanager
def fonts() -> Iterator[Path]:
    """Make a folder with Matplotlib's list of fonts, which each process would otherwise make for itself."""
    with _home(None) as (folder, environment):
        command = [sys.executable, "-c", "import matplotlib.font_manager"]
        subprocess.run(command, cwd=folder, env=environment, check=False, capture_output=True)
        yield Path(folder)


@contextmanager
def sealed(fonts: Path | None = None) -> Iterator[Sealed]:
    """Start a student's process in a new folder, its home; at the end kill it and all that it started.

    Parameters
    ----------
    fonts : the folder of Matplotlib's list of fonts.

    Yields
    ------
    The process.

    Raises
    ------
    MocapError : on Windows, which has no such limits.
    """
    ours, theirs = socket.socketpair()
    with _home(fonts) as (folder, environment), ours:
        with theirs:
            keeper = subprocess.Popen(
                [*KEEPER, str(theirs.fileno()), *["offline"] * offline()],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                cwd=folder,
                env=environment,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        try:
            yield Sealed(ours, lambda: _end(keeper))
        finally:
            _end(keeper)


def _end(keeper: subprocess.Popen[bytes]) -> str:
    """Let the keeper kill what there is, and return why it stopped the process before, if it did."""
    if keeper.stdin is None or keeper.stdin.closed:
        return ""
    keeper.send_signal(signal.SIGCONT)  # the student's process may have stopped it
    try:
        return keeper.communicate(timeout=30)[0].decode()
    except subprocess.TimeoutExpired:  # as when it is stopped again and again
        keeper.kill()
        keeper.wait()
        return ""


@contextmanager
def _home(fonts: Path | None) -> Iterator[tuple[str, Mapping[str, str]]]:
    """Make a folder, and the few variables of an environment in which it is the home."""
    if os.name != "posix":
        raise MocapError("Marking needs Linux or macOS: on Windows, use WSL or a container.")
    folder = tempfile.mkdtemp(prefix="marking-")
    try:
        config = shutil.copytree(fonts, Path(folder, "fonts")) if fonts else Path(folder)
        places = {"HOME": folder, "TMPDIR": folder, "MPLCONFIGDIR": str(config)}
        kept = {name: os.environ[name] for name in KEPT if name in os.environ}
        yield folder, {**kept, **FIXED, **places, "PYTHONPATH": _python_path()}
    finally:  # not by shutil.rmtree, which gives up on folders in folders in folders
        subprocess.run(["rm", "-rf", folder], check=False, stderr=subprocess.DEVNULL)


def _python_path() -> str:
    """Say where Python finds this package, and what the marker's own Python was given."""
    given = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    places = (Path(mocap.__file__).parents[1], *(Path(place).resolve() for place in given))
    return os.pathsep.join(map(str, places))
