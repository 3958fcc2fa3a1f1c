"""Messages of a command besides its results, on the standard error: warnings, stages, errors.

`-q` omits progress and warnings. `-v` adds the files that are read and the duration of each stage.
"""

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from mocap.errors import MocapError, printable, shortened

LONGEST_WORD = 200  # characters of a name in a message
COMMON = Group("Options of all commands", sort_key=99)


@dataclass(frozen=True)
class Verbosity:
    """The verbosity of a command: options that all commands have."""

    quiet: Annotated[bool, Parameter(alias="-q", group=COMMON), "show no progress and no warnings"] = False
    verbose: Annotated[
        bool, Parameter(alias="-v", group=COMMON), "show files that are read, and the duration of each stage"
    ] = False
    debug: Annotated[bool, Parameter(group=COMMON), "show the traceback of an error"] = False

    def __post_init__(self) -> None:
        if self.quiet and self.verbose:
            raise MocapError("--quiet says less and --verbose says more: give one of them.")


NORMAL = Verbosity()
VERBOSITY = ContextVar("VERBOSITY", default=NORMAL)


@contextmanager
def at_verbosity(verbosity: Verbosity) -> Iterator[None]:
    """Set the verbosity in a `with` block."""
    token = VERBOSITY.set(verbosity)
    try:
        yield
    finally:
        VERBOSITY.reset(token)


def print_message(message: object) -> None:
    """Print one line, without line ends in names, and with long names shortened."""
    text = re.sub(rf"\S{{{LONGEST_WORD},}}", lambda word: shortened(word[0]), printable(message))
    print(f"mocap: {text}", file=sys.stderr)


def note(message: str) -> None:
    """Print a line only with `-v`."""
    if VERBOSITY.get().verbose:
        print_message(message)
