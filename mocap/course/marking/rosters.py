"""Who the students are: the .csv file of Moodle or Canvas, and which line is whose."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mocap.course.marking.hand_ins import Student
from mocap.errors import MocapError

MOODLE = ("Identifier", "Full name", "Email address", "Last modified (grade)")
CANVAS = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
NAMES = ("Student", "Full name", "Email address", "ID", "SIS User ID", "SIS Login ID", "Identifier")
"""Columns that say who a student is; the first one that is not empty names the student."""

SEPARATORS = (",", ";", "\t")  # of columns; the first one if a header has none
LATE_FILE = re.compile(r"_LATE_\d+_")  # in the names of Canvas
LATE_STATUS = re.compile(r"[^-;,.]*\blate\b")  # in the column `Status` of Moodle

MORE_NAMES = ("Username", "ID number")

Row = Mapping[str, str]
Roster = Sequence[Row]
"""A line for each student, by the names of the columns."""


def read_table(file: Path, parse: Callable[[str], Any]) -> Any:  # noqa: ANN401
    """Read a file, and parse its text.

    Raises
    ------
    MocapError : if it cannot be read or parsed.
    """
    try:
        return parse(_decoded(file.read_bytes()))
    except (OSError, ValueError, csv.Error) as error:
        raise MocapError(f"{file}: cannot be read ({error})."[:200]) from error


def _decoded(content: bytes) -> str:
    """Decode a text as UTF-16 if it begins as such, as UTF-8, or else as Windows writes it in the West.

    Examples
    --------
    >>> _decoded("Zoë".encode("utf-16")), _decoded("Zoë".encode("cp1252"))
    ('Zoë', 'Zoë')
    """
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252")


def _lines(text: str) -> list[list[str]]:
    r"""Read the lines of a table, whose columns are between commas, semicolons or tabulators.

    Examples
    --------
    >>> _lines("Full name;ID number\n\"Lovelace, Ada\";7")
    [['Full name', 'ID number'], ['Lovelace, Ada', '7']]
    """
    header, _, _ = text.partition("\n")
    separator = max(SEPARATORS, key=header.count)
    return list(csv.reader(io.StringIO(text), delimiter=separator))


def read_lines(file: Path) -> list[list[str]]:
    """Read the lines of a .csv file, as spreadsheets and learning platforms save it.

    Raises
    ------
    MocapError : if the file cannot be read.
    """
    lines: list[list[str]] = read_table(file, _lines)
    return lines


def read_roster(file: Path | None) -> list[dict[str, str]]:
    """Read who the students are from a .csv file that Moodle or Canvas has written.

    Raises
    ------
    MocapError : if the file cannot be read, or none of its columns says who a student is.

    Examples
    --------
    >>> read_roster(None)
    []
    """
    if file is None:
        return []
    lines = read_lines(file)
    header = lines[0] if lines else []
    if not {*NAMES, *MORE_NAMES} & {*header}:
        raise MocapError(
            f"{file}: no column such as 'Email address' or 'SIS Login ID' says who students are."
        )
    rows = [dict(zip(header, line, strict=False)) for line in lines[1:]]
    return [row for row in rows if name_of(row) and "Points Possible" not in name_of(row)]


def name_of(row: Row) -> str:
    """Return the name of the student of a line.

    Examples
    --------
    >>> name_of({"ID": "71", "Student": "Lovelace, Ada"})
    'Lovelace, Ada'
    """
    names = [row[column] for column in (*NAMES, *MORE_NAMES) if row.get(column, "").strip()]
    return names[0] if names else ""


def match(students: Iterable[Student], roster: Roster) -> dict[Student, Row | None]:
    """Find the line of each student by the number or else by one of the names.

    Returns
    -------
    For each student the line, an empty one if there is none, and None if it cannot be told which one it is:
    several lines have this name, or several students fit one line.

    Examples
    --------
    >>> roster = [{"Full name": "Wei Zhang", "Email address": f"{login}@b.org"} for login in ("wz1", "wz2")]
    >>> match([("wz1", ""), ("Wei Zhang", ""), ("eve", "")], roster)[("Wei Zhang", "")] is None
    True
    """
    lines = {student: lines_of(student, roster) for student in students}
    claimed = [numbers[0] for numbers in lines.values() if len(numbers) == 1]
    matched: dict[Student, Row | None] = {}
    for student, numbers in lines.items():
        if not numbers:
            matched[student] = {}
        elif len(numbers) == 1 and claimed.count(numbers[0]) == 1:
            matched[student] = roster[numbers[0]]
        else:
            matched[student] = None
    return matched


def lines_of(student: Student, roster: Roster) -> list[int]:
    """List the numbers of the lines that fit a student.

    Examples
    --------
    >>> lines_of(("ada", ""), [{"SIS Login ID": "bob"}, {"SIS Login ID": "Ada"}])
    [1]
    """
    name, number = student
    return [line for line, row in enumerate(roster) if (number or name.casefold()) in _names(row, number)]


def _names(row: Row, number: str) -> list[str]:
    """List the numbers of a student in a roster, or else the names, with those of e-mail addresses."""
    if number:
        return re.findall(r"\d+", row.get("Identifier", "") or row.get("ID", ""))
    names = [row.get(column, "").casefold() for column in (*NAMES, *MORE_NAMES)]
    return [*names, *(name.split("@")[0] for name in names)]


def lateness(sent: str, row: Row) -> str:
    """Return how late something was handed in, as Canvas says in its name, or Moodle in the column `Status`.

    Examples
    --------
    >>> lateness("lovelaceada_LATE_815_4711_02-matching.ipynb", {})
    'late'
    >>> lateness("Ada_7_assignsubmission_file", {"Status": "Submitted for grading - 2 hours 5 mins late"})
    '2 hours 5 mins late'
    """
    stated = LATE_STATUS.search(row.get("Status", ""))
    if stated:
        return stated[0].strip()
    return "late" if LATE_FILE.search(sent) else ""
