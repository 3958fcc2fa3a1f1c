"""Paths from files: a table of points as .csv, or the first line drawn in an .svg picture."""

import re
from collections.abc import Iterator
from itertools import takewhile
from math import comb
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import FormatError, MocapError, shortened
from mocap.files.text import check_above_0, load_rows, read_text, to_numbers

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
BETWEEN = " ,\t\n"  # what parts numbers, besides their signs
WORD = re.compile(rf"{NUMBER.pattern}|[^{BETWEEN}]")
TAKES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}  # numbers
MOST = 500_000  # points, each of a millimetre in half a kilometre
T = np.linspace(0, 1, 33)[1:]  # a curve becomes 32 straight pieces
CURVES = {n: np.stack([comb(n, k) * (1 - T) ** (n - k) * T**k for k in range(n + 1)], axis=1) for n in (2, 3)}
ARC_SHARES = np.linspace(0, 1, 129)[1:]
DRAWN = {"path": "{d}", "polyline": "M {points}", "polygon": "M {points} Z", "line": "M {x1} {y1} {x2} {y2}"}
UNDRAWN = {"clipPath", "defs", "marker", "mask", "pattern", "symbol"}


def load_path(path: str | Path, *, scale: float | None = None) -> GroundPath:
    """Read a path to walk along.

    A `.csv` file has a point in each line, x and z, separated by commas, semicolons or blanks; a first line
    that names the columns is skipped. Of an `.svg` picture the first `path`, `polyline`, `polygon` or `line`
    that is shown is taken, with its `transform` and those of the groups around it. The picture is the ground
    seen from above: right is -x, top is +z.

    Parameters
    ----------
    path : the file.
    scale : metres in a unit of the file; by default 1 for `.csv`, and 0.01 for `.svg`.

    Returns
    -------
    The path, with 32 pieces for each curve, and 128 for each arc.

    Raises
    ------
    MocapError : for a file that is missing or of another format.
    FormatError : for one that breaks its format, or draws what is not read here.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "corner.svg")
    ...     _ = file.write_text('<svg><path d="M 0 0 V -300 H -400"/></svg>')
    ...     load_path(file).points.tolist()
    [[0.0, 0.0], [0.0, 3.0], [4.0, 3.0]]
    """
    path = Path(path)
    check_above_0(scale=scale)
    match path.suffix.lower():
        case ".csv":
            points = (scale or 1.0) * load_rows(path)
        case ".svg":
            points = 0.0 - (scale or 0.01) * _read_svg(path)  # no -0.0
        case _:
            raise MocapError(f"Cannot read a path from {path}: give a .csv or .svg file.")
    if len(points) < 2:
        raise FormatError(path, None, "a line through two points or more", f"{len(points)}")
    try:
        return GroundPath(points)
    except MocapError as error:
        raise MocapError(f"{path}: {error}") from None


@np.errstate(over="ignore", invalid="ignore")  # `GroundPath` refuses what is not finite
def _read_svg(path: Path) -> Array:
    """Find the first line drawn (n, 2), in the picture's units: x to the right, y down."""
    try:
        root = ElementTree.fromstring(read_text(path))
    except ElementTree.ParseError as error:
        raise FormatError(path, error.position[0], "an SVG picture", str(error)) from None
    waiting = [(root, np.eye(3))]  # elements in the order of drawing, from the end; what places them
    while waiting:
        element, matrix = waiting.pop()
        kind = element.tag.rpartition("}")[2]
        style = "".join(element.get("style", "").split())
        hidden = element.get("display") == "none" or "display:none" in style.split(";")
        if kind in UNDRAWN or hidden:
            continue
        matrix = _transformed(path, matrix, element.get("transform", ""))
        if kind in DRAWN:
            got = {"points": "", "d": "", **dict.fromkeys(("x1", "y1", "x2", "y2"), "0"), **element.attrib}
            corners = _outline(path, DRAWN[kind].format_map(got), kind)
            return np.asarray(corners @ matrix[:2, :2].T + matrix[:2, 2])
        waiting += [(child, matrix) for child in reversed(element)]
    raise FormatError(path, None, "a path, polyline, polygon or line", "none")


