"""The lines of one element of an SVG picture, as points in the coordinates of the element [SVG11, 8.3 and 9].

The library svgelements draws the commands of a path, circles, ellipses and rectangles. It ignores what it
cannot read, so that commands and numbers are checked here first. The `d` of a path is a text such as
"M 0 0 L 10 0 q 5 0 5 5": a letter for each command, and its numbers.
"""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import svgelements

from mocap._shared.arrays import Array
from mocap.errors import FormatError, Remedy
from mocap.files.text import to_numbers

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
SEPARATORS = " ,\t\n"  # of numbers (a sign also begins a new number)
WORD = re.compile(rf"{NUMBER.pattern}|[^{SEPARATORS}]")
LENGTH = re.compile(rf"\s*({NUMBER.pattern})(|px|pt|pc|mm|cm|in|%)\s*")
LETTER = re.compile("([A-DF-Za-df-z])")  # of a command: an e is in numbers

COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}  # numbers
# What is written between two commands, so that the second is no smooth continuation of the first.
BEFORE = dict.fromkeys([("C", "T"), ("S", "T"), ("Q", "S"), ("T", "S")], "l 0 0")
GAP = rf"[{SEPARATORS}]*+"
_VALUE = f"((?>{NUMBER.pattern}))"
ARC = re.compile(GAP + GAP.join([_VALUE, _VALUE, _VALUE, "([01])", "([01])", _VALUE, _VALUE]))

SHAPES = {
    "circle": (svgelements.Circle, ("cx", "cy", "r")),
    "ellipse": (svgelements.Ellipse, ("cx", "cy", "rx", "ry")),
    "line": (svgelements.SimpleLine, ("x1", "y1", "x2", "y2")),
    "rect": (svgelements.Rect, ("x", "y", "width", "height", "rx", "ry")),
}
DRAWN = {"path", "polyline", "polygon", *SHAPES}  # the elements that draw lines

MOST_POINTS = 500_000  # half a kilometre with a point in every millimetre
LINE = np.ones(1)
CURVE = np.linspace(0, 1, 33)[1:]  # ends of the line segments of a curve
FRACTIONS = {
    svgelements.QuadraticBezier: CURVE,
    svgelements.CubicBezier: CURVE,
    svgelements.Arc: np.linspace(0, 1, 129)[1:],
}
JOINED = 0.01  # units: a stroke that starts so near the end of the last one continues it


def strokes(
    file: Path, kind: str, attributes: Mapping[str, str], page: tuple[float, float], limit: int = MOST_POINTS
) -> list[Array]:
    """Return the strokes of an element, each the points (N, 2) of a line, x to the right and y down.

    Parameters
    ----------
    file : for errors.
    kind : the name of the element, one of `DRAWN`.
    attributes : its attributes.
    page : width and height of the page, for lengths in per cent.
    limit : the largest number of points.

    Raises
    ------
    FormatError : for attributes that break the format, and for too many points.

    Examples
    --------
    >>> strokes(Path("a.svg"), "path", {"d": "M 0 0 h 3 v 4 z"}, (10, 10))[0].tolist()
    [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 0.0]]
    """
    try:
        match kind:
            case "polyline" | "polygon":
                return _corners(file, kind, attributes.get("points", ""), limit)
            case "path":
                drawn = svgelements.Path(" ".join(_commands(file, attributes.get("d", ""), limit)))
            case _:
                drawn = svgelements.Path(_shape(file, kind, attributes, page))
        with np.errstate(all="ignore"):  # `GroundPath` rejects infinite and NaN values
            return _sampled(file, drawn, limit)
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError(file, None, f"a {kind} that can be drawn", "numbers out of range") from None


def lengths(file: Path, kind: str, attributes: Mapping[str, str], names: tuple[str, ...]) -> dict[str, str]:
    """Return those attributes of an element that are lengths, and raise for one that is none."""
    texts = {name: attributes[name] for name in names if attributes.get(name, "auto") != "auto"}
    for name, text in texts.items():
        match = LENGTH.fullmatch(text)
        if not match:
            raise FormatError(file, None, f"a length for '{name}' of a {kind}", f"'{text}'")
        to_numbers(file, None, [match[1]], f"a length for '{name}' of a {kind}", 1)
    return texts


