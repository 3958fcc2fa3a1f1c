"""Paths from files: a table of points as .csv, or the first line drawn in an .svg picture.

Pictures are read without an SVG library, because such libraries skip unknown commands and transforms, which
must be reported here.
"""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import FormatError, MocapError
from mocap.files.svg_strokes import NUMBER, SEPARATORS, first_stroke
from mocap.files.text import check_above_0, load_rows, read_text, to_numbers

# Elements that draw a line, and the `d` of an equivalent path.
DRAWN = {"path": "{d}", "polyline": "M {points}", "polygon": "M {points} Z", "line": "M {x1} {y1} {x2} {y2}"}
DEFAULTS = {"d": "", "points": "", "x1": "0", "y1": "0", "x2": "0", "y2": "0"}  # of their attributes
UNDRAWN = {"clipPath", "defs", "marker", "mask", "pattern", "symbol"}  # drawn only by reference


def load_path(path: str | Path, *, scale: float | None = None) -> GroundPath:
    """Read a path on the ground from a `.csv` or `.svg` file.

    A `.csv` file has a point in each line, x and z, separated by commas, semicolons or blanks. A first line
    with the names of the columns is skipped. Of an `.svg` picture, the first visible `path`, `polyline`,
    `polygon` or `line` is read, with its `transform` and those of its groups. The picture is the ground seen
    from above: right is -x, top is +z.

    Parameters
    ----------
    path : the file.
    scale : metres in a unit of the file, by default 1 for `.csv`, and 0.01 for `.svg`.

    Returns
    -------
    The path, with 32 segments for each curve and 128 for each arc.

    Raises
    ------
    MocapError : for a file that is missing or of another format.
    FormatError : for a file that breaks its format, or contains unsupported commands.

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
            unit = scale or 1.0
            points = unit * load_rows(path)
        case ".svg":
            unit = scale or 0.01
            points = 0.0 - unit * _read_svg(path)  # no -0.0
        case _:
            raise MocapError(f"Cannot read a path from {path}: give a .csv or .svg file.")
    if len(points) < 2:
        raise FormatError(path, None, "a line through two points or more", f"{len(points)}")
    try:
        return GroundPath(points)
    except MocapError as error:
        raise MocapError(f"{path}: {error}") from None


@np.errstate(over="ignore", invalid="ignore")  # `GroundPath` rejects infinite and NaN values
def _read_svg(path: Path) -> Array:
    """Return the first visible line (N, 2), in units of the picture: x to the right, y down."""
    try:
        root = ElementTree.fromstring(read_text(path))
    except ElementTree.ParseError as error:
        raise FormatError(path, error.position[0], "an SVG picture", str(error)) from None
    stack = [(root, np.eye(3))]  # elements with the transforms of their groups, the next one at the end
    while stack:
        element, matrix = stack.pop()
        kind = _kind(element)
        if kind in UNDRAWN or _is_hidden(element):
            continue
        matrix = _transformed(path, matrix, element.get("transform", ""))
        if kind in DRAWN:
            points = first_stroke(path, DRAWN[kind].format_map(DEFAULTS | element.attrib), kind)
            return np.asarray(points @ matrix[:2, :2].T + matrix[:2, 2])
        stack += [(child, matrix) for child in reversed(element)]
    raise FormatError(path, None, "a path, polyline, polygon or line", "none")


def _kind(element: ElementTree.Element) -> str:
    """Return the name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def _is_hidden(element: ElementTree.Element) -> bool:
    """Return whether an element has `display: none`, as an attribute or in its style."""
    style = "".join(element.get("style", "").split())
    return element.get("display") == "none" or "display:none" in style.split(";")


def _transformed(path: Path, matrix: Array, text: str) -> Array:
    """Multiply a matrix (3, 3) by the steps of a `transform`, such as "translate(5) scale(2)".

    The last step is applied to a point first.
    """
    *steps, remainder = text.split(")")
    if remainder.strip(SEPARATORS):
        raise FormatError(path, None, "a transform", f"'{remainder.strip(SEPARATORS)}'")
    for step in steps:
        name, _, arguments = step.strip(SEPARATORS).partition("(")
        words = NUMBER.findall(arguments)
        if NUMBER.sub("", arguments).strip(SEPARATORS):
            raise FormatError(path, None, "numbers of a transform", f"'{arguments.strip(SEPARATORS)}'")
        numbers = to_numbers(path, None, words, "numbers of a transform", len(words))
        rows = _rows(name.strip(), numbers.tolist())
        if rows is None:
            raise FormatError(path, None, "a transform", f"'{step.strip(SEPARATORS)})'")
        matrix = matrix @ [*rows, [0, 0, 1]]
    return matrix


def _rows(name: str, numbers: list[float]) -> list[list[float]] | None:
    """Return the first two rows of the matrix of a step, or None if there is no such step [SVG11, 7.6]."""
    match name, numbers:
        case "matrix", [a, b, c, d, e, f]:
            return [[a, c, e], [b, d, f]]
        case "translate", [x]:
            return [[1, 0, x], [0, 1, 0]]
        case "translate", [x, y]:
            return [[1, 0, x], [0, 1, y]]
        case "scale", [factor]:
            return [[factor, 0, 0], [0, factor, 0]]
        case "scale", [x, y]:
            return [[x, 0, 0], [0, y, 0]]
        case "rotate", [angle]:
            return _rotation(angle, 0.0, 0.0)
        case "rotate", [angle, x, y]:
            return _rotation(angle, x, y)
        case "skewX", [angle]:
            return [[1, np.tan(np.radians(angle)), 0], [0, 1, 0]]
        case "skewY", [angle]:
            return [[1, 0, 0], [np.tan(np.radians(angle)), 1, 0]]
    return None


def _rotation(degrees: float, x: float, y: float) -> list[list[float]]:
    """Return the first two rows of the matrix of a rotation about the point (x, y)."""
    c = np.cos(np.radians(degrees))
    s = np.sin(np.radians(degrees))
    right = x - c * x + s * y
    down = y - s * x - c * y
    return [[c, -s, right], [s, c, down]]
