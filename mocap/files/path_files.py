"""Paths from files: a table of points as .csv, or the first line drawn in an .svg picture."""

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import FormatError, MocapError
from mocap.files.text import read_text, to_numbers

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
TAKES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
STEPS = 32  # straight pieces that a curve is drawn as
# The two flags of an arc are one digit each, and what follows may touch them.
ARGUMENTS = {
    letter: re.compile(
        "".join(rf"[\s,]*({'[01]' if letter == 'A' and n in (3, 4) else NUMBER})" for n in range(count))
        + r"[\s,]*"
    )
    for letter, count in TAKES.items()
}
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

    Raises
    ------
    MocapError : for a file that is missing or of another format.
    FormatError : for one that breaks its format, or draws what is not read here.

    Notebook: 08-path-synthesis
    """
    path = Path(path)
    if scale is not None and not (np.isfinite(scale) and scale > 0):
        raise MocapError(f"scale must be a number above 0, got {scale}.")
    match path.suffix.lower():
        case ".csv":
            return _on_ground(path, (scale or 1.0) * _read_csv(path))
        case ".svg":
            return _on_ground(path, -(scale or 0.01) * _read_svg(path))
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


def _read_svg(path: Path) -> Array:
    """Find the first line drawn, in the picture's units: x to the right, y down."""
    try:
        root = ElementTree.fromstring(read_text(path))
    except ElementTree.ParseError as error:
        raise FormatError(path, error.position[0], "an SVG picture", str(error)) from None
    for points, matrix in _drawn(path, root, np.eye(3)):
        return np.asarray(points @ matrix[:2, :2].T + matrix[:2, 2])
    raise FormatError(path, None, "a path, polyline, polygon or line", "none")


def _drawn(path: Path, element: ElementTree.Element, matrix: Array) -> Iterator[tuple[Array, Array]]:
    """Give the lines of an element and those within it, (n, 2), and the matrix (3, 3) that places each."""
    kind = element.tag.rpartition("}")[2]
    if kind in UNDRAWN:
        return
    matrix = matrix @ _transform(path, element.get("transform", ""))
    if kind == "path":
        yield np.array(list(_outline(path, element.get("d", "")))), matrix
    elif kind in ("polyline", "polygon"):
        points = np.array([float(n) for n in re.findall(NUMBER, element.get("points", ""))])
        points = points[: len(points) // 2 * 2].reshape(-1, 2)
        yield np.vstack([points, points[:1]]) if kind == "polygon" else points, matrix
    elif kind == "line":
        ends = [float(element.get(name, "0")) for name in ("x1", "y1", "x2", "y2")]
        yield np.array(ends).reshape(2, 2), matrix
    for child in element:
        yield from _drawn(path, child, matrix)


def _transform(path: Path, text: str) -> Array:
    """Multiply up the steps of a `transform`, of which the last comes first."""
    matrix = np.eye(3)
    if not re.fullmatch(r"(\s*\w+\s*\([^()]*\)[\s,]*)*", text):
        raise FormatError(path, None, "a transform", f"'{text[:40]}'")
    for name, numbers in re.findall(r"(\w+)\s*\(([^()]*)\)", text):
        match name, [float(number) for number in re.findall(NUMBER, numbers)]:
            case "matrix", [a, b, c, d, e, f]:
                step = [[a, c, e], [b, d, f]]
            case "translate", [x, *more] if len(more) < 2:
                step = [[1, 0, x], [0, 1, *(more or [0])]]
            case "scale", [x, *more] if len(more) < 2:
                step = [[x, 0, 0], [0, *(more or [x]), 0]]
            case "rotate", [angle, *about] if len(about) in (0, 2):
                c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
                x, y = about or (0, 0)
                step = [[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y]]
            case "skewX", [angle]:
                step = [[1, np.tan(np.radians(angle)), 0], [0, 1, 0]]
            case "skewY", [angle]:
                step = [[1, 0, 0], [np.tan(np.radians(angle)), 1, 0]]
            case _:
                raise FormatError(path, None, "a transform", f"'{name}({numbers})'")
        matrix = matrix @ [*step, [0, 0, 1]]
    return matrix


def _outline(path: Path, text: str) -> Iterator[Array]:
    """Follow the pen of a path's `d`: its first stroke, curves as short straight pieces."""
    here = start = control = np.zeros(2)
    before = ""
    for letter, numbers in _commands(path, text):
        kind, base = letter.upper(), here if letter.islower() else np.zeros(2)
        if kind == "M" and before:
            return  # a second stroke
        points = _absolute(kind, numbers, here, base)
        if kind in "ST":  # the control point not given mirrors the last one
            smooth = before in ("CS" if kind == "S" else "QT")
            points = np.vstack([2 * here - control if smooth else here, points])
        if kind == "Z":
            points = start[None]
        if kind == "M":
            start = points[0]
        control = points[-2] if kind in "CSQT" else points[-1]
        if kind in "CSQT":
            points = _bezier(np.vstack([here, points]))
        if kind == "A":
            points = _arc(here, numbers, points[-1])
        yield from points
        here, before = points[-1], kind


def _absolute(kind: str, numbers: Array, here: Array, base: Array) -> Array:
    """Turn a command's numbers into points (n, 2)."""
    if kind == "H":
        return np.array([[numbers[0] + base[0], here[1]]])
    if kind == "V":
        return np.array([[here[0], numbers[0] + base[1]]])
    return np.asarray((numbers[-2:] if kind == "A" else numbers).reshape(-1, 2) + base)


def _commands(path: Path, text: str) -> Iterator[tuple[str, Array]]:
    """Split a path's `d` into commands with as many numbers as each takes; repeated ones need no letter."""
    rest, letter = text.lstrip(), ""
    if not rest.startswith(("M", "m")):
        raise FormatError(path, None, "a path that starts with 'M'", f"'{text[:40]}'")
    while rest:
        if rest[0].isalpha():
            letter, rest = rest[0], rest[1:]
        elif letter in "MmZz":
            letter = {"M": "L", "m": "l"}.get(letter, "")
        if letter.upper() not in TAKES:
            raise FormatError(path, None, f"the commands {' '.join(TAKES)}", f"'{letter or rest[:40]}'")
        found = ARGUMENTS[letter.upper()].match(rest)
        if found is None:
            count = TAKES[letter.upper()]
            raise FormatError(path, None, f"{count} numbers for '{letter}'", f"'{rest[:40].strip()}'")
        yield letter, np.array(found.groups(), float)
        rest = rest[found.end() :]


def _bezier(points: Array) -> Array:
    """Draw a Bézier curve of any degree (de Casteljau), without its first point."""
    t = np.linspace(0, 1, STEPS + 1)[1:, None, None]
    curve = np.broadcast_to(points, (STEPS, *points.shape))
    while curve.shape[1] > 1:
        curve = (1 - t) * curve[:, :-1] + t * curve[:, 1:]
    return np.asarray(curve[:, 0])


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
    circle = centre + (first - centre) * np.exp(1j * angle * np.linspace(0, 1, 4 * STEPS + 1)[1:])
    ellipse = (circle.real * rx + 1j * circle.imag * ry) * tilted
    return np.vstack([np.stack([ellipse.real, ellipse.imag], axis=1)[:-1], end])
