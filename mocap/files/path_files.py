"""Paths from files: a table of points as .csv, or the first line drawn in an .svg picture."""

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.interpolate import BPoly

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import FormatError, MocapError
from mocap.files.text import read_text, to_numbers

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
BETWEEN = " ,\t\n"  # what parts numbers, besides their signs
TAKES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}  # numbers
_NEXT = rf"(?>{NUMBER.pattern})[{BETWEEN}]*+"  # a whole number, and what parts it from the next
ARC = re.compile(rf"[{BETWEEN}]*+({_NEXT * 3})([01])[{BETWEEN}]*+([01])[{BETWEEN}]*+({_NEXT * 2})")
CURVE = np.linspace(0, 1, 33)[1:]  # a curve becomes 32 straight pieces
DRAWN = {"path", "polyline", "polygon", "line"}
UNDRAWN = {"clipPath", "defs", "marker", "mask", "pattern", "symbol"}


def load_path(path: str | Path, *, scale: float | None = None) -> GroundPath:
    """Read a path to walk along.

    A `.csv` file has a point in each line, x and z, separated by commas, semicolons or blanks; a first line
    that names the columns is skipped. Of an `.svg` picture the first `path`, `polyline`, `polygon` or `line`
    is taken, with its `transform` and those of the groups around it; the picture is the ground seen from
    above, so its right is -x and its top +z.

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

    Notebook: 08-path-synthesis
    """
    path = Path(path)
    if scale is not None and not (np.isfinite(scale) and scale > 0):
        raise MocapError(f"scale must be a number above 0, got {scale}.")
    match path.suffix.lower():
        case ".csv":
            return _on_ground(path, (scale or 1.0) * _read_csv(path))
        case ".svg":
            return _on_ground(path, 0.0 - (scale or 0.01) * _read_svg(path))  # no -0.0
    raise MocapError(f"Cannot read a path from {path}: give a .csv or .svg file.")


def _on_ground(path: Path, points: Array) -> GroundPath:
    try:
        return GroundPath(points)
    except MocapError as error:
        raise MocapError(f"{path}: {error}") from None


def _read_csv(path: Path) -> Array:
    rows: list[Array] = []
    for number, line in enumerate(read_text(path).split("\n"), 1):
        words = re.split(r"\s*[,;]\s*|\s+", line.partition("#")[0].strip())
        if words == [""] or (not rows and not re.search(r"\d", line)):
            continue
        rows.append(to_numbers(path, number, words, "x and z", 2))
    return np.array(rows).reshape(-1, 2)


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
        if kind in UNDRAWN:
            continue
        matrix = _transformed(path, matrix, element.get("transform", ""))
        if kind in DRAWN:
            return np.asarray(_corners(path, kind, element) @ matrix[:2, :2].T + matrix[:2, 2])
        waiting += [(child, matrix) for child in reversed(element)]
    raise FormatError(path, None, "a path, polyline, polygon or line", "none")


def _transformed(path: Path, matrix: Array, text: str) -> Array:
    """Multiply a matrix (3, 3) by the steps of a `transform`, of which the last comes first."""
    *steps, rest = text.split(")")
    if rest.strip(BETWEEN):
        raise FormatError(path, None, "a transform", f"'{rest.strip(BETWEEN)}'")
    for step in steps:
        name, _, arguments = step.strip(BETWEEN).partition("(")
        match name.strip(), _numbers(path, arguments, "numbers of a transform").tolist():
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
            case "skewX", [angle]:
                rows = [[1, np.tan(np.radians(angle)), 0], [0, 1, 0]]
            case "skewY", [angle]:
                rows = [[1, 0, 0], [np.tan(np.radians(angle)), 1, 0]]
            case _:
                raise FormatError(path, None, "a transform", f"'{step.strip(BETWEEN)})'")
        matrix = matrix @ [*rows, [0, 0, 1]]
    return matrix


def _numbers(path: Path, text: str, expected: str) -> Array:
    """Read the numbers of an attribute; commas, blanks or signs part them."""
    words = NUMBER.findall(text)
    if NUMBER.sub("", text).strip(BETWEEN):
        raise FormatError(path, None, expected, f"'{text.strip(BETWEEN)}'")
    return to_numbers(path, None, words, expected, len(words))


def _corners(path: Path, kind: str, element: ElementTree.Element) -> Array:
    """List the points (n, 2) of one line drawn."""
    if kind == "path":
        return _outline(path, element.get("d", ""))
    if kind == "line":
        text = " ".join(element.get(name, "0") for name in ("x1", "y1", "x2", "y2"))
    else:
        text = element.get("points", "")
    numbers = _numbers(path, text, f"numbers for a {kind}")
    if len(numbers) % 2 or (kind == "line" and len(numbers) != 4):
        raise FormatError(path, None, f"x and y for each point of a {kind}", f"{len(numbers)} numbers")
    points = numbers.reshape(-1, 2)
    return np.vstack([points, points[:1]]) if kind == "polygon" else points


