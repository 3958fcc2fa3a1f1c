"""What marks are worth: points, tables for spreadsheets, Moodle and Canvas, and a page for each student."""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template

from mocap._shared.atomic import make_folder, write_file
from mocap._shared.records import NamedTuple
from mocap.course.checks import all_checks
from mocap.course.marking.hand_ins import Student, sent_by
from mocap.course.marking.rosters import (
    CANVAS,
    MOODLE,
    Roster,
    Row,
    lateness,
    lines_of,
    match,
    name_of,
    read_table,
)
from mocap.course.written import KIND, MOST_LETTERS, Answer
from mocap.errors import MocapError, printable

LONGEST = 300  # characters of a cell
HEADER_OF_WRITTEN = ("handed in", "question", "answer", "points")
FORMULA = ("=", "+", "-", "@", "\t")  # how cells begin that a spreadsheet computes
PAGE = Template(Path(__file__).with_name("feedback.html").read_text("utf-8"))

NO_NOTEBOOK = "not a notebook"
NO_EXERCISE = "no exercise of the course"
NOTHING = "nothing handed in"
AMBIGUOUS = "ambiguous in the roster"
NOT_LISTED = "not in the roster"
UNKNOWN = "exercises that this version does not know"
PROBLEMS = (NO_NOTEBOOK, NO_EXERCISE, NOTHING, AMBIGUOUS, NOT_LISTED, UNKNOWN)
"""What a person has to look at, in the order of the closing account."""

Points = Mapping[str, float]
"""Of exercises, by their names; 1 for those that are missing."""


class Mark(NamedTuple):
    """The mark of an exercise.

    Attributes
    ----------
    handed_in : the path of the notebook.
    exercise : its name; "" for what is said of a notebook as a whole.
    right : whether the answer is right.
    said : what the check said, for the student.
    note : for the teacher alone.
    problem : one of `PROBLEMS`, or "".
    passed : the fraction of the random inputs on which a wrong answer is right, if that earns points.
    published : whether it is the published solution.
    tree : the syntax tree of the function as text, or "", by which it is compared with those of others.
    awarded : the points that a person gave; None if they follow from the check.

    Examples
    --------
    >>> Mark("ada/02.ipynb", "align", True, "✓ align: right on 40 random inputs.").right
    True
    """

    handed_in: str
    exercise: str
    right: bool
    said: str
    note: str = ""
    problem: str = ""
    passed: float = 0.0
    published: bool = False
    tree: str = ""
    awarded: float | None = None

    def earned(self, points: float) -> float:
        """Return the points that it earns, of those of the exercise."""
        if self.awarded is not None:
            return self.awarded
        if self.right:
            return points
        return round(points * self.passed, 2) if self.passed else 0


class Grade(NamedTuple):
    """A student's grade.

    Attributes
    ----------
    sent : the folder or file that was handed in; "" if nothing was.
    columns : the columns of Moodle and Canvas that say who it is.
    problem : one of `PROBLEMS`, or "".
    best : the best mark of each exercise; at "" what was said of a notebook as a whole.
    points : of all exercises.
    late : how late it was handed in, as the learning platform says; "" if it was in time or does not say.
    """

    sent: str
    columns: Mapping[str, str]
    problem: str
    best: Mapping[str, Mark]
    points: float
    late: str = ""


def read_points(file: Path | None) -> dict[str, float]:
    """Read how many points exercises are worth, from lines `speed = 2`; those that are not named are worth 1.

    Raises
    ------
    MocapError : if the file cannot be read, names what is no exercise, or gives no number.

    Examples
    --------
    >>> read_points(None)
    {}
    """
    table: dict[str, float] = read_table(file, tomllib.loads) if file else {}
    for name, points in table.items():
        is_known = name in all_checks() or name == KIND
        if not is_known or type(points) not in (int, float) or not 0 <= points < 1e6:
            raise MocapError(
                f"{file}: '{name:.40}' is no exercise, or {f'{points}':.40} no number of points."
            )
    return table


