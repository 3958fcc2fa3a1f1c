"""What a class misunderstood: the fraction that solved each exercise, and the mistakes made most often.

The page is a picture that fits on one sheet: a bar for each exercise, and below it the mistakes in the words
of the hints, each with the number of students who made it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path
from string import Template

from mocap._shared.records import NamedTuple
from mocap.course.checks import all_checks
from mocap.course.marking.grades import Grade, Mark

MOST_MISTAKES = 3  # of an exercise that are listed
NUMBER = re.compile(r"-?\d[\d.,e+-]*")
LONGEST = 140  # characters of a mistake
RAISED = re.compile(r"your function raises (\w+)|cells? raises? (\w+)")
PAGE = Template(Path(__file__).with_name("class_page.html").read_text("utf-8"))
ABSENT = "not handed in"
UNWRITTEN = "not written yet"
UNNAMED = "wrong, by no mistake that has a hint"
STOPPED = "never ends, or ends Python"


class Summary(NamedTuple):
    """What a class did with an exercise.

    Attributes
    ----------
    exercise : its name.
    students : how many there are.
    solved : how many solved it.
    mistakes : the most frequent mistakes, each with the number of students who made it.
    """

    exercise: str
    students: int
    solved: int
    mistakes: list[tuple[str, int]]


def summaries(grades: Sequence[Grade]) -> list[Summary]:
    """Sum up each exercise over a class, in the order of the course.

    Examples
    --------
    >>> from mocap.course.marking.grades import grade
    >>> names = ("ada", "bob", "cyn")
    >>> marks = [Mark(f"{name}/0.ipynb", "speed", name == "ada", "✗ speed: 1 of 3 m.") for name in names]
    >>> summaries(grade(marks, {}))
    [Summary(exercise='speed', students=3, solved=1, mistakes=[('… of … m.', 2)])]
    """
    table = []
    for name in all_checks():
        marks = [student.best[name] for student in grades if name in student.best]
        if marks:
            mistakes = Counter(_mistake_of(mark) for mark in marks if not mark.right)
            solved = sum(mark.right for mark in marks)
            table.append(Summary(name, len(grades), solved, mistakes.most_common(MOST_MISTAKES)))
    return table


def _mistake_of(mark: Mark) -> str:
    """Return what a wrong function is told, without the numbers that differ from student to student."""
    said = mark.said.removeprefix(f"✗ {mark.exercise}: ")
    for hint in all_checks()[mark.exercise].texts.mistakes.values():
        if said.startswith(hint):
            return hint
    if "not handed in" in said or "its cell is missing" in said:
        return ABSENT
    if said.startswith("not there yet"):
        return UNWRITTEN
    if said.startswith(("stopped after", "ends Python", "not tried")):
        return STOPPED
    if raised := RAISED.search(said):
        return f"raises {raised[1] or raised[2]}"
    if said.startswith("For ") and "you return" in said:
        return UNNAMED
    sentence = NUMBER.sub("…", said)
    return sentence if len(sentence) <= LONGEST else f"{sentence[: LONGEST - 1]}…"


def class_page(grades: Sequence[Grade], title: str) -> str:
    """Return the page of a class as HTML."""
    rows = []
    for summary in summaries(grades):
        percent = 100 * summary.solved / summary.students
        bar = f'<span class="bar"><span style="width: {percent:.0f}%"></span></span>'
        head = f"<h2>{escape(summary.exercise)}</h2>{bar}<b>{percent:.0f} %</b>"
        mistakes = "".join(f"<li><b>{number}</b> {escape(text)}</li>" for text, number in summary.mistakes)
        rows.append(
            f'<section title="{summary.solved} of {summary.students}">{head}<ul>{mistakes}</ul></section>'
        )
    columns = min(3, 1 + len(rows) // 9)
    return PAGE.substitute(title=escape(title), students=len(grades), columns=columns, body="\n".join(rows))
