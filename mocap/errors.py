"""Every error `mocap` raises on purpose: one clear sentence, and what would help."""

from pathlib import Path


class MocapError(ValueError):
    """The base of all errors raised on purpose: the input, not the program, is at fault."""


class FormatError(MocapError):
    """A file that breaks its format, with the place and what stood there.

    Parameters
    ----------
    path : the file.
    line : the line's number, from 1; None where the whole file is meant.
    expected, got : what the format asks for, and what the file holds.

    Examples
    --------
    >>> print(FormatError("walk.amc", 7, "3 numbers for 'lfemur'", "2"))
    walk.amc, line 7: expected 3 numbers for 'lfemur', got 2
    """

    def __init__(self, path: str | Path, line: int | None, expected: str, got: str) -> None:
        self.path, self.line, self.expected, self.got = Path(path), line, expected, got
        super().__init__(path, line, expected, got)

    def __str__(self) -> str:
        place = f"{self.path}" if self.line is None else f"{self.path}, line {self.line}"
        return f"{place}: expected {self.expected}, got {self.got}"


class SkeletonMismatch(MocapError):
    """Two motions, or a motion and a skeleton, whose joints are not the same."""


class NoWalk(MocapError):
    """A graph in which the walk asked for does not exist."""


class MocapWarning(UserWarning):
    """Something that was asked for can be had only in part; the message says how much of it."""