def grade(marks: Iterable[Mark], points: Points, roster: Roster = ()) -> list[Grade]:
    """Sum up the marks of each student; of several copies of an exercise the best one counts.

    Parameters
    ----------
    marks : of all students.
    points : from `read_points`.
    roster : from `read_roster`; a student is found there by the number or by one of the names.

    Returns
    -------
    The grades of those who handed something in, then of those in the roster who did not: 0 for each exercise.

    Examples
    --------
    >>> grade([Mark("ada/00.ipynb", "speed", True, "")], {"speed": 2})[0].points
    2
    """
    all_best: dict[Student, dict[str, Mark]] = {}
    exercises: dict[str, None] = {}
    for mark in marks:
        best = all_best.setdefault(sent_by(mark.handed_in), {})
        exercises[mark.exercise] = None
        previous = best.get(mark.exercise)
        if previous is None or (mark.right, mark.passed) > (previous.right, previous.passed):
            best[mark.exercise] = mark
    rows = match(all_best, roster)
    grades = [_grade_of(student, best, rows[student], points) for student, best in all_best.items()]
    if not roster:
        return [graded._replace(problem="") for graded in grades]
    fitting = {line for student in all_best for line in lines_of(student, roster)}
    missing = [row for line, row in enumerate(roster) if line not in fitting]
    nothing = {name: Mark("", name, False, f"✗ {name}: not handed in.") for name in exercises if name}
    return grades + [Grade("", {"Student": name_of(row), **row}, NOTHING, nothing, 0) for row in missing]


def _grade_of(student: Student, best: Mapping[str, Mark], row: Row | None, points: Points) -> Grade:
    """Sum up the marks of a student, whose line in the roster is empty or None if there is none."""
    name, number = student
    columns = {"Full name": name, "Student": name, "ID": number}
    columns["Identifier"] = f"Participant {number}" if number else ""
    columns["SIS Login ID"] = "" if number else name
    columns["Email address"] = name if "@" in name else ""
    problem = AMBIGUOUS if row is None else "" if row else NOT_LISTED
    total = sum(mark.earned(points.get(exercise, 1)) for exercise, mark in best.items() if exercise)
    sent = next(iter(best.values())).handed_in.split("/")[0]
    late = lateness(sent, row or {})
    return Grade(sent, columns | {**(row or {})}, problem, best, round(total, 4), late)


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
    >>> texts = tables(marks, grade(marks, {"speed": 2}), {"speed": 2})
    >>> print(texts[""] + texts["-table"])
    handed in,exercise,right,said,note,same as the published solution,same as
    '=ada/00.ipynb,speed,1,✓ speed: right on 40 random inputs.,,,
    student,speed,points,late
    '=ada,2,2,
    """
    worth = {mark.exercise: points.get(mark.exercise, 1) for mark in marks if mark.exercise}
    header = ("handed in", "exercise", "right", "said", "note", "same as the published solution", "same as")
    authors = _authors(marks)
    texts = {"": _text(header, [_line(mark, authors) for mark in marks])}
    rows = [(*_points_of(student, worth), student.late) for student in grades]
    texts["-table"] = _text(("student", *worth, "points", "late"), rows)
    texts["-moodle"] = _text((*MOODLE, "Grade"), [_line_of(student, MOODLE) for student in grades])
    possible = ("Points Possible", *[""] * (len(CANVAS) - 1), round(sum(worth.values()), 4))
    texts["-canvas"] = _text((*CANVAS, title), [possible, *(_line_of(student, CANVAS) for student in grades)])
    return texts


Authors = Mapping[tuple[str, str], Sequence[str]]
"""The students who wrote a function, by the exercise and its syntax tree."""


def _authors(marks: Iterable[Mark]) -> Authors:
    """List who wrote each function."""
    authors: dict[tuple[str, str], list[str]] = {}
    for mark in (mark for mark in marks if mark.tree):
        name, _ = sent_by(mark.handed_in)
        names = authors.setdefault((mark.exercise, mark.tree), [])
        if name not in names:
            names.append(name)
    return authors


def _line(mark: Mark, authors: Authors) -> tuple[object, ...]:
    """Return a line of the first table."""
    name, _ = sent_by(mark.handed_in)
    copies = [author for author in authors.get((mark.exercise, mark.tree), ()) if author != name]
    published = 1 if mark.published else ""
    judged = (mark.handed_in, mark.exercise, int(mark.right), mark.said, mark.note)
    return *judged, published, ", ".join(copies)


def _points_of(student: Grade, worth: Points) -> tuple[object, ...]:
    """Return the name of a student, the points of each exercise, and their sum."""
    points: list[object] = []
    for name, possible in worth.items():
        mark = student.best.get(name)
        points.append(mark.earned(possible) if mark else "")
    return student.columns["Student"], *points, student.points


def _line_of(student: Grade, columns: Sequence[str]) -> tuple[object, ...]:
    return *map(student.columns.get, columns), student.points


def _text(header: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """Write the text of a .csv file."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(map(safe_cell, row) for row in (header, *rows))
    return text.getvalue()