def _corners(file: Path, kind: str, text: str, limit: int) -> list[Array]:
    """Return the line of a polyline or polygon."""
    words = WORD.findall(text)
    expected = f"2 numbers for each point of a {kind}"
    if len(words) % 2:
        raise FormatError(file, None, expected, "1")
    if len(words) > 2 * limit:
        raise too_many(file)
    points = to_numbers(file, None, words, expected, len(words)).reshape(-1, 2)
    if kind == "polygon":
        points = np.concatenate([points, points[:1]])
    return [points] if len(points) else []


def _shape(
    file: Path, kind: str, attributes: Mapping[str, str], page: tuple[float, float]
) -> "svgelements.Shape":
    """Return the shape of an element of svgelements, with its lengths in units of the picture."""
    draw, names = SHAPES[kind]
    shape = draw(lengths(file, kind, attributes, names))
    shape.render(ppi=96.0, width=page[0], height=page[1])
    return shape


def _commands(file: Path, text: str, limit: int) -> Iterator[str]:
    """Yield the commands of the `d` of a path, each with its numbers, separated by blanks.

    Two habits of svgelements are avoided: it continues any curve smoothly, not only those of the same degree,
    and it searches the start of a stroke at each "Z", unless a new stroke begins after it.
    """
    previous = ""
    for letter, arguments in _letters(file, text):
        command = letter.upper()
        yield BEFORE.get((previous, command), "m 0 0" if previous == "Z" and command != "M" else "")
        previous = command
        numbers = _numbers(file, letter, arguments).tolist()
        limit -= max(len(numbers), 1) // max(COUNTS[command], 1)
        if limit < 0:
            raise too_many(file)
        yield " ".join([letter, *(f"{number:.17g}" for number in numbers)])


def _letters(file: Path, text: str) -> list[tuple[str, str]]:
    """Return the letter of each command of the `d` of a path, and the text of its numbers."""
    if not text.strip(SEPARATORS):
        return []  # it draws nothing
    start, *parts = LETTER.split(text)
    if start.strip(SEPARATORS) or not parts or parts[0] not in "Mm":
        raise FormatError(file, None, "a path that starts with 'M'", f"'{text[:99]}'")
    unknown = [letter for letter in parts[::2] if letter.upper() not in COUNTS]
    if unknown:
        raise FormatError(file, None, f"the commands {' '.join(COUNTS)}", f"'{unknown[0]}'")
    return [*zip(parts[::2], parts[1::2], strict=True)]


def _numbers(file: Path, letter: str, text: str) -> Array:
    """Return the numbers of a command, which may be repeated without its letter."""
    words = _arc_words(file, letter, text) if letter in "Aa" else WORD.findall(text)
    count = COUNTS[letter.upper()]
    expected = f"{count} numbers for '{letter}'"
    surplus = len(words) % count if count else len(words)
    if surplus or (count and not words):
        raise FormatError(file, None, expected, str(surplus))
    return to_numbers(file, None, words, expected, len(words))


def _arc_words(file: Path, letter: str, text: str) -> list[str]:
    """Return the numbers of arcs. Their flags, 0 or 1, need no blanks between them and what follows."""
    words: list[str] = []
    end = 0
    while arc := ARC.match(text, end):
        words += arc.groups()
        end = arc.end()
    surplus = WORD.findall(text[end:])
    if len(surplus) >= COUNTS["A"]:
        raise FormatError(file, None, f"flags 0 or 1 for '{letter}'", f"'{' '.join(surplus)}'")
    return words + surplus


def _sampled(file: Path, drawn: "svgelements.Path", limit: int) -> list[Array]:
    """Return the strokes of a path, with curves as line segments.

    A stroke that starts at the end of the last one continues it.
    """
    lines: list[list[Sequence[float]]] = []
    count = 0
    for segment in drawn:
        end = (segment.end.x, segment.end.y)
        if isinstance(segment, svgelements.Move):
            if not lines or math.dist(end, lines[-1][-1]) > JOINED:
                lines.append([end])
            continue
        fractions = FRACTIONS.get(type(segment), LINE)
        count += len(fractions)
        if count > limit:
            raise too_many(file)
        if len(fractions) > 1 and segment.start != segment.end:
            lines[-1] += segment.npoint(fractions[:-1]).tolist()
        lines[-1].append(end)
    return [np.array(line, float) for line in lines]


def too_many(file: Path) -> FormatError:
    """Return the error for a picture of too many points."""
    choice = Remedy("choose a line by {}", "id")
    return FormatError(file, None, f"lines of {MOST_POINTS:,} points at most", "more", remedy=choice)
