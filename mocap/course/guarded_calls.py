"""Calls of a student's function that can neither stop nor freeze the notebook.

`guarded` ends what never ends, and turns what would stop the kernel into an error:

- a loop in Python is ended by `mocap._shared.limits.time_limit`;
- a loop in a compiled function, such as `sum(itertools.count())`, cannot be interrupted. A timer of the
  interpreter ends the process, and first writes where it was; Jupyter starts a new kernel, in which
  `read_report` tells the reader why;
- memory beyond `MEMORY` is refused, on Linux;
- `input()`, which would wait for an answer, and `os._exit` and `os.abort`, which would end the kernel, raise;
- an exception in a thread, which the notebook would print somewhere, is raised where the function is called.

In the Python of a browser there is neither a timer nor a limit of memory.
"""

from __future__ import annotations

import builtins
import faulthandler
import os
import re
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import IO, Any, NamedTuple, NoReturn

from mocap._shared.limits import time_limit

SPARE = 2.0  # seconds from the end of the time limit to the end of the process
MEMORY = 2 * 2**30  # bytes that a call may allocate
JOINING = 1.0  # seconds to wait for the threads that a function has started
FRAME = re.compile(r'File "(?P<file>.*)", line (?P<line>\d+) in (?P<function>\w+)')

_in_force = threading.local()  # whether this thread is inside `guarded`


class Stopped(NamedTuple):
    """The place in a student's code at which the last kernel was ended."""

    function: str  # the function that was running, or "" for none
    line: int  # its line
    functions: tuple[str, ...]  # all functions that were running, innermost first


@contextmanager
def guarded(seconds: float, *, quick: bool = False) -> Iterator[None]:
    """Run untrusted code in a `with` block that ends within some seconds. Inner blocks have no effect.

    Parameters
    ----------
    seconds : the time limit of code in Python; a compiled loop ends `SPARE` seconds later.
    quick : do without the limit of memory and the end of compiled loops, which take a tenth of a millisecond.

    Raises
    ------
    Overdue
        If the code takes longer than the time limit.
    MemoryError
        If it allocates more than `MEMORY`.
    RuntimeError
        If it asks for input or ends the process.
    Exception
        Whatever the code raises, also in its threads.

    Examples
    --------
    >>> with guarded(1.0):
    ...     input("Which angle? ")
    Traceback (most recent call last):
    RuntimeError: input() waits for a person, who cannot answer here
    """
    if getattr(_in_force, "yes", False):
        yield
        return
    _in_force.yes = True
    try:
        with ExitStack() as guards:
            if not quick:
                guards.enter_context(_timer(seconds + SPARE))
                guards.enter_context(_limited_memory())
            guards.enter_context(_refused_calls())
            guards.enter_context(_joined_threads())
            guards.enter_context(time_limit(seconds))
            yield
    finally:
        _in_force.yes = False


class _Report:
    """The file to which the timer writes where a process was, before it ends it."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.file: IO[str] | None = None

    def open(self) -> IO[str] | None:
        """Return the open file; None without one, or in a folder that cannot be written."""
        if self.file is None and self.path is not None:
            with suppress(OSError):
                self.file = self.path.open("a", encoding="utf-8")
        return self.file

    def close(self) -> None:
        """Close the file, and remove it if it is empty."""
        if self.file is None or self.path is None:
            return
        self.file.close()
        self.file = None
        with suppress(OSError):
            if not self.path.stat().st_size:
                self.path.unlink()


_report = _Report()


def write_report_to(path: Path | None, *, anew: bool = False) -> None:
    """Choose the file to which the timer writes before it ends the process.

    Parameters
    ----------
    path : the file, or None to end the process without a report.
    anew : remove the report of an earlier kernel.
    """
    _report.close()
    _report.path = path
    if anew and path is not None:
        with suppress(OSError):
            path.unlink(missing_ok=True)


def read_report(file: Path) -> Stopped | None:
    """Read where an earlier kernel was ended; None if it was not.

    Examples
    --------
    >>> read_report(Path("nowhere"))
    """
    try:
        text = file.read_text("utf-8", errors="replace")
    except OSError:
        return None
    frames = [match for match in FRAME.finditer(text) if not _is_own(match["file"])]
    if "Timeout" not in text:
        return None
    if not frames:
        return Stopped("", 0, ())
    return Stopped(
        frames[0]["function"], int(frames[0]["line"]), tuple(frame["function"] for frame in frames)
    )


def _is_own(file: str) -> bool:
    """Return whether a file of a traceback is one of the package's."""
    return Path(__file__).parents[1] in Path(file).parents


@contextmanager
def _timer(seconds: float) -> Iterator[None]:
    """End the process after some seconds, unless the block ends before."""
    if not hasattr(faulthandler, "dump_traceback_later"):  # the Python of a browser
        yield
        return
    file = _report.open()
    target: dict[str, Any] = {} if file is None else {"file": file}
    with suppress(RuntimeError, ValueError, OSError):  # a standard error without a file descriptor
        faulthandler.dump_traceback_later(seconds, exit=True, **target)
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()
        _report.close()  # nothing is left beside the notebook


@contextmanager
def _limited_memory() -> Iterator[None]:
    """Refuse memory beyond `MEMORY` more than the process has now, where the system can."""
    try:
        import resource  # not on Windows

        pages = int(Path("/proc/self/statm").read_bytes().split()[0])
        limits = resource.getrlimit(resource.RLIMIT_AS)
        limit = pages * resource.getpagesize() + MEMORY
    except (ImportError, OSError):  # only Linux tells how much memory a process has
        yield
        return
    soft, hard = limits
    finite = [bound for bound in (limit, soft, hard) if bound != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_AS, (min(finite), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)


@contextmanager
def _refused_calls() -> Iterator[None]:
    """Let functions that wait for a person or end the process raise."""
    refused = {
        (builtins, "input"): "input() waits for a person, who cannot answer here",
        (os, "_exit"): "os._exit would end the notebook's kernel",
        (os, "abort"): "os.abort would end the notebook's kernel",
    }
    originals = {place: getattr(*place) for place in refused}
    for place, reason in refused.items():
        setattr(*place, _refusal(reason))
    try:
        yield
    finally:
        for place, function in originals.items():
            setattr(*place, function)


def _refusal(reason: str) -> Any:  # noqa: ANN401 (a function of any arguments)
    """Return a function that raises."""

    def refuse(*_: object, **__: object) -> NoReturn:
        raise RuntimeError(reason)

    return refuse


@contextmanager
def _joined_threads() -> Iterator[None]:
    """Wait for the threads that the block starts, and raise the first error of one of them."""
    errors: list[BaseException] = []
    running = set(threading.enumerate())
    original = threading.excepthook

    def note(failure: threading.ExceptHookArgs) -> None:
        if failure.exc_value is not None:
            errors.append(failure.exc_value)

    threading.excepthook = note
    try:
        yield
        for thread in set(threading.enumerate()) - running:
            thread.join(JOINING)
    finally:
        threading.excepthook = original
    if errors:
        raise errors[0]
