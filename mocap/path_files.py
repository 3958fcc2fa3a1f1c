"""Paths from files: a table of points as .csv, or the first line drawn in an .svg picture."""

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from mocap.atomic import read_text, to_numbers
from mocap.errors import FormatError, MocapError
from mocap.paths import GroundPath

Array = NDArray[np.float64]

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
COMMAND = re.compile(rf"[A-Za-z]|{NUMBER}")
TAKES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "Z": 0}
STEPS = 32  # straight pieces that a curve is drawn as


def load_path(path: str | Path, *, scale: float | None = None) -> GroundPath:
    """Read a path to walk along.

    A `.csv` file has a point in each line, x and z, separated by commas, semicolons or blanks; a first line
    that names the columns is skipped. Of an `.svg` picture the first `path`, `polyline`, `polygon` or `line`
    is taken; the picture is the ground seen from above, so its right is -x and its top +z.

    Parameters
    ----------
    path : the file.
    scale : metres in a unit of the file; by default 1 for `.csv`, and 0.01 for `.svg`.

    Raises
    ------
    MocapError : for a file that is missing or of another format.
    FormatError : for one that breaks its format, or draws what is not read here.
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
    if any("transform" in element.attrib for element in root.iter()):
        raise FormatError(path, None, "plain coordinates", "a 'transform': let your editor apply it first")
    for element in root.iter():
        kind = element.tag.rpartition("}")[2]
        if kind == "path":
            return np.array(list(_outline(path, element.get("d", ""))))
        if kind in ("polyline", "polygon"):
            points = np.array([float(n) for n in re.findall(NUMBER, element.get("points", ""))])
            points = points[: len(points) // 2 * 2].reshape(-1, 2)
            return np.vstack([points, points[:1]]) if kind == "polygon" else points
        if kind == "line":
            ends = [float(element.get(name, "0")) for name in ("x1", "y1", "x2", "y2")]
            return np.array(ends).reshape(2, 2)
    raise FormatError(path, None, "a path, polyline, polygon or line", "none")


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
        yield from _bezier(np.vstack([here, points])) if kind in "CSQT" else points
        control = points[-2] if kind in "CSQT" else points[-1]
        here, before = points[-1], kind


def _absolute(kind: str, numbers: Array, here: Array, base: Array) -> Array:
    """Turn a command's numbers into points (n, 2)."""
    if kind == "H":
        return np.array([[numbers[0] + base[0], here[1]]])
    if kind == "V":
        return np.array([[here[0], numbers[0] + base[1]]])
    return np.asarray(numbers.reshape(-1, 2) + base)


def _commands(path: Path, text: str) -> Iterator[tuple[str, Array]]:
    """Split a path's `d` into commands with as many numbers as each takes; repeated ones need no letter."""
    words, letter = COMMAND.findall(text), ""
    if not words or words[0] not in "Mm":
        raise FormatError(path, None, "a path that starts with 'M'", f"'{text[:40]}'")
    while words:
        if words[0].isalpha():
            letter = words.pop(0)
        elif letter in "Mm":
            letter = {"M": "L", "m": "l"}[letter]
        count = TAKES.get(letter.upper())
        if count is None or (count == 0 and words and not words[0].isalpha()):
            raise FormatError(path, None, f"the commands {' '.join(TAKES)}", f"'{letter}': simplify the path")
        numbers, words = words[:count], words[count:]
        if len(numbers) < count or any(word.isalpha() for word in numbers):
            raise FormatError(path, None, f"{count} numbers for '{letter}'", f"'{' '.join(numbers)}'")
        yield letter, np.array(numbers, float)


def _bezier(points: Array) -> Array:
    """Draw a Bézier curve of any degree (de Casteljau), without its first point."""
    t = np.linspace(0, 1, STEPS + 1)[1:, None, None]
    curve = np.broadcast_to(points, (STEPS, *points.shape))
    while curve.shape[1] > 1:
        curve = (1 - t) * curve[:, :-1] + t * curve[:, 1:]
    return np.asarray(curve[:, 0])
