"""The errors that `mocap` raises on purpose: each is one clear sentence, and says what would help."""

import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple


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


class Remedy(NamedTuple):
    """What helps against an error: a parameter, which a command calls otherwise, or a call in Python.

    Parameters
    ----------
    text : what to do, with {} for the parameter's name.
    parameter : its name in Python; "" for a call, which commands leave out.

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
        """Return what to do, with this name for the parameter."""
        return self.text.replace("{}", name)


class MocapError(ValueError):
    """The base of all errors raised on purpose: the input, not the program, is at fault.

    Parameters
    ----------
    message : the value, and what is needed.
    remedy : the parameter that would help. `str` names it as in Python, a command by its option.

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
        """Return the message for those who know parameters by these names; a remedy without one is left out.

        Parameters
        ----------
        names : the name of each parameter that is available, by its name in Python.
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
    """A file breaks its format: the message gives the line, what the format asks for, and what stands there.

    Without the path, the message is at most 200 characters long, whatever the file holds.

    Parameters
    ----------
    path : the file.
    line : the line's number, from 1; None for the whole file.
    expected, got : what the format asks for, and what the file holds.
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
