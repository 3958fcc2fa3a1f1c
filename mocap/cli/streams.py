"""The standard streams as a command finds them: closed, full, or with a reader who leaves early.

A command goes on when nobody reads what it prints, because the file that it writes is what was asked for.
"""

import errno
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import Any, TextIO, cast

from mocap.errors import MocapError


class PatientOutput:
    """A text stream that drops what is written after its reader has left.

    Parameters
    ----------
    stream : where to write.

    Examples
    --------
    >>> read, write = os.pipe()
    >>> os.close(read)
    >>> output = PatientOutput(open(write, "w"))
    >>> print("heard by nobody", file=output, flush=True)
    >>> output.abandoned
    True
    >>> output.discard()
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self.abandoned = False

    def write(self, text: str) -> int:
        """Write a text, or drop it; return its length."""
        self._attempt(lambda: self.stream.write(text))
        return len(text)

    def flush(self) -> None:
        """Write what is buffered."""
        self._attempt(self.stream.flush)

    def discard(self) -> None:
        """Drop what is still buffered: Python would try again to write it when it ends."""
        with suppress(OSError, ValueError):  # a stream without a file has no number
            os.dup2(os.open(os.devnull, os.O_WRONLY), self.stream.fileno())

    def _attempt(self, action: Callable[[], object]) -> None:
        if self.abandoned:
            return
        try:
            action()
        except OSError as error:
            if not _is_closed_pipe(error):
                raise MocapError(f"Cannot write the output: {error.strerror}.") from error
            self.abandoned = True

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 (whatever the stream has)
        return getattr(self.stream, name)


def _is_closed_pipe(error: OSError) -> bool:
    """Check whether the reader has seen enough, as with `mocap data list | head`.

    Windows reports that as an invalid argument of a file without a name.
    """
    invalid = error.errno == errno.EINVAL and error.filename is None
    return isinstance(error, BrokenPipeError) or (os.name == "nt" and invalid)


@contextmanager
def prepared_streams() -> Iterator[PatientOutput]:
    """Print to a `PatientOutput` in a `with` block; a stream that is closed from the start leads nowhere."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115 (as long as Python)
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")  # a terminal that knows no ° shows ?
    output = PatientOutput(sys.stdout)
    with redirect_stdout(cast(TextIO, output)):
        yield output
