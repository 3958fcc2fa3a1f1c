"""Text files: read whole or refused, with checks of their lines and numbers, and tables of numbers."""

import math
import re
from collections.abc import Iterator
from contextlib import suppress
from io import StringIO
from itertools import chain
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import FormatError, MocapError, shortened

LARGEST = 1e9  # units of a file: lengths, angles and times of motion files are far below
MOST_POSES = 10_000_000  # of one joint: from here a file must have numbers for them
POSES_PER_NUMBER = 10  # poses that a number of such a file may stand for


def read_text(path: str | Path, *, most: int = -1) -> str:  # reads: name: a keyword that callers write
    r"""Read a text file; all its lines end with "\n" afterwards.

    Text that is not UTF-8 is read as Latin-1, which older exporters wrote.

    Parameters
    ----------
    path : the file.
    most : bytes to read, -1 for all.

    Returns
    -------
    Its text, without a byte order mark.

    Raises
    ------
    MocapError : when the file cannot be opened.
    FormatError : when it is empty, holds zero bytes, or an unresolved merge.

    Examples
    --------
    >>> read_text("nowhere/walk.bvh")
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read nowhere/walk.bvh: No such file or directory.
    """
    try:
        with Path(path).open("rb") as file:
            data = file.read(most)
    except OSError as error:
        raise MocapError(f"Cannot read {path}: {error.strerror}.") from error
    zero = data.find(b"\0")
    if zero >= 0:
        line = data.count(b"\n", 0, zero) + 1
        raise FormatError(path, line, "text", "a zero byte, as in a binary file")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if not text.strip():
        raise FormatError(path, None, "some text", "an empty file")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    marker = f"\n{text}".find("\n<<<<<<< ")
    if marker >= 0:
        line = text.count("\n", 0, marker) + 1
        got = "'<<<<<<<', an unresolved merge: take one of its two versions"
        raise FormatError(path, line, "one version of the file", got)
    return text


def check_room(path: str | Path, poses: int, numbers: int) -> None:
    """Raise if a file has few numbers and many joints without channels: their poses would fill the memory.

    Parameters
    ----------
    poses : the frames times the joints.
    numbers : how many the file holds.

    Raises
    ------
    FormatError : for more than 10 million poses of one joint, and less than one number per ten of them.
    """
    if poses > MOST_POSES and poses > POSES_PER_NUMBER * numbers:
        raise FormatError(path, None, "numbers for at least a tenth of the joints", f"{numbers} for {poses}")


def check_above_0(**options: float | None) -> None:
    """Raise unless each option is None, or finite and above 0."""
    for name, value in options.items():
        if value is not None and not (math.isfinite(value) and value > 0):
            raise MocapError(f"{name} must be a number above 0, got {value}.")


def lines(text: str) -> Iterator[tuple[int, list[str]]]:
    r"""Yield the number (from 1) and the words of each line that has words; `#` starts a comment.

    Examples
    --------
    >>> list(lines("1  # first frame\n\nroot 0 1.5"))
    [(1, ['1']), (3, ['root', '0', '1.5'])]
    """
    for number, line in enumerate(StringIO(text), 1):  # no list of a million lines
        if words := (line.partition("#")[0] if "#" in line else line).split():
            yield number, words


def to_numbers(path: str | Path, line: int | None, words: list[str], expected: str, count: int) -> Array:
    """Convert words to numbers, all finite and below 10⁹.

    Parameters
    ----------
    path, line, expected : for the error.
    words : the words of the file.
    count : how many there must be.

    Returns
    -------
    The numbers, shape (len(words),).

    Raises
    ------
    FormatError : for another count of words, a word that is no number, or a number that is too large.

    Examples
    --------
    >>> to_numbers("a.bvh", 3, ["1.5", "7.6e-016"], "2 numbers", 2)
    array([1.5e+00, 7.6e-16])
    """
    if len(words) != count:
        raise FormatError(path, line, expected, str(len(words)))
    numbers = quick_numbers(words)
    if numbers is not None:
        return numbers
    position, word = next((n, word) for n, word in enumerate(words, 1) if quick_numbers([word]) is None)
    with suppress(ValueError):
        float(word)  # it is a number, but a large one
        expected = f"{expected}, all below {LARGEST:g}"
    got = f"'{shortened(word, 40)}'"
    if count > 1:
        got = f"{got} as number {position}"
    raise FormatError(path, line, expected, got)


def quick_numbers(words: list[str]) -> Array | None:
    """Convert many words to numbers, or return None if one of them is no finite number below 10⁹.

    Examples
    --------
    >>> quick_numbers(["1.5", "2"])
    array([1.5, 2. ])
    >>> quick_numbers(["1.5", "nan"])
    """
    try:
        numbers = np.array(words, float)
    except ValueError:
        return None
    return numbers if np.all(np.abs(numbers) < LARGEST) else None


def load_rows(path: str | Path, names: tuple[str, ...] = ("x", "z")) -> Array:
    r"""Read a table of numbers from a `.csv` file as people write it, one row per line.

    Numbers are separated by commas, semicolons or blanks. Lines without numbers at the start are a heading,
    and what follows a # is left out.

    Parameters
    ----------
    path : the file.
    names : of the columns, for errors.

    Returns
    -------
    Shape (rows, columns); numbers may be infinite or NaN.

    Raises
    ------
    FormatError, MocapError : for a file that cannot be read, a line with more or fewer numbers, and no line.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "discs.csv")
    ...     _ = file.write_text("x, z, radius\n1, 2, 0.5  # a stone\n")
    ...     load_rows(file, ("x", "z", "radius"))
    array([[1. , 2. , 0.5]])
    """
    rows: list[Array] = []
    example = ", ".join(("1.5", "2", "0.5")[: len(names)])
    expected = f"{', '.join(names[:-1])} and {names[-1]} in each line, such as '{example}'"
    for number, words in lines(read_text(path)):
        line = " ".join(words)
        if rows or re.search(r"\d", line):
            rows.append(to_numbers(path, number, _cells(line), expected, len(names)))
    if not rows:
        raise FormatError(path, None, expected, "no numbers")
    return np.array(rows)


def _cells(line: str) -> list[str]:
    """Split a row of a table; nothing between two commas is an empty cell."""
    parts = [part.split() or [""] for part in line.replace(";", ",").split(",")]
    return [*chain.from_iterable(parts)]
