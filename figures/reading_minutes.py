"""How many minutes each notebook takes a student, computed from what it contains, and stated in it.

Words are read at 120 per minute, the speed of a reader of English as a second language. Alternative texts of
pictures, code in solutions and the references at the end are not counted. The minutes of an exercise are
those of its check in `mocap/course/checks/hints`. `python figures/reading_minutes.py` prints the parts of
each sum, and with `--state` it writes the sums into the notebooks and the guide for teachers.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.atomic import write_file
from mocap.course import checks
from mocap.course.notebooks import read

FOLDER = Path(__file__).parents[1] / "notebooks"
GUIDE = FOLDER / "README.md"

WORDS = 120  # per minute
LINE = 8 / 60  # minutes to read a line of code
EXPERIMENT = 4.0  # minutes, with its prediction
QUIZ = 0.5  # minutes
READER_EXERCISE = 12.0  # minutes, as a reader of 00 to 10 counted them
READER_EXERCISE_IN_00 = 5.0  # minutes
READER_EXPERIMENT = 5.0  # minutes
LAST_OF_WAY = 10  # the number of the last notebook of the main sequence
NOT_READ = re.compile(
    r"^## Read on$.*|```.*?```|!\[.*?\]\([^)]*\)|<!--.*?-->|<[^>]*>", re.DOTALL | re.MULTILINE
)
STATED = re.compile(r"(\*\*About )\d+( minutes)")


class Contents(NamedTuple):
    """What a student reads and does in some cells.

    Attributes
    ----------
    words : words of the text.
    lines : lines of code that are not empty.
    quizzes, experiments : how many there are.
    exercises : minutes for all exercises.
    """

    words: int
    lines: int
    quizzes: int
    experiments: int
    exercises: int

    @property
    def minutes(self) -> float:
        """Minutes to read all of it, and to do the rest."""
        reading = self.words / WORDS + self.lines * LINE
        return reading + self.quizzes * QUIZ + self.experiments * EXPERIMENT + self.exercises


def contents(cells: Iterable[Any]) -> Contents:
    """Count what a student reads and does in some cells of a notebook."""
    words = 0
    lines = 0
    quizzes = 0
    experiments = 0
    exercises = 0
    for cell in cells:
        if cell.cell_type == "markdown":
            words += len(NOT_READ.sub(" ", cell.source).split())
            continue
        tags = [tag.partition(":") for tag in cell.metadata.get("tags", ())]
        lines += sum(bool(line.strip()) for line in cell.source.splitlines())
        quizzes += cell.source.count("lab.quiz(")
        experiments += any(kind == "experiment" for kind, *_ in tags)
        exercises += sum(checks.all_checks()[name].minutes for kind, _, name in tags if kind == "exercise")
    return Contents(words, lines, quizzes, experiments, exercises)


def reader_hours() -> float:
    """Return the hours of the main sequence, with a reader's own minutes for exercises and experiments."""
    minutes = 0.0
    for path in sorted(FOLDER.glob("*.ipynb")):
        number = path.stem.partition("-")[0]
        if not number.isdigit() or int(number) > LAST_OF_WAY:
            continue
        cells = read(path).cells
        whole = contents(cells)
        tags = [tag for cell in cells for tag in cell.metadata.get("tags", ())]
        exercises = sum(tag.startswith("exercise:") for tag in tags)
        per_exercise = READER_EXERCISE if int(number) else READER_EXERCISE_IN_00
        minutes += whole._replace(exercises=0, experiments=0).minutes
        minutes += exercises * per_exercise + whole.experiments * READER_EXPERIMENT
    return minutes / 60


def state(name: str, minutes: int) -> None:
    """Write the minutes of a notebook into it, and into the guide wherever it states them for the whole."""
    notebook = FOLDER / f"{name}.ipynb"
    write_file(notebook, STATED.sub(rf"\g<1>{minutes}\2", notebook.read_text("utf-8")))
    whole = rf"((?<!rest of )\[[^\]]+\]\({name}\.ipynb\) (?:\| |\())\d+"
    write_file(GUIDE, re.sub(whole, rf"\g<1>{minutes}", GUIDE.read_text("utf-8")))


def main(arguments: list[str]) -> None:
    """Print what each notebook contains, with the minutes of it, and state them if `--state` is given."""
    print(f"{'':28}{'words':>7}{'lines':>7}{'quizzes':>9}{'experiments':>13}{'exercises':>11}{'minutes':>9}")
    for path in sorted(FOLDER.glob("*.ipynb")):
        whole = contents(read(path).cells)
        row = f"{whole.words:7}{whole.lines:7}{whole.quizzes:9}{whole.experiments:13}{whole.exercises:11}"
        print(f"{path.stem:28}{row}{whole.minutes:9.0f}")
        if "--state" in arguments:
            state(path.stem, round(whole.minutes))
    print(f"00 to 10 with the minutes of a reader: {reader_hours():.1f} hours")


if __name__ == "__main__":
    main(sys.argv[1:])
