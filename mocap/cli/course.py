"""The commands `mocap course`, for those who teach from the notebooks or write them, and `mocap lab`."""

import functools
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from mocap._shared.atomic import require_writable, write_file
from mocap.cli.option_types import number
from mocap.cli.outputs import require_address
from mocap.cli.stages import bar
from mocap.cli.typed_commands import Group
from mocap.course import marking
from mocap.course.handout import WHEEL, hand_out, write_new
from mocap.course.notebooks import run as run_notebook
from mocap.course.opening import build_lite, open_course, stored
from mocap.course.student_wheel import NotInstallable
from mocap.course.written import Answer
from mocap.errors import MocapError

Points = Annotated[Path | None, "a .toml file of lines EXERCISE = POINTS (default: 1 each)"]
ALL_BEHIND = Parameter(consume_multiple=True, allow_leading_hyphen=True, show=False)  # even with hyphens
HANDOUT = Path("mocap-handout")
Moving = Annotated[bool, "run the notebooks, which takes minutes, and record the sliders of experiments"]


def handout(
    notebooks: Sequence[Path] = (),
    *,
    out: Path = HANDOUT,
    wheel: bool = False,
    from_: Annotated[str, "address from which pip installs the package, such as git+https://HOST/mocap"] = "",
    nbgrader: bool = False,
    points: Points = None,
) -> None:
    """Copy the notebooks without their solutions.

    Hints and outputs are also removed. The files that JupyterHub, Binder and Colab need to run the notebooks
    are added. The first cell of each copy and requirements.txt install the package: with --wheel from a file
    beside the notebooks, with --from from an address, and otherwise by its name. An address and the name are
    tried on this machine, and refused if pip cannot install them.

    Parameters
    ----------
    notebooks : notebooks to copy (default: the whole course).
    out : folder to write to.
    wheel : put the package into the folder, without solutions and answers, as the file to install it from.
    nbgrader : write a course folder for nbgrader, in which solutions, checks and points are marked.

    Notes
    -----
    Example: mocap course handout notebooks/02-matching.ipynb --wheel -o handout
    """
    worth = marking.grades.read_points(points)
    if wheel and from_:
        raise MocapError(
            "--wheel puts the package into the folder, --from names an address: give one of them."
        )
    origin = WHEEL if wheel else from_
    try:
        copies = hand_out(notebooks, out, origin, worth, nbgrader=nbgrader)
    except NotInstallable as error:
        remedy = "add --wheel, which puts the package into the handout, or correct --from"
        raise MocapError(f"{error.obstacle}: {remedy}.") from error
    print(f"wrote {len(copies)} notebooks to {out}")


def site(*, out: Path = Path("mocap-site"), moving: Moving = False, address: str = "") -> None:
    """Write the course as HTML pages that need no network.

    Parameters
    ----------
    out : folder to write to.
    address (URL) : where the site will be published, as in https://example.org/course. Links to it then show
        a picture.

    Notes
    -----
    Example: mocap course site -o site
    """
    require_address(address, "https://example.org/course")
    from mocap.course.site import build_site  # the help needs no NumPy

    print(f"wrote {build_site(stored(), out, bar('converting'), moving=moving, address=address)}")


def slides(*, out: Path = Path("mocap-slides"), moving: Moving = False) -> None:
    """Write the slides of the course as HTML pages that need no network.

    Parameters
    ----------
    out : folder to write to.

    Notes
    -----
    Example: mocap course slides -o slides, then open slides/index.html.
    """
    from mocap.course.teaching.slides import build_slides

    print(f"wrote {build_slides(stored(), out, bar('converting'), moving=moving)}")


def lite(*, out: Path = Path("mocap-lite")) -> None:
    """Build a JupyterLite site of the course, which runs in the browser.

    Parameters
    ----------
    out : folder to write to.

    Notes
    -----
    Example: mocap course lite -o lite
    """
    print(f"wrote {build_lite(stored(), out)}")


