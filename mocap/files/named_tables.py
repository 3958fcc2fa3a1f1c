"""Tables with named columns in `.csv` files, in any order of the columns, and with empty cells."""

import csv
from collections.abc import Collection, Iterable, Mapping, Sequence
from io import StringIO
from pathlib import Path

from mocap._shared.atomic import write_file
from mocap._shared.records import NamedTuple
from mocap.errors import FormatError, shortened
from mocap.files.text import MOST_ROWS, read_text, to_numbers


class TableRow(NamedTuple):
    """A row of a table: the number of its line in the file, from 1, and its cells by column.

    Examples
    --------
    >>> TableRow(2, {"x": "1.5"}).cells["x"]
    '1.5'
    """

    line: int
    cells: Mapping[str, str]


def read_table(path: str | Path, required: Sequence[str], optional: Collection[str] = ()) -> list[TableRow]:
    r"""Read the rows of a table whose first line names its columns.

    Cells are separated by commas, or by semicolons if the first line contains one. A cell may be quoted.
    Blank lines and lines that start with `#` are skipped. Columns that are not asked for are refused, because
    a misspelt name would otherwise be ignored.

    Parameters
    ----------
    path : the file.
    required, optional : names of columns, in lower case.

    Returns
    -------
    The rows, whose cells have an entry for each required and each optional column, "" if it is missing.

    Raises
    ------
    MocapError, FormatError : for a file that cannot be read, missing, unknown or repeated columns, rows of
        another length, a table without rows, and one of more than 500 000 lines.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "line.csv")
    ...     _ = file.write_text("z, x\n4, 0\n")
    ...     read_table(file, ["x", "z"], ["t"])
    [TableRow(line=2, cells={'x': '0', 'z': '4', 't': ''})]
    """
    text = read_text(path)
    count = text.count("\n")
    if count > MOST_ROWS:
        raise FormatError(path, None, f"a table of {MOST_ROWS:,} lines at most", f"{count:,}")
    kept = [(number, line) for number, line in enumerate(text.splitlines(), 1) if _is_row(line)]
    expected = f"a first line with the columns {', '.join(required)}"
    if not kept:
        raise FormatError(path, None, expected, "an empty table")
    heading, *rest = kept
    separator = ";" if ";" in heading[1] else ","
    names = [name.lower() for name in _cells(heading[1], separator)]
    columns = [*required, *optional]
    for name in [*names, *required]:
        if name not in columns or names.count(name) != 1:
            shown = shortened(", ".join(names), 60)
            raise FormatError(path, heading[0], f"{expected}; known are {', '.join(columns)}", f"'{shown}'")
    if not rest:
        raise FormatError(path, None, "rows below the names of the columns", "none")
    rows = []
    for number, line in rest:
        cells = _cells(line, separator)
        if len(cells) > len(names):
            raise FormatError(path, number, f"{len(names)} cells", f"{len(cells)}")
        named = dict(zip(names, cells, strict=False))
        rows.append(TableRow(number, {name: named.get(name, "") for name in columns}))
    return rows


def _is_row(line: str) -> bool:
    """Return whether a line is neither blank nor a comment."""
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _cells(line: str, separator: str) -> list[str]:
    """Split a line into cells without blanks at their ends."""
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [cell.strip() for cell in cells]


def number_in(path: str | Path, row: TableRow, name: str) -> float | None:
    """Return the number in a cell, None for an empty one, or raise `FormatError`.

    Examples
    --------
    >>> number_in("line.csv", TableRow(2, {"t": "1.5"}), "t")
    1.5
    """
    text = row.cells[name]
    if not text:
        return None
    return float(to_numbers(path, row.line, [text], f"a number as {name}", 1)[0])


def write_table(path: str | Path, names: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table atomically, with the names of its columns in the first line.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_table(Path(folder, "t.csv"), ["clip", "to"], [["a, b", 3]])
    ...     read_table(Path(folder, "t.csv"), ["clip", "to"])
    [TableRow(line=2, cells={'clip': 'a, b', 'to': '3'})]
    """
    text = StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(names)
    table.writerows(rows)
    write_file(path, text.getvalue())
