"""What marks are worth: points, tables for spreadsheets, Moodle and Canvas, and a page for each student."""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template
from typing import Any, NamedTuple

from mocap._shared.atomic import make_folder, write_file
from mocap.course.checks import all_checks
from mocap.errors import MocapError

LONGEST = 300  # characters of a cell
FORMULA = ("=", "+", "-", "@", "\t")  # how cells begin that a spreadsheet computes
MOODLE = ("Identifier", "Full name", "Email address", "Last modified (grade)")
CANVAS = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
NAMES = {*MOODLE[:3], *CANVAS[:4], "Username", "ID number"}  # columns that say who a student is
SENT = re.compile(r"(.+?)_(?:LATE_)?(\d+)_(?:assignsubmission_|\d+_).*", re.DOTALL)
"""How Moodle and Canvas call what was handed in: NAME_NUMBER_assignsubmission_…, and NAME_NUMBER_NUMBER_…"""
PAGE = Template(Path(__file__).with_name("feedback.html").read_text("utf-8"))


Points = Mapping[str, float]  # of exercises, by their names; 1 for those that are missing
Roster = Sequence[Mapping[str, str]]  # a line for each student, by the names of the columns


class Mark(NamedTuple):
    """The mark of an exercise: whose notebook, which exercise, right or not, and what the check said.

    Examples
    --------
    >>> Mark("ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.").right
    True
    """

    handed_in: str
    exercise: str
    right: bool
    said: str


class Grade(NamedTuple):
    """A student's grade.

    Attributes
    ----------
    sent : the folder or file that was handed in.
    known : the columns of Moodle and Canvas that say who it is.
    listed : whether the roster has the student.
    best : the best mark of each exercise; at "" what was said of a notebook as a whole.
    points : of all exercises.
    """

    sent: str
    known: Mapping[str, str]
    listed: bool
    best: Mapping[str, Mark]
    points: float


def read_points(file: Path | None) -> dict[str, float]:
    """Read how many points exercises are worth, from lines `speed = 2`; those that are not named are worth 1.

    Raises
    ------
    MocapError : where the file cannot be read, names what is no exercise, or gives no number.

    Examples
    --------
    >>> read_points(None)
    {}
    """
    table = _read(file, tomllib.loads) if file else {}
    for name, worth in table.items():
        if name not in all_checks() or type(worth) not in (int, float) or not 0 <= worth < 1e6:
            raise MocapError(f"{file}: '{name:.40}' is no exercise, or {f'{worth}':.40} no number of points.")
    return table


def read_roster(file: Path | None) -> list[dict[str, str]]:
    """Read who the students are from a .csv file that Moodle or Canvas has written.

    Raises
    ------
    MocapError : where the file cannot be read, or none of its columns says who a student is.

    Examples
    --------
    >>> read_roster(None)
    []
    """
    lines = _read(file, lambda text: [*csv.reader(io.StringIO(text))]) if file else [[*CANVAS]]
    if not NAMES & {*(lines or [[]])[0]}:
        raise MocapError(
            f"{file}: no column such as 'Email address' or 'SIS Login ID' says who students are."
        )
    return [dict(zip(lines[0], line, strict=False)) for line in lines[1:]]


def _read(file: Path, parse: Callable[[str], Any]) -> Any:  # noqa: ANN401
    try:
        return parse(file.read_text("utf-8-sig"))
    except (OSError, ValueError, csv.Error) as error:
        raise MocapError(f"{file}: cannot be read ({error})."[:200]) from error


def sent_by(handed_in: str) -> tuple[str, str]:
    """Give the name of who handed a file in, and the number in Moodle or Canvas, if any.

    Examples
    --------
    >>> sent_by("ada/02.ipynb"), sent_by("Ada Lovelace_815_assignsubmission_file/02.ipynb")
    (('ada', ''), ('Ada Lovelace', '815'))
    >>> sent_by("lovelaceada_LATE_815_4711_02-matching.ipynb")
    ('lovelaceada', '815')
    """
    sent = handed_in.split("/")[0]
    found = SENT.fullmatch(sent)
    return (found[1], found[2]) if found else (sent.removesuffix(".ipynb"), "")


def grade(marks: Iterable[Mark], points: Points, roster: Roster = ()) -> list[Grade]:
    """Sum up the marks of each student; of several copies of an exercise the best one counts.

    Parameters
    ----------
    marks : of all students.
    points : from `read_points`.
    roster : from `read_roster`; a student is found there by the number or by one of the names.

    Examples
    --------
    >>> grade([Mark("ada/00.ipynb", "speed", True, "")], {"speed": 2})[0].points
    2
    """
    all_best: dict[tuple[str, str], dict[str, Mark]] = {}
    for mark in marks:
        best = all_best.setdefault(sent_by(mark.handed_in), {})
        if mark.right or mark.exercise not in best:
            best[mark.exercise] = mark
    grades = []
    for (name, number), best in all_best.items():
        row = next((row for row in roster if (number or name.casefold()) in _names(row, number)), {})
        known = {"Identifier": f"Participant {number}" * bool(number), "Full name": name, "Student": name}
        known |= {"ID": number, "SIS Login ID": "" if number else name, "Email address": name * ("@" in name)}
        total = sum(points.get(exercise, 1) * mark.right for exercise, mark in best.items())
        sent = next(iter(best.values())).handed_in.split("/")[0]
        grades.append(Grade(sent, known | {**row}, bool(row), best, round(total, 4)))
    return grades