def _outline(path: Path, text: str) -> Array:
    """Follow the pen of a path's `d` along its first stroke; curves become short straight pieces."""
    here = start = control = np.zeros(2)
    pieces: list[Array] = []
    before = ""
    for letter, numbers in _commands(path, text):
        kind, base = letter.upper(), here if letter.islower() else np.zeros(2)
        match kind:
            case "M" if pieces:
                break  # a second stroke
            case "H":
                points = np.array([[base[0] + numbers[0], here[1]]])
            case "V":
                points = np.array([[here[0], base[1] + numbers[0]]])
            case "Z":
                points = start[None]
            case "A":
                points = _arc(here, numbers, base + numbers[5:])
            case _:
                points = base + numbers.reshape(-1, 2)
        if kind in "ST":  # the control point not given mirrors the last one
            smooth = before in ("CS" if kind == "S" else "QT")
            points = np.vstack([2 * here - control if smooth else here, points])
        if kind == "M":
            start = points[0]
        if kind in "CSQT":
            control = points[-2]
            points = BPoly(np.vstack([here, points])[:, None], [0.0, 1.0])(CURVE)
        pieces.append(points)
        here, before = points[-1], kind
    return np.vstack(pieces)


def _commands(path: Path, text: str) -> Iterator[tuple[str, Array]]:
    """Split a path's `d` into commands with as many numbers as each takes; repeated ones need no letter."""
    blank, *parts = re.split(r"([A-DF-Za-df-z])", text)  # an e belongs to a number
    if blank.strip(BETWEEN) or parts[:1] not in (["M"], ["m"]):
        raise FormatError(path, None, "a path that starts with 'M'", f"'{text}'")
    for letter, arguments in zip(parts[::2], parts[1::2], strict=True):
        if letter.upper() not in TAKES:
            raise FormatError(path, None, f"the commands {' '.join(TAKES)}", f"'{letter}'")
        count = TAKES[letter.upper()]
        if count == 7:  # the two flags of an arc may stand without anything between: 01
            arguments = _parted(arguments)
        numbers = _numbers(path, arguments, f"numbers for '{letter}'")
        blocks = len(numbers) // count if count else 1
        if blocks == 0 or blocks * count != len(numbers):
            expected = f"{count} numbers for '{letter}'"
            raise FormatError(path, None, expected, f"'{arguments.strip(BETWEEN)}'")
        for block in numbers.reshape(blocks, count):
            if count == 7 and not set(block[3:5]) <= {0, 1}:
                raise FormatError(path, None, f"flags 0 or 1 for '{letter}'", f"'{arguments.strip(BETWEEN)}'")
            yield letter, block
            letter = {"M": "L", "m": "l"}.get(letter, letter)


def _parted(arguments: str) -> str:
    """Put blanks around the flags of arcs, as far as arcs can be read."""
    parts: list[str] = []
    at = 0
    while found := ARC.match(arguments, at):
        parts += found.groups()
        at = found.end()
    return " ".join([*parts, arguments[at:]])


def _arc(here: Array, numbers: Array, end: Array) -> Array:
    """Draw an elliptic arc from its end points, without the first [SVG 1.1, F.6.5 and F.6.6]."""
    (rx, ry), (tilt, large, sweep) = np.abs(numbers[:2]), numbers[2:5]
    if rx * ry == 0 or (here == end).all():
        return end[None]
    # Upright and divided by its radii, as complex numbers x + iy, the ellipse is a circle of radius 1.
    tilted = np.exp(1j * np.radians(tilt))
    upright = np.array([complex(*here), complex(*end)]) / tilted
    first, last = upright.real / rx + 1j * upright.imag / ry
    half = (last - first) / 2
    grow = max(1.0, abs(half))  # where the radii are too short to reach
    aside = 1j * half / abs(half) * np.sqrt(grow**2 - abs(half) ** 2)
    centre = (first + last) / 2 + (aside if large != sweep else -aside)
    angle = np.angle((last - centre) / (first - centre)) % (2 * np.pi) - (0 if sweep else 2 * np.pi)
    circle = centre + (first - centre) * np.exp(1j * angle * np.linspace(0, 1, 129)[1:])
    ellipse = (circle.real * rx + 1j * circle.imag * ry) * tilted
    return np.vstack([np.stack([ellipse.real, ellipse.imag], axis=1)[:-1], end])
