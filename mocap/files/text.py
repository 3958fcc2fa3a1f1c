"""Text files: checked reading of their content, lines and numbers, and of tables of numbers."""

import codecs
import math
import re
from collections.abc import Iterator
from contextlib import suppress
from io import StringIO
from itertools import chain
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import FormatError, MocapError, shortened, warn

LARGEST = 1e9  # units of a file: upper bound of numbers, far above those of any motion
JAPANESE = re.compile("[\u3041-\u30ff\u4e00-\u9fff]{2}")
DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
TWO_COMMAS = re.compile(r"\d,[-+]?\d+,[-+]?\d")  # of a list of integers
DECIMAL_POINT = re.compile(r"\d\.\d")
MOST_POSES = 10_000_000  # poses of single joints: above this, `POSES_PER_NUMBER` is checked
MOST_ROWS = 500_000  # of a table
POSES_PER_NUMBER = 10  # the largest number of poses for each number in such a file


def read_text(path: str | Path, *, most: int = -1) -> str:  # reads: name: a keyword that callers write
    r"""Read a text file, with line ends converted to "\n".

    UTF-8 and UTF-16 are recognised. Other text is decoded as Shift-JIS if that gives Japanese names, and else
    as Latin-1, as written by older exporters.

    Parameters
    ----------
    path : the file.
    most : the largest number of bytes to read, -1 for all.

    Returns
    -------
    The text, without a byte order mark.

    Raises
    ------
    MocapError : if the file cannot be opened.
    FormatError : if it is empty, or contains a zero byte or an unresolved merge.

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
    text = decode(data).rstrip("\x1a")  # the end of a file of DOS
    zero = text.find("\0")
    if zero >= 0:
        line = text.count("\n", 0, zero) + 1
        raise FormatError(path, line, "text", "a zero byte, as in a binary file")
    if not text or text.isspace():
        raise FormatError(path, None, "some text", "an empty file")
    if "\r" in text:  # a search takes a hundredth of the time of a replacement
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    marker = f"\n{text}".find("\n<<<<<<< ")
    if marker >= 0:
        line = text.count("\n", 0, marker) + 1
        got = "'<<<<<<<', an unresolved merge: take one of its two versions"
        raise FormatError(path, line, "one version of the file", got)
    return text


def decode(data: bytes) -> str:
    """Decode a text file by its byte order mark, its zero bytes, or the first encoding that fits.

    Examples
    --------
    >>> [decode("Hüfte".encode(name)) for name in ("utf-8", "utf-16", "latin-1")]
    ['Hüfte', 'Hüfte', 'Hüfte']
    >>> decode("右足".encode("shift-jis"))
    '右足'
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", errors="replace")
    for first, name in ((1, "utf-16-le"), (0, "utf-16-be")):  # letters of UTF-16 without a mark
        if data[first : first + 3 : 2] == b"\0\0":
            return data.decode(name, errors="replace")
    with suppress(UnicodeDecodeError):
        return data.decode("utf-8-sig")
    with suppress(UnicodeDecodeError):
        text = data.decode("shift-jis")
        if JAPANESE.search(text):
            return text
    return data.decode("latin-1")


def with_decimal_points(path: str | Path, text: str) -> str:
    """Return a text of numbers with decimal points if it has decimal commas, and warn of it.

    Examples
    --------
    >>> with_decimal_points("a.bvh", "OFFSET 0.5 1 2")
    'OFFSET 0.5 1 2'
    """
    if "," not in text or DECIMAL_POINT.search(text) or not DECIMAL_COMMA.search(text):
        return text
    warn(f"{path}: its numbers have decimal commas, which are read as points.")
    return DECIMAL_COMMA.sub(".", text)


def without_commas(path: str | Path, text: str, parts: re.Pattern[str]) -> str:
    r"""Return a text whose numbers have decimal points and are separated by blanks, and warn of any change.

    Parameters
    ----------
    path : the file.
    text : of the file.
    parts : matches the parts of the text that hold numbers. In each of them, a comma between two digits is a
        decimal comma, unless the part also has decimal points. All other commas and semicolons separate.

    Examples
    --------
    >>> without_commas("a.bvh", "JOINT a,b\nOFFSET 0.5 1 2", re.compile("OFFSET.*"))
    'JOINT a,b\nOFFSET 0.5 1 2'
    """
    if "," not in text and ";" not in text:
        return text
    used: set[str] = set()

    def changed(part: re.Match[str]) -> str:
        numbers = part[0]
        has_decimal_commas = not (DECIMAL_POINT.search(numbers) or TWO_COMMAS.search(numbers))
        if has_decimal_commas and DECIMAL_COMMA.search(numbers):
            used.add("decimal")
            numbers = DECIMAL_COMMA.sub(".", numbers)
        if "," in numbers or ";" in numbers:
            used.add("separator")
            numbers = numbers.replace(",", " ").replace(";", " ")
        return numbers

    text = parts.sub(changed, text)
    if "decimal" in used:
        warn(f"{path}: its numbers have decimal commas, which are read as points.")
    if "separator" in used:
        warn(f"{path}: its numbers are separated by commas or semicolons, which are read as blanks.")
    return text


