"""The errors that `mocap` raises on purpose: each is one clear sentence, and says what would help."""

import sys
import warnings
from pathlib import Path


def shortened(text: str, length: int = 80) -> str:
    """Cut a text from a file, made `printable`, to at most `length` characters, and say how long it was.

    Examples
    --------
    >>> shortened("'1.0 2.0 x 3.0 4.0 5.0 6.0 7.0 8.0 9.0'", 36)
    "'1.0 2.0 x 3.0 ...' (37 characters)"
    """
    text = printable(text)
    if len(text) <= length:
        return text
    quote = "'" if text.startswith("'") else ""
    end = f" ...{quote} ({len(text.strip(quote))} characters)"
    return text[: length - len(end)].rstrip() + end


def printable(text: object) -> str:
    r"""Write out control characters, which a terminal would obey, and line ends, as names may hold them.

    Examples
    --------
    >>> print(printable("walk\n\x1b[2J.bvh"))
    walk\n\x1b[2J.bvh
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


class MocapError(ValueError):
    """The base of all errors raised on purpose: the input, not the program, is at fault."""

    def __str__(self) -> str:
        return printable(super().__str__())


class FormatError(MocapError):
    """A file breaks its format: the message gives the line, what the format asks for, and what stands there.

    Without the path, the message is at most 200 characters long, whatever the file holds.

    Parameters
    ----------
    path : the file.
    line : the line's number, from 1; None for the whole file.
    expected, got : what the format asks for, and what the file holds.

    Examples
    --------
    >>> print(FormatError("walk.amc", 7, "3 numbers for 'lfemur'", "2"))
    walk.amc, line 7: expected 3 numbers for 'lfemur', got 2
    """

    def __init__(self, path: str | Path, line: int | None, expected: str, got: str) -> None:
        self.path = Path(path)
        self.line = line
        self.expected = expected
        self.got = got
        super().__init__(path, line, expected, got)

    def __str__(self) -> str:
        place = printable(self.path) + ("" if self.line is None else f", line {self.line}")
        expected = shortened(self.expected, 110)
        return f"{place}: expected {expected}, got {shortened(self.got, min(80, 165 - len(expected)))}"


class SkeletonMismatch(MocapError):
    """Two motions, or a motion and a skeleton, do not have the same joints."""


class NoWalk(MocapError):
    """The graph has no walk of the kind that was asked for."""


def requirement(extra: str) -> str:
    """Name this package with an extra as pip wants it: by its name on the index, or from a checkout.

    Examples
    --------
    >>> requirement("video") in ("motion-graphs[video]", ".[video]")
    True
    """
    from importlib.metadata import distributions  # only here: it takes a while

    # What was installed from a folder says so.
    installed = distributions(name="motion-graphs")
    noted = [distribution.read_text("direct_url.json") or "" for distribution in installed]
    local = all("dir_info" in note for note in noted)
    return f"{'.' if local else 'motion-graphs'}[{extra}]"


def missing(need: str, extra: str) -> MocapError:
    """Say what is not installed, and how to install it; the quotes are those that every shell knows.

    Examples
    --------
    >>> print(str(missing("Films need imageio-ffmpeg", "video")).replace('".[', '"motion-graphs['))
    Films need imageio-ffmpeg: pip install "motion-graphs[video]".
    """
    return MocapError(f'{need}: pip install "{requirement(extra)}".')


class MocapWarning(UserWarning):
    """Something that was asked for is possible only in part; the message says how much of it."""


def warn(sentence: str) -> None:
    """Warn by a `MocapWarning`, which shows the line that called this package."""
    frame = sys._getframe()
    level = 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("mocap."):
        frame = frame.f_back
        level += 1
    warnings.warn(printable(sentence), MocapWarning, stacklevel=level)