def _transformed(path: Path, matrix: Array, text: str) -> Array:
    """Multiply a matrix (3, 3) by the steps of a `transform`, of which the last comes first."""
    *steps, rest = text.split(")")
    if rest.strip(BETWEEN):
        raise FormatError(path, None, "a transform", f"'{rest.strip(BETWEEN)}'")
    for step in steps:
        name, _, arguments = step.strip(BETWEEN).partition("(")
        words = NUMBER.findall(arguments)
        if NUMBER.sub("", arguments).strip(BETWEEN):
            raise FormatError(path, None, "numbers of a transform", f"'{arguments.strip(BETWEEN)}'")
        numbers = to_numbers(path, None, words, "numbers of a transform", len(words))
        match name.strip(), numbers.tolist():
            case "matrix", [a, b, c, d, e, f]:
                rows = [[a, c, e], [b, d, f]]
            case "translate", [x, *more] if len(more) < 2:
                rows = [[1, 0, x], [0, 1, *(more or [0])]]
            case "scale", [x, *more] if len(more) < 2:
                rows = [[x, 0, 0], [0, *(more or [x]), 0]]
            case "rotate", [angle, *about] if len(about) in (0, 2):
                c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
                x, y = about or (0, 0)
                rows = [[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y]]
            case _:
                raise FormatError(path, None, "a transform", f"'{step.strip(BETWEEN)})'")
        matrix = matrix @ [*rows, [0, 0, 1]]
    return matrix


def _outline(path: Path, text: str, kind: str) -> Array:
    """Follow the pen of a path's `d` along its first stroke; curves become short straight pieces."""
    here = start = control = 0j  # x + iy
    points: list[complex] = []
    before = ""
    for letter, numbers in _commands(path, text, kind):
        kind, base = letter.upper(), here if letter.islower() else 0j
        if len(points) > MOST:
            raise FormatError(path, None, f"a line of {MOST:,} points at most", "more")
        if kind == "H":
            numbers = [numbers[0], here.imag - base.imag]
        elif kind == "V":
            numbers = [here.real - base.real, numbers[0]]
        end = start if kind == "Z" else base + complex(*numbers[-2:])
        if kind == "M":
            if len(points) > 1:
                break  # a second stroke
            points.clear()
            start = end
        elif kind == "A":
            points += _arc(here, numbers, end)[:-1]
        elif kind in "CSQT":
            corners = [base + complex(*pair) for pair in zip(numbers[::2], numbers[1::2], strict=True)]
            if kind in "ST":  # the control point not given mirrors the last one
                smooth = before in ("CS" if kind == "S" else "QT")
                corners.insert(0, 2 * here - control if smooth else here)
            control = corners[-2]
            points += (CURVES[len(corners)] @ [here, *corners])[:-1].tolist()
        points.append(end)
        here, before = end, kind
    return np.array(points).view(float).reshape(-1, 2)


def _commands(path: Path, text: str, kind: str) -> Iterator[tuple[str, list[float]]]:
    """Split a path's `d` into commands with as many numbers as each takes; repeated ones need no letter."""
    words, letter, at = WORD.findall(text), "", 0
    if words[:1] not in (["M"], ["m"]):
        raise FormatError(path, None, "a path that starts with 'M'", f"'{text[:99]}'")
    while at < len(words):
        if words[at].isalpha() or letter in "zZ":
            letter, at = words[at], at + 1
            if letter.upper() not in TAKES:
                raise FormatError(path, None, f"the commands {' '.join(TAKES)}", f"'{shortened(letter, 40)}'")
        count = TAKES[letter.upper()]
        found = list(takewhile(lambda word: not word.isalpha(), words[at : at + count]))
        whom = f"'{letter}'" if kind == "path" else f"each point of a {kind}"
        numbers = to_numbers(path, None, found, f"{count} numbers for {whom}", count)
        if count == 7 and not set(numbers[3:5]) <= {0, 1}:
            raise FormatError(path, None, f"flags 0 or 1 for '{letter}'", f"'{' '.join(found)}'")
        at += count
        yield letter, numbers.tolist()
        letter = {"M": "L", "m": "l"}.get(letter, letter)


def _arc(here: complex, numbers: list[float], end: complex) -> list[complex]:
    """Draw an elliptic arc from its end points, without the first [SVG 1.1, F.6.5 and F.6.6]."""
    rx, ry, tilt, large, sweep = abs(numbers[0]), abs(numbers[1]), *numbers[2:5]
    if rx * ry == 0 or here == end:
        return [end]
    # Upright and divided by its radii, as complex numbers x + iy, the ellipse is a circle of radius 1.
    tilted = np.exp(1j * np.radians(tilt))
    upright = np.array([here, end]) / tilted
    first, last = upright.real / rx + 1j * upright.imag / ry
    half = (last - first) / 2
    grow = max(1.0, abs(half))  # where the radii are too short to reach
    aside = 1j * half / abs(half) * np.sqrt(grow**2 - abs(half) ** 2)
    centre = (first + last) / 2 + (aside if large != sweep else -aside)
    angle = np.angle((last - centre) / (first - centre)) % (2 * np.pi) - (0 if sweep else 2 * np.pi)
    circle = centre + (first - centre) * np.exp(1j * angle * ARC_SHARES)
    ellipse: list[complex] = ((circle.real * rx + 1j * circle.imag * ry) * tilted).tolist()
    return [*ellipse[:-1], end]
