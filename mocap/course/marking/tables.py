"""Marks as .csv files: a line for each exercise, and a table of students and exercises."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from mocap.course.marking.marks import Mark

LONGEST = 300  # characters of a cell
FORMULA = ("=", "+", "-", "@", "\t")  # how cells begin that a spreadsheet computes


def to_csv(marks: Iterable[Mark]) -> str:
    """Write marks as the text of a .csv file, one line per mark.

    Texts stay on one line, and an apostrophe stands before one that a spreadsheet would take for a formula.

    Examples
    --------
    >>> print(to_csv([Mark("=ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.")]))
    handed in,exercise,right,said
    '=ada/02.ipynb,align,1,✓ align: right on 40 random inputs.
    """
    rows = [(mark.handed_in, mark.exercise, int(mark.right), mark.said) for mark in marks]
    return _text([("handed in", "exercise", "right", "said"), *rows])


def to_table(marks: Iterable[Mark]) -> str:
    """Write marks as the text of a .csv file, a line for each student and a column for each exercise.

    Examples
    --------
    >>> print(to_table([Mark("ada/00.ipynb", "speed", True, ""), Mark("ada/02.ipynb", "align", False, "")]))
    student,speed,align,right
    ada,1,0,1
    """
    marks = list(marks)
    names = [*dict.fromkeys(mark.exercise for mark in marks if mark.exercise)]
    table: dict[str, dict[str, int]] = {}
    for mark in marks:
        row = table.setdefault(mark.handed_in.split("/")[0], {})
        if mark.exercise:
            row[mark.exercise] = max(int(mark.right), row.get(mark.exercise, 0))
    rows = [[who, *(row.get(name, "") for name in names), sum(row.values())] for who, row in table.items()]
    return _text([["student", *names, "right"], *rows])


def _text(rows: Iterable[Iterable[str | int]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([_cell(value) for value in row] for row in rows)
    return text.getvalue()


def _cell(value: str | int) -> str | int:
    """Make a text safe: one line of visible characters, and no formula."""
    if isinstance(value, int):
        return value
    line = "".join(sign if sign.isprintable() else " " for sign in value[: 10 * LONGEST])
    line = " ".join(line.split())
    line = f"{line[: LONGEST - 1]}…" if len(line) > LONGEST else line
    return f"'{line}" if line.startswith(FORMULA) or value.startswith(FORMULA) else line
