"""Directions for a walk: points with times, headings, labels and waits, from `.csv` and `.toml` files."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

from mocap._shared.records import NamedTuple, dataclass
from mocap.errors import FormatError, MocapError, shortened
from mocap.files.named_tables import number_in, read_table
from mocap.files.text import LARGEST, read_text

PLACE = ("x", "z")
WISHES = ("t", "heading", "label", "wait")
ENDS = ("", "stand")
KEYS = ("start", "end", "facing", "around", "points")
MOST_POINTS = 100_000


class DirectedPoint(NamedTuple):
    """A point (x, z) of a line, metres, and what is asked for there.

    Parameters
    ----------
    x, z : the position, metres.
    t : the time of arrival, seconds from the start of the motion; None for any.
    heading : the heading of the body, radians about +y, where 0 faces +z; None for any.
    label : the kind of motion from here on; "" for any.
    wait : seconds to stand here.

    Examples
    --------
    >>> DirectedPoint(0.0, 4.0, heading=math.pi / 2, wait=2.0).wait
    2.0

    Notebook: 08b-steering
    """

    x: float
    z: float
    t: float | None = None
    heading: float | None = None
    label: str = ""
    wait: float = 0.0


@dataclass(frozen=True)
class Direction:
    """A line to walk along, and what is asked for on it.

    Parameters
    ----------
    points : two or more. Two of them in one place, with different times, are a wait.
    start, end : "stand" for a walk that starts or ends standing, "" for one in full stride.
    facing : the heading of the body at the end, radians, in place of that of the last point.
    around : discs (x, z, radius) that the walk must not enter, metres.

    Raises
    ------
    MocapError : for fewer than two points, numbers that are not finite or too large, negative waits and
        radii, times that do not grow, and other words for `start` and `end`.

    Examples
    --------
    >>> points = [DirectedPoint(0, 0), DirectedPoint(0, 4, wait=2.0), DirectedPoint(3, 4)]
    >>> line = Direction(points, end="stand")
    >>> len(line.points), line.stands
    (3, True)

    Notebook: 08b-steering
    """

    points: Sequence[DirectedPoint]
    start: Literal["", "stand"] = ""
    end: Literal["", "stand"] = ""
    facing: float | None = None
    around: Sequence[tuple[float, float, float]] = ()  # reads: name: as the option

    def __post_init__(self) -> None:
        points = [
            point if isinstance(point, DirectedPoint) else DirectedPoint(*point) for point in self.points
        ]
        object.__setattr__(self, "points", tuple(points))
        object.__setattr__(self, "around", tuple((x, z, radius) for x, z, radius in self.around))
        if len(points) < 2:
            raise MocapError(f"A direction has two points or more, got {len(points)}.")
        for name in ("start", "end"):
            if getattr(self, name) not in ENDS:
                raise MocapError(f"{name} is 'stand' or '', got {getattr(self, name)!r:.40}.")
        for number, point in enumerate(points, 1):
            _check_point(point, number)
        times = [point.t for point in points if point.t is not None]
        if any(later <= earlier for earlier, later in pairwise(times)):
            raise MocapError(f"Times must grow along a direction, got {shortened(str(times), 80)}.")
        for x, z, radius in self.around:
            if not (max(abs(x), abs(z), radius) < LARGEST and radius > 0):
                raise MocapError(f"A disc is x, z and a radius above 0 m, got {x}, {z}, {radius}.")

    @property
    def stands(self) -> bool:
        """Whether the walk has to stand somewhere: at an end, or to wait."""
        places = [(point.x, point.z) for point in self.points]
        waits = any(point.wait for point in self.points)
        stays = any(place == next_place for place, next_place in pairwise(places))
        return bool(self.start or self.end or waits or stays)


def _check_point(point: DirectedPoint, number: int) -> None:
    """Raise for numbers of a point that are not finite, too large or negative."""
    place = f"Point {number} of a direction"
    numbers = [point.x, point.z, point.t or 0.0, point.heading or 0.0, point.wait]
    if not all(isinstance(value, int | float) and abs(value) < LARGEST for value in numbers):
        raise MocapError(f"{place} needs finite numbers, got {shortened(str(numbers), 80)}.")
    if point.wait < 0 or (point.t or 0) < 0:
        raise MocapError(f"{place} needs a time and a wait of 0 s or more, got {point.t} and {point.wait}.")


def load_direction(path: str | Path) -> Direction:
    r"""Read a direction from a `.csv` or `.toml` file, in which headings are in degrees.

    A `.csv` file has the columns x and z, and any of t, heading, label and wait, with empty cells for
    anything that is not asked for. A `.toml` file has a table `[[points]]` with these keys for each point,
    and may have start, end, facing, and around, a list of discs [x, z, radius].

    Raises
    ------
    FormatError, MocapError : as for `files.named_tables.read_table` and `Direction`.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "line.csv")
    ...     _ = file.write_text("x, z, t, wait\n0, 0, 0,\n0, 4, , 2\n")
    ...     load_direction(file).points[1]
    DirectedPoint(x=0.0, z=4.0, t=None, heading=None, label='', wait=2.0)
    """
    match Path(path).suffix.lower():
        case ".csv":
            return _validated(path, {"points": _points_of_table(path)})
        case ".toml":
            return _read_toml(path)
    raise MocapError(f"A direction is read from a .csv or .toml file, got '{path}'.")


def is_direction(path: str | Path) -> bool:
    """Return whether a file is a direction rather than a bare line: a `.toml`, or a `.csv` with more columns.

    Examples
    --------
    >>> is_direction("line.svg"), is_direction("line.toml")
    (False, True)
    """
    path = Path(path)
    if path.suffix.lower() != ".csv" or not path.is_file():
        return path.suffix.lower() == ".toml"
    rows = [
        line for line in read_text(path).splitlines() if line.strip() and not line.lstrip().startswith("#")
    ]
    names = [name.strip().lower() for name in rows[0].replace(";", ",").split(",")] if rows else []
    return bool(set(names) & set(WISHES))


def _points_of_table(path: str | Path) -> list[DirectedPoint]:
    """Read the points of a `.csv` file."""
    points = []
    for row in read_table(path, PLACE, WISHES):
        numbers = {name: number_in(path, row, name) for name in (*PLACE, "t", "heading", "wait")}
        if numbers["x"] is None or numbers["z"] is None:
            raise FormatError(path, row.line, "x and z in each line", "an empty cell")
        points.append(_point(numbers | {"label": row.cells["label"]}))
    return points


def _point(values: Mapping[str, Any]) -> DirectedPoint:
    """Return a point from the values of a file, with the heading in degrees."""
    heading = values.get("heading")
    turned = None if heading is None else math.radians(heading)
    return DirectedPoint(
        values["x"], values["z"], values.get("t"), turned, values.get("label", ""), values.get("wait") or 0.0
    )


def _read_toml(path: str | Path) -> Direction:
    """Read a direction from a `.toml` file."""
    try:
        table = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise FormatError(path, None, "TOML", shortened(str(error), 60)) from None
    for key in table:
        if key not in KEYS:
            raise FormatError(path, None, f"the keys {', '.join(KEYS)}", f"'{shortened(key, 30)}'")
    rows = table.get("points")
    if not isinstance(rows, list) or len(rows) > MOST_POINTS:
        raise FormatError(path, None, "a table [[points]] for each point", "none, or too many")
    points = [_point(_checked(path, row, number)) for number, row in enumerate(rows, 1)]
    facing = table.get("facing")
    if facing is not None and not _is_number(facing):
        raise FormatError(path, None, "degrees as facing", f"'{facing!r:.30}'")
    discs = table.get("around", [])
    if not isinstance(discs, list) or not all(map(_is_disc, discs)):
        raise FormatError(path, None, "around = [[x, z, radius], ...]", f"{discs!r:.40}")
    ends = {name: table.get(name, "") for name in ("start", "end")}
    radians = None if facing is None else math.radians(facing)
    return _validated(path, {"points": points, **ends, "facing": radians, "around": discs})


def _checked(path: str | Path, row: object, number: int) -> dict[str, Any]:
    """Return the values of a point in a `.toml` file, or raise for unknown keys and wrong types."""
    expected = f"x and z, and any of {', '.join(WISHES)}, for point {number}"
    if not isinstance(row, dict) or not set(PLACE) <= set(row) <= {*PLACE, *WISHES}:
        raise FormatError(path, None, expected, f"{row!r:.60}")
    for key, value in row.items():
        if not (isinstance(value, str) if key == "label" else _is_number(value)):
            raise FormatError(path, None, f"a value of its kind as {key} of point {number}", f"{value!r:.30}")
    return row


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_disc(row: object) -> bool:
    return isinstance(row, list) and len(row) == 3 and all(map(_is_number, row))


def _validated(path: str | Path, values: Mapping[str, Any]) -> Direction:
    """Return a direction, with the file in its errors."""
    try:
        return Direction(**values)
    except MocapError as error:
        raise MocapError(f"{path}: {error}") from None