def check_room(path: str | Path, poses: int, numbers: int) -> None:
    """Raise if a small file has so many joints without channels that their poses would fill the memory.

    Parameters
    ----------
    poses : the number of frames times the number of joints.
    numbers : the number of numbers in the file.

    Raises
    ------
    FormatError : for more than 10 million poses of one joint, and less than one number per ten of them.
    """
    if poses > MOST_POSES and poses > POSES_PER_NUMBER * numbers:
        raise FormatError(path, None, "numbers for at least a tenth of the joints", f"{numbers} for {poses}")


def check_above_0(**options: float | None) -> None:
    """Raise unless each option is either None or finite and above 0."""
    for name, value in options.items():
        if value is not None and not (math.isfinite(value) and value > 0):
            raise MocapError(f"{name} must be a number above 0, got {value}.")


def lines(text: str) -> Iterator[tuple[int, list[str]]]:
    r"""Yield the number (from 1) and the words of each line that is not blank; `#` starts a comment.

    Examples
    --------
    >>> list(lines("1  # first frame\n\nroot 0 1.5"))
    [(1, ['1']), (3, ['root', '0', '1.5'])]
    """
    for number, line in enumerate(StringIO(text), 1):  # avoids a list of a million lines
        if words := (line.partition("#")[0] if "#" in line else line).split():
            yield number, words


def to_numbers(path: str | Path, line: int | None, words: list[str], expected: str, count: int) -> Array:
    """Convert words to numbers, all finite and below 10⁹.

    Parameters
    ----------
    path, line, expected : as for `FormatError`.
    words : the words of the file.
    count : the expected number of words.

    Returns
    -------
    The numbers, shape (len(words),).

    Raises
    ------
    FormatError : for another number of words, a word that is not a number, or a number that is too large.

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
        float(word)  # it is a number, but too large
        expected = f"{expected}, all below {LARGEST:g}"
    got = f"'{shortened(word, 40)}'"
    if count > 1:
        got = f"{got} as number {position}"
    raise FormatError(path, line, expected, got)


def quick_numbers(words: list[str]) -> Array | None:
    """Convert words to numbers. Return None if one of them is not a finite number below 10⁹.

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
    r"""Read a table of numbers from a `.csv` file, with a row in each line.

    Numbers are separated by commas, semicolons or blanks. Lines without digits at the start are a heading,
    and `#` starts a comment.

    Parameters
    ----------
    path : the file.
    names : the names of the columns, for errors.

    Returns
    -------
    Shape (rows, columns).

    Raises
    ------
    FormatError, MocapError : for a file that cannot be read, a line with another number of columns, numbers
        that are not finite, a file without rows, and one of more than 500 000 lines.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "discs.csv")
    ...     _ = file.write_text("x, z, radius\n1, 2, 0.5  # a stone\n")
    ...     load_rows(file, ("x", "z", "radius"))
    array([[1. , 2. , 0.5]])
    """
    text = read_text(path)
    count = text.count("\n")
    if count > MOST_ROWS:
        raise FormatError(path, None, f"a table of {MOST_ROWS:,} lines at most", f"{count:,}")
    example = ", ".join(("1.5", "2", "0.5")[: len(names)])
    expected = f"{', '.join(names[:-1])} and {names[-1]} in each line, such as '{example}'"
    rows: list[tuple[int, list[str]]] = []
    for number, words in lines(text):
        line = " ".join(words)
        if rows or re.search(r"\d", line):
            rows.append((number, _cells(line)))
    if not rows:
        raise FormatError(path, None, expected, "no numbers")
    if {len(cells) for _, cells in rows} == {len(names)}:
        numbers = quick_numbers([*chain.from_iterable(cells for _, cells in rows)])
        if numbers is not None:
            return numbers.reshape(-1, len(names))
    # A row is broken: the first one is reported.
    return np.array([to_numbers(path, number, cells, expected, len(names)) for number, cells in rows])


def _cells(line: str) -> list[str]:
    """Split a row of a table into cells. Blanks between two commas are an empty cell."""
    parts = [part.split() or [""] for part in line.replace(";", ",").split(",")]
    return [*chain.from_iterable(parts)]
