"""Paths from files: a table of points as .csv, or a line drawn in an .svg picture."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import FormatError, MocapError, Remedy, shortened, warn
from mocap.files.text import check_above_0, load_rows

OTHERS = 3  # lines of a picture that a warning names beside the one that is read


def load_path(
    path: str | Path,
    *,
    scale: float | None = None,
    length: float | None = None,
    id: str | None = None,
) -> GroundPath:
    """Read a path on the ground from a `.csv` or `.svg` file.

    A `.csv` file has a point in each line, x and z, separated by commas, semicolons or blanks. A first line
    with the names of the columns is skipped. An `.svg` picture is the ground seen from above: right is -x,
    top is +z. Of its visible lines and shapes, those that are stroked and not filled come first, and those
    that are closed and as large as the page come last. If several are left, the longest is read, and a
    warning names it.

    Parameters
    ----------
    path : the file.
    scale : metres in a unit of the file, by default 1 for `.csv`, and 0.01 for `.svg`.
    length : the length of the path in metres, in place of `scale`.
    id : of an `.svg` picture, the id of the element or group to read, or a name from the warning, such as
        "path 2".

    Returns
    -------
    The path, with 32 segments for each curve and 128 for each arc.

    Raises
    ------
    MocapError : for a file that is missing or of another format.
    FormatError : for a file that breaks its format, or has more than 500 000 points.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "corner.svg")
    ...     _ = file.write_text('<svg><path d="M 0 0 V -300 H -400"/></svg>')
    ...     load_path(file).points.tolist()
    ...     load_path(file, length=14)
    [[0.0, 0.0], [0.0, 3.0], [4.0, 3.0]]
    GroundPath(3 points, 14.0 m)
    """
    return read_path(path, scale, length, id, {"id": "id="})


def read_path(
    path: str | Path, scale: float | None, length: float | None, chosen: str | None, names: Mapping[str, str]
) -> GroundPath:
    """Read a path as `load_path` does, with the names of its parameters for the warning.

    Parameters
    ----------
    path, scale, length : as for `load_path`.
    chosen : its `id`.
    names : the names of the available parameters, by their names in Python.
    """
    path = Path(path)
    check_above_0(scale=scale, length=length)
    if scale is not None and length is not None:
        raise MocapError("Give one of scale and length: each sets the size of the path.")
    match path.suffix.lower():
        case ".csv":
            if chosen is not None:
                raise MocapError(f"{path} is a table, and has no elements with an id.")
            points = load_rows(path)
            if scale is not None:
                points = points * scale
        case ".svg":
            points = _drawn(path, scale, length, chosen, names)
        case _:
            raise MocapError(f"Cannot read a path from {path}: give a .csv or .svg file.")
    if len(points) < 2:
        raise FormatError(path, None, "a line through two points or more", f"{len(points)}")
    size = _size(points)
    if length is not None and 0 < size < np.inf:
        points = points * (length / size)
    try:
        return GroundPath(points)
    except MocapError as error:
        raise MocapError(f"{path}: {error}") from None


def _drawn(
    path: Path, scale: float | None, length: float | None, chosen: str | None, names: Mapping[str, str]
) -> Array:
    """Return the points of the line of a picture that is meant (N, 2), and warn if there are others."""
    from mocap.files.svg_drawings import Drawing  # a table needs no library of pictures

    lines = Drawing(path, chosen).best()
    unit = scale or 0.01
    if len(lines) > 1:
        if length is not None:
            unit = length / lines[0].length
        sizes = [f"{shortened(repr(line.name), 40)} ({unit * line.length:.2f} m)" for line in lines]
        warn(_choice(path, sizes).worded(names))
    return np.asarray(0.0 - unit * lines[0].points)  # no -0.0


def _choice(path: Path, sizes: Sequence[str]) -> MocapError:
    """Return the report of the line that is read, and of the others, each with its name and length."""
    shown = sizes[1 : 1 + OTHERS]
    rest = len(sizes) - 1 - len(shown)
    listed = ", ".join([*shown, f"{rest} more"] if rest else shown)
    message = f"{path} has {len(sizes)} lines: {sizes[0]}, the longest, is read, and not {listed}."
    return MocapError(message, remedy=Remedy("choose another by {}", "id"))


def _size(points: Array) -> float:
    """Return the length of a line through points (N, 2)."""
    with np.errstate(over="ignore", invalid="ignore"):  # `GroundPath` rejects infinite and NaN values
        return float(np.hypot(*np.diff(points, axis=0).T).sum())