def written_table(answers: Sequence[Answer], awarded: Sequence[str] = ()) -> str:
    """Write answers in words as the text of a .csv file, with a column for the points that a person gives.

    Parameters
    ----------
    answers : that were handed in.
    awarded : the points that they have already, as texts; none by default.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(HEADER_OF_WRITTEN)
    for answer, points in zip(answers, awarded or [""] * len(answers), strict=True):
        words = safe_cell(answer.text, MOST_LETTERS)
        table.writerow((safe_cell(answer.handed_in), safe_cell(answer.question), words, points))
    return text.getvalue()


def safe_cell(value: object, longest: int = LONGEST) -> object:
    """Make a text safe: one line of visible characters, and no formula."""
    if not isinstance(value, str):
        return value
    line = "".join(sign if sign.isprintable() else " " for sign in value[: 10 * longest])
    line = " ".join(line.split())
    line = f"{line[: longest - 1]}…" if len(line) > longest else line
    return f"'{line}" if line.startswith(FORMULA) or value.startswith(FORMULA) else line


def account(marks: Sequence[Mark], grades: Sequence[Grade]) -> tuple[str, bool]:
    """Return a closing account of all that was handed in, and whether a person has to look at something.

    Examples
    --------
    >>> marks = [Mark("ada/1.ipynb", "speed", True, ""), Mark("bob/", "", False, "", "hw.py", NO_NOTEBOOK)]
    >>> account(marks, grade(marks, {}))
    ('2 folders and files: 1 marked; not a notebook: bob (hw.py)', True)
    """
    listed: dict[str, dict[str, None]] = {problem: {} for problem in PROBLEMS}
    for mark in (mark for mark in marks if mark.problem):
        sent = mark.handed_in.split("/")[0]
        listed[mark.problem][f"{sent} ({mark.note})" if mark.note else sent] = None
    for student in (student for student in grades if student.problem):
        listed[student.problem][student.sent or student.columns["Student"]] = None
    students = {sent_by(mark.handed_in) for mark in marks}
    marked = {sent_by(mark.handed_in) for mark in marks if mark.exercise and not mark.handed_in.endswith("/")}
    parts = [f"{problem}: {printable(', '.join(names))}" for problem, names in listed.items() if names]
    text = "; ".join([f"{len(students)} folders and files: {len(marked)} marked", *parts])
    return text, bool(parts)


def write_feedback(grades: Iterable[Grade], points: Points, folder: Path) -> list[Path]:
    """Write a page for each student: what the check of each exercise said, its points, and their sum.

    The name of each begins as that of what was handed in, by which Moodle finds whose it is.
    """
    make_folder(folder)
    files: list[Path] = []
    for student in (student for student in grades if student.sent):
        start = re.sub(r"[^\w .@-]", "-", student.sent).lstrip(".")[:100]
        file = folder / f"{start}_feedback.html"
        while file in files:  # of another name with other signs
            file = file.with_stem(f"{file.stem}_")
        write_file(file, _page(student, points))
        files.append(file)
    return files


def _page(student: Grade, points: Points) -> str:
    """Return the page of a student, in which characters that are no text are replaced."""
    worth = {name: points.get(name, 1) if name else 0 for name in student.best}
    parts = [f"<p><b>{student.points:g} of {sum(worth.values()):g}</b>All points</p>"]
    for name, mark in student.best.items():
        earned = mark.earned(worth[name])
        of_all = f"<b>{earned:g} of {worth[name]:g}</b>" if name else ""
        said = mark.said.removeprefix(f"✗ {name}: ").removeprefix(f"✓ {name}: ")
        parts.append(f"<h2>{of_all}{'✓' if mark.right else '✗'} {escape(name)}</h2>")
        parts.append(f"<p>{escape(said)}</p>")
    title = escape(student.columns.get("Full name") or student.columns["Student"])
    page = PAGE.substitute(title=title, body="\n".join(parts))
    return page.encode("utf-8", "replace").decode("utf-8")
