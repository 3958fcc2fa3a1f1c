"""The errors that `mocap` raises: each message is a sentence with the value, the requirement and a remedy."""

import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple


def shortened(text: str, length: int = 80) -> str:
    """Truncate a text to at most `length` characters, with its original length. It is made `printable`.

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
    r"""Escape control characters and line ends in a text, for safe output to a terminal.

    Examples
    --------
    >>> print(printable("walk\n\x1b[2J.bvh"))
    walk\n\x1b[2J.bvh
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


class Remedy(NamedTuple):
    """The remedy for an error: a parameter, which has another name in commands, or a call in Python.

    Parameters
    ----------
    text : the remedy, with {} for the name of the parameter.
    parameter : its name in Python; "" for a call, which commands omit.

    Examples
    --------
    >>> Remedy("give {}", "fps").worded("--fps")
    'give --fps'
    >>> MocapError("got a motion graph", remedy=Remedy("graphs.load reads it")).worded({"fps": "--fps"})
    'got a motion graph'
    """

    text: str
    parameter: str = ""

    def worded(self, name: str) -> str:
        """Return the text with a name for the parameter."""
        return self.text.replace("{}", name)


class MocapError(ValueError):
    """The base class of all errors raised by `mocap`, for invalid input.

    Parameters
    ----------
    message : the value, and the requirement.
    remedy : the remedy. `str` uses the name of its parameter in Python, a command that of its option.

    Examples
    --------
    >>> error = MocapError("'walk.npz' has no frame rate.", remedy=Remedy("give {}", "fps"))
    >>> print(error)
    'walk.npz' has no frame rate: give fps=.
    >>> print(error.worded({"fps": "--fps"}))
    'walk.npz' has no frame rate: give --fps.
    >>> print(error.worded({}))
    'walk.npz' has no frame rate.
    """

    def __init__(self, *message: object, remedy: Remedy | None = None) -> None:
        self.remedy = remedy
        super().__init__(*message)

    def problem(self) -> str:
        """Return the message without the remedy."""
        return printable(super().__str__())

    def worded(self, names: Mapping[str, str]) -> str:
        """Return the message with other names of parameters. Without a name for it, the remedy is omitted.

        Parameters
        ----------
        names : the names of the available parameters, by their names in Python.
        """
        problem = self.problem()
        if self.remedy is None or self.remedy.parameter not in names:
            return problem
        end = "." if problem.endswith(".") else ""
        return f"{problem.removesuffix('.')}: {self.remedy.worded(names[self.remedy.parameter])}{end}"

    def __str__(self) -> str:
        parameter = self.remedy.parameter if self.remedy else ""
        return self.worded({parameter: f"{parameter}="})


class FormatError(MocapError):
    """A file breaks its format: the message has the line, the expected content and the actual content.

    Without the path, the message has at most 200 characters.

    Parameters
    ----------
    path : the file.
    line : the number of the line, from 1; None for the whole file.
    expected, got : the content that the format requires, and the content of the file.
    remedy : as for `MocapError`.

    Examples
    --------
    >>> print(FormatError("walk.amc", 7, "3 numbers for 'lfemur'", "2"))
    walk.amc, line 7: expected 3 numbers for 'lfemur', got 2
    """

    def __init__(
        self, path: str | Path, line: int | None, expected: str, got: str, *, remedy: Remedy | None = None
    ) -> None:
        self.path = Path(path)
        self.line = line
        self.expected = expected
        self.got = got
        super().__init__(path, line, expected, got, remedy=remedy)

    def problem(self) -> str:
        """Return the message without the remedy."""
        place = printable(self.path) + ("" if self.line is None else f", line {self.line}")
        expected = shortened(self.expected, 110)
        return f"{place}: expected {expected}, got {shortened(self.got, min(80, 165 - len(expected)))}"


class SkeletonMismatch(MocapError):
    """Two motions, or a motion and a skeleton, do not have the same joints."""


class NoWalk(MocapError):
    """The graph has no walk as requested."""


def requirement(extra: str) -> str:
    """Return the requirement of this package with an extra for pip, by its name or as a local checkout.

    Examples
    --------
    >>> requirement("video") in ("motion-graphs[video]", ".[video]")
    True
    """
    from importlib.metadata import distributions  # imported here, because it is slow

    # An installation from a folder has this record.
    installed = distributions(name="motion-graphs")
    noted = [distribution.read_text("direct_url.json") or "" for distribution in installed]
    local = all("dir_info" in note for note in noted)
    return f"{'.' if local else 'motion-graphs'}[{extra}]"


def missing(need: str, extra: str) -> MocapError:
    """Return the error for a missing extra, with the command to install it, quoted for any shell.

    Examples
    --------
    >>> print(str(missing("Films need imageio-ffmpeg", "video")).replace('".[', '"motion-graphs['))
    Films need imageio-ffmpeg: pip install "motion-graphs[video]".
    """
    return MocapError(f'{need}: pip install "{requirement(extra)}".')


class MocapWarning(UserWarning):
    """A request is met only in part. The message describes the part."""


def warn(sentence: str) -> None:
    """Issue a `MocapWarning` for the line that called this package."""
    frame = sys._getframe()
    level = 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("mocap."):
        frame = frame.f_back
        level += 1
    warnings.warn(printable(sentence), MocapWarning, stacklevel=level)
