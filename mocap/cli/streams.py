"""Robust standard streams, which may be closed, full, or abandoned by their reader.

A command continues if its output is no longer read, because its result is the file that it writes.
"""

import errno
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import Any, TextIO, cast

from mocap.errors import MocapError


class PatientOutput:
    """A text stream that discards text after its reader has closed the pipe.

    Parameters
    ----------
    stream : the underlying stream.

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
        """Write or discard a text, and return its length."""
        self._attempt(lambda: self.stream.write(text))
        return len(text)

    def flush(self) -> None:
        """Write the buffered text."""
        self._attempt(self.stream.flush)

    def discard(self) -> None:
        """Discard the buffered text, which Python would otherwise try to write again at exit."""
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
    """Return whether the reader has closed the pipe, as with `mocap data list | head`.

    Windows reports this as an invalid argument of a file without a name.
    """
    invalid = error.errno == errno.EINVAL and error.filename is None
    return isinstance(error, BrokenPipeError) or (os.name == "nt" and invalid)


@contextmanager
def prepared_streams() -> Iterator[PatientOutput]:
    """Print to a `PatientOutput` in a `with` block, with closed streams replaced by the null device."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115 (as long as Python)
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")  # a terminal without the character ° shows ?
    output = PatientOutput(sys.stdout)
    with redirect_stdout(cast(TextIO, output)):
        yield output