def _names(row: Mapping[str, str], number: str) -> list[str]:
    """List the numbers of a student in a roster, or else the names, with those of e-mail addresses."""
    if number:
        return re.findall(r"\d+", row.get("Identifier", "") or row.get("ID", ""))
    names = [row.get(column, "").casefold() for column in NAMES]
    return [*names, *(name.split("@")[0] for name in names)]


def tables(marks: Sequence[Mark], grades: Sequence[Grade], points: Points, title: str = "") -> dict[str, str]:
    """Write marks as the texts of .csv files, by the ends of their names.

    Parameters
    ----------
    marks : of all students: the first text has a line for each.
    grades : of the same students; `-table` has a line for each and a column for each exercise, `-moodle` and
        `-canvas` have the columns that these import.
    points : as for `grade`.
    title : the name of the assignment in Canvas.

    Texts stay on one line, and an apostrophe stands before one that a spreadsheet would take for a formula.

    Examples
    --------
    >>> marks = [Mark("=ada/00.ipynb", "speed", True, "✓ speed: right on 40 random inputs.")]
    >>> made = tables(marks, grade(marks, {"speed": 2}), {"speed": 2})
    >>> print(made[""] + made["-table"])
    handed in,exercise,right,said
    '=ada/00.ipynb,speed,1,✓ speed: right on 40 random inputs.
    student,speed,points
    '=ada,2,2
    """
    worth = {mark.exercise: points.get(mark.exercise, 1) for mark in marks if mark.exercise}
    rows = [[w * one.best[n].right if n in one.best else "" for n, w in worth.items()] for one in grades]
    made: dict[str, list[tuple[object, ...]]] = {
        "": [(mark.handed_in, mark.exercise, int(mark.right), mark.said) for mark in marks],
        "-table": [(one.known["Student"], *row, one.points) for one, row in zip(grades, rows, strict=True)],
        "-moodle": [(*map(one.known.get, MOODLE), one.points) for one in grades],
        "-canvas": [(*map(one.known.get, CANVAS), one.points) for one in grades],
    }
    made[""].insert(0, ("handed in", "exercise", "right", "said"))
    made["-table"].insert(0, ("student", *worth, "points"))
    made["-moodle"].insert(0, (*MOODLE, "Grade"))
    made["-canvas"][:0] = [(*CANVAS, title), ("Points Possible", *4 * [""], round(sum(worth.values()), 4))]
    texts = {end: io.StringIO() for end in made}
    for end, text in texts.items():
        csv.writer(text, lineterminator="\n").writerows(map(_cell, row) for row in made[end])
    return {end: text.getvalue() for end, text in texts.items()}


def _cell(value: object) -> object:
    """Make a text safe: one line of visible characters, and no formula."""
    if not isinstance(value, str):
        return value
    line = "".join(sign if sign.isprintable() else " " for sign in value[: 10 * LONGEST])
    line = " ".join(line.split())
    line = f"{line[: LONGEST - 1]}…" if len(line) > LONGEST else line
    return f"'{line}" if line.startswith(FORMULA) or value.startswith(FORMULA) else line


def write_feedback(grades: Iterable[Grade], points: Points, folder: Path) -> list[Path]:
    """Write a page for each student: what the check of each exercise said, its points, and their sum.

    The name of each begins as that of what was handed in, by which Moodle finds whose it is.
    """
    make_folder(folder)
    files: list[Path] = []
    for one in grades:
        most = {name: points.get(name, 1) if name else 0 for name in one.best}
        parts = [f"<p><b>{one.points:g} of {sum(most.values()):g}</b>All points</p>"]
        for name, mark in one.best.items():
            earned = f"<b>{most[name] * mark.right:g} of {most[name]:g}</b>" * bool(name)
            said = mark.said.removeprefix(f"✗ {name}: ").removeprefix(f"✓ {name}: ")
            parts += [
                f"<h2>{earned}{'✓' if mark.right else '✗'} {escape(name)}</h2>",
                f"<p>{escape(said)}</p>",
            ]
        title = escape(one.known.get("Full name") or one.known["Student"])
        start = re.sub(r"[^\w .@-]", "-", one.sent).lstrip(".")[:100]
        file = folder / f"{start}_feedback.html"
        while file in files:  # of another name with other signs
            file = file.with_stem(f"{file.stem}_")
        write_file(file, PAGE.substitute(title=title, body="\n".join(parts)))
        files.append(file)
    return files