def film(notebook: Path, *, out: Path | None = None, still: bool = False) -> None:
    """Render a film of the slides of a notebook.

    Parameters
    ----------
    notebook : the notebook.
    out : file to write, .mp4 (default: the name of the notebook, in the current folder).
    still : do not run the notebook, so that its sliders do not move.

    Notes
    -----
    Example: mocap course film notebooks/06-pruning.ipynb -o pruning.mp4
    """
    from mocap.course.teaching.films import render_film

    out = out or Path(notebook.with_suffix(".mp4").name)
    require_writable(out)
    render_film(notebook, out, moving=not still, progress=bar("drawing"))
    print(f"wrote {out}")


def board(*, out: Path = Path("mocap-board")) -> None:
    """Write the drawings for the blackboard as PNG files.

    Parameters
    ----------
    out : folder to write to.

    Notes
    -----
    Example: mocap course board -o board, then open board/board.png.
    """
    from mocap.course.teaching.board import write_board

    files = write_board(out, bar("drawing"))
    print(f"wrote {len(files)} pictures to {out}; {files[-1]} shows all")


def exam(
    *,
    key: Path,
    out: Path = Path("mocap-exam"),
    words: Annotated[
        Path | None, 'a .toml file of your answers in words, in lines such as 28 = "..."'
    ] = None,
) -> None:
    """Draw the numbers of an exam with a key of your own, and write its questions and answers.

    The same key always draws the same exam. Without the key, no one knows its numbers. The package contains
    no answers: those in numbers are computed from the drawn numbers, functions are tested with inputs whose
    results are known, and answers in words are yours. Keep the key and answers.md away from students.

    Parameters
    ----------
    key : a file with a secret of at least 20 characters. If it does not exist, a random key is written to it.
    out : folder to write to: exam.md for students, answers.md for you.

    Notes
    -----
    Example: mocap course exam --key exam.key -o exam
    """
    from mocap.course.exam import sheets  # the help needs no NumPy
    from mocap.course.exam.drawing import read_key

    own_words = sheets.read_words(words)
    secret, is_new = read_key(key)
    if is_new:
        print(f"wrote a new key, {key}; keep it: only this key draws the same exam again")
    write_new({out / name: content for name, content in sheets.write_exam(secret, own_words).items()})
    print(f"wrote {out / 'exam.md'} for students, and {out / 'answers.md'} for teachers only")


def mark(
    folder: Path,
    *,
    out: Path = Path("marks.csv"),
    points: Points = None,
    roster: Annotated[Path | None, "the .csv file of students, exported from Moodle or Canvas"] = None,
    written: Annotated[Path | None, "OUT-written.csv, in which a person has filled in the points"] = None,
    feedback: Annotated[Path | None, "folder to write to, with an HTML page for each student"] = None,
    partial: Annotated[bool, "give a wrong function the fraction of its points on which it is right"] = False,
    jobs: Annotated[int, number(1, 64, int), "number of notebooks that are marked at a time"] = 1,
    container: Annotated[
        bool, "run the command in a container, with podman or docker, without a network"
    ] = False,
) -> int:
    """Mark a folder of submitted notebooks, and write .csv files.

    There are five .csv files: OUT has a line for each exercise, OUT-table has a line for each student, OUT-
    moodle and OUT-canvas have the columns that Moodle and Canvas import, and OUT-written has the answers in
    words, for a person, whose points --written adds to the marks. The page OUT-class.html shows which
    exercises the class solved, and the most frequent mistakes. The last three columns of OUT are for the
    teacher alone and change no mark: a note names what a solution uses by which an answer could have been
    taken over, and the other two say whether a function is the same as the published solution, or as those of
    other students. The last line accounts for all that was handed in, and for students of the roster who
    handed in nothing. The exit status is 2 if a person has to look at something. Each notebook runs in its
    own process, with a new home folder, few environment variables, and limits of time, memory, processes and
    files. The first line of the output reports the isolation on this system: whether a notebook can read or
    write files outside Python and its home folder, and whether it has a network. If you do not trust the
    submissions, first read "Hand out, and mark" in notebooks/README.md.

    Parameters
    ----------
    folder : a folder with a folder of notebooks for each student.
    out : file to write, .csv.

    Notes
    -----
    Example: mocap course mark handed-in -o marks.csv --points points.toml --feedback feedback
    """
    tell = functools.partial(print, file=sys.stderr)
    if container:
        files = {"": folder, "--points": points, "--roster": roster, "--written": written}
        results = {"--out": out, "--feedback": feedback}
        options = ["--jobs", str(jobs), *(["--partial"] if partial else [])]
        return marking.container.mark_in_container(files, results, options, tell)
    marking.walls.require_sealing()  # before anything is read
    worth = marking.grades.read_points(points)
    students = marking.rosters.read_roster(roster)
    require_writable(out)
    answers = marking.written_answers(folder)
    table_of_answers = out.with_stem(f"{out.stem}-written")
    in_words = _points_in_words(written, table_of_answers, answers, worth)
    marks: list[marking.grades.Mark] = []
    grades: list[marking.grades.Grade] = []
    for marks_of_notebook in marking.mark(folder, bar("marking"), tell, jobs, partial_points=partial):
        marks += marks_of_notebook
        grades = _write_tables(marks, worth, students, out)  # before the next notebook runs
    right = sum(mark.right for mark in marks)
    judged = sum(bool(mark.exercise) for mark in marks)
    if in_words:
        marks += in_words.marks
        worth["written"] = in_words.possible
        grades = _write_tables(marks, worth, students, out)
    write_file(table_of_answers, marking.grades.written_table(answers, in_words.texts if in_words else ()))
    page = marking.class_page.class_page(grades, out.stem)
    write_file(out.with_name(f"{out.stem}-class.html"), page)
    if feedback:
        print(f"wrote {len(marking.grades.write_feedback(grades, worth, feedback))} pages to {feedback}")
    print(f"wrote {out} and five more: {right} of {judged} are right")
    said, needs_person = marking.grades.account(marks, grades)
    if in_words and in_words.without:
        said = f"{said}; answers in words without points: {in_words.without}"
        needs_person = True
    print(said, file=sys.stderr)
    return 2 if needs_person else 0


