"""Points that a person gave to answers in words, read back from the table that `mark` wrote for it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from mocap._shared.records import NamedTuple
from mocap.course.marking.grades import HEADER_OF_WRITTEN, Mark, Points, safe_cell
from mocap.course.marking.hand_ins import sent_by
from mocap.course.marking.rosters import read_lines
from mocap.course.written import KIND, OTHER, Answer
from mocap.errors import MocapError

MOST_POINTS = 1000  # of an answer, unless the points file says how many
MOST_BYTES = 100_000_000  # of a file
SHOWN = 40  # characters of a value in an error

Place = tuple[object, object]
"""The notebook and the question of an answer, as the table writes them."""


class GivenPoints(NamedTuple):
    """The points of answers in words.

    Attributes
    ----------
    marks : one for each student who got points, with their sum.
    possible : the sum that a student can get, as far as it is known.
    without : how many answers to questions of the course have no points.
    texts : the points of each answer in the order of the answers, "" for none.
    """

    marks: list[Mark]
    possible: float
    without: int
    texts: list[str]


def read_given_points(file: Path, answers: Sequence[Answer], points: Points) -> GivenPoints:
    """Read the points of answers in words.

    Parameters
    ----------
    file : the table that `mark` wrote, with the points filled in. Other columns may have been added.
    answers : that were handed in.
    points : `written` is the largest number of points of an answer.

    Raises
    ------
    MocapError : if the file cannot be read or is too large, has no column of the three that are needed, or
        has a line with other points than 0 to the largest number, or with an answer that is not handed in.
    """
    lines = _lines_of(file)
    remaining = [_place(answer) for answer in answers]
    texts = [""] * len(answers)
    for number, line in enumerate(lines, 2):  # as a spreadsheet counts: the first line is the header
        place = (line[HEADER_OF_WRITTEN[0]], line[HEADER_OF_WRITTEN[1]])
        if place not in remaining:
            name = f"{place[0]:.{SHOWN}}, {place[1]:.{SHOWN}}"
            raise MocapError(f"{file}, line {number}: '{name}' is not handed in, or has another line.")
        index = remaining.index(place)
        remaining[index] = ("", "")
        texts[index] = _points_text(line[HEADER_OF_WRITTEN[-1]], f"{file}, line {number}", points)
    return _summed(answers, texts, points)


def _lines_of(file: Path) -> list[dict[str, str]]:
    """Read the lines of a table that have an answer."""
    if file.exists() and file.stat().st_size > MOST_BYTES:
        raise MocapError(f"{file} has more than {MOST_BYTES // 10**6} MB, which is no table of points.")
    header, *lines = read_lines(file) or [[]]
    needed = {name for name in HEADER_OF_WRITTEN if name != "answer"}
    if missing := sorted(needed - {*header}):
        raise MocapError(f"{file}: there is no column '{missing[0]}', as in the table that mark writes.")
    rows = []
    for number, line in enumerate(lines, 2):
        if len(line) < len(header) and any(line):
            raise MocapError(
                f"{file}, line {number}: {len(line)} columns, where the header has {len(header)}."
            )
        rows.append(dict(zip(header, line, strict=False)))
    while rows and not any(rows[-1].values()):  # empty lines at the end
        rows.pop()
    return rows


def _place(answer: Answer) -> Place:
    """Return how the table names an answer."""
    return safe_cell(answer.handed_in), safe_cell(answer.question)


def _points_text(text: str, place: str, points: Points) -> str:
    """Return a number of points as text, or "" for none.

    Examples
    --------
    >>> _points_text(" 2,5 ", "marks-written.csv, line 2", {})
    '2.5'
    """
    number = text.strip().replace(",", ".")
    largest = points.get(KIND, MOST_POINTS)
    if not number:
        return ""
    try:
        is_possible = 0 <= float(number) <= largest
    except ValueError:
        is_possible = False
    if not is_possible:
        raise MocapError(f"{place}: '{text:.{SHOWN}}' is no number of points from 0 to {largest:g}.")
    return number


def _summed(answers: Sequence[Answer], texts: list[str], points: Points) -> GivenPoints:
    """Sum up the points of each student."""
    parts: dict[object, list[tuple[Answer, str]]] = {}
    for answer, text in zip(answers, texts, strict=True):
        if text:
            parts.setdefault(sent_by(answer.handed_in), []).append((answer, text))
    marks = [_mark_of(awarded) for awarded in parts.values()]
    questions = Counter(sent_by(answer.handed_in) for answer in answers if answer.question != OTHER)
    sums = [mark.awarded or 0 for mark in marks]
    possible = points[KIND] * max(questions.values(), default=0) if KIND in points else max(sums, default=0)
    pairs = zip(answers, texts, strict=True)
    without = sum(answer.question != OTHER and not text for answer, text in pairs)
    return GivenPoints(marks, possible, without, texts)


def _mark_of(awarded: Sequence[tuple[Answer, str]]) -> Mark:
    """Return the mark of a student's answers in words."""
    total = round(sum(float(text) for _, text in awarded), 4)
    if total.is_integer():
        total = int(total)
    said = ", ".join(f"{answer.question}: {text}" for answer, text in awarded)
    first, _ = awarded[0]
    return Mark(first.handed_in, KIND, total > 0, said, awarded=total)


def has_points(file: Path) -> bool:
    """Return whether a person has written points into a table.

    Examples
    --------
    >>> has_points(Path("nowhere.csv"))
    False
    """
    if not file.exists():
        return False
    return any(line[HEADER_OF_WRITTEN[-1]].strip() for line in _lines_of(file))