def _points_in_words(
    file: Path | None, replaced: Path, answers: Sequence[Answer], worth: "marking.grades.Points"
) -> "marking.written_points.GivenPoints | None":
    """Read the points of answers in words, if there is a file, and else refuse to replace a table of them."""
    if file:
        return marking.written_points.read_given_points(file, answers, worth)
    if marking.written_points.has_points(replaced):
        raise MocapError(f"{replaced} has points of a person: give it to --written, or change --out.")
    return None


def _write_tables(
    marks: "Sequence[marking.grades.Mark]",
    worth: "marking.grades.Points",
    students: "marking.rosters.Roster",
    out: Path,
) -> "list[marking.grades.Grade]":
    """Write the tables of the marks so far, and return the grades."""
    grades = marking.grades.grade(marks, worth, students)
    for end, text in marking.grades.tables(marks, grades, worth, out.stem).items():
        write_file(out.with_stem(f"{out.stem}{end}"), text)
    return grades


def run(notebooks: Sequence[Path] = ()) -> None:
    """Run notebooks and store them with their outputs.

    Parameters
    ----------
    notebooks : notebooks to run (default: the whole course).

    Notes
    -----
    Example: mocap course run notebooks/02-matching.ipynb
    """
    folder = stored()
    for notebook in bar("running")(notebooks or sorted(folder.glob("*.ipynb"))):
        run_notebook(notebook, folder.parent / "figures")


def lab(
    folder: Path = Path("mocap-course"),
    *,
    reset: str = "",
    jupyter: Annotated[Sequence[str], ALL_BEHIND] = (),
) -> int:
    """Open the course in JupyterLab, and print what is new in it and which exercises are solved.

    Words after -- are passed to JupyterLab as options.

    Parameters
    ----------
    folder : folder for a copy of the notebooks, of which existing ones are not changed.
    reset : number of a notebook, such as 03, to give anew with your answers in it; the old one is kept.

    Notes
    -----
    Example: mocap lab -- --no-browser --port 8890
    """
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # `open_course` keeps waiting after a KeyboardInterrupt
    return int(open_course(folder, jupyter, reset))


COURSE = Group(
    "Hand out, mark, publish or run the notebooks.",
    {command.__name__: command for command in (handout, site, slides, film, board, lite, exam, mark, run)},
)
