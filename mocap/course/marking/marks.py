"""Marks for the notebooks in a folder, exercise by exercise."""

from __future__ import annotations

import copy
import hashlib
import multiprocessing
import signal
import sys
import time
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import closing
from functools import partial
from itertools import repeat
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import mocap
from mocap._shared.progress import Progress
from mocap._shared.tasks import serve
from mocap.course.check import Verdict
from mocap.course.checks import all_checks
from mocap.course.checks.inputs import noted_requests
from mocap.course.marking.cells import Cell, Sheet, code_cells, course_sheets, sheet_of, without_commands
from mocap.course.marking.grades import NO_EXERCISE, NO_NOTEBOOK, NOTHING, UNKNOWN, Mark
from mocap.course.marking.hand_ins import Collected, Sent, collect, sent_by
from mocap.course.marking.likeness import is_published, tree_of
from mocap.course.marking.notes import note
from mocap.course.marking.plain_data import unpack
from mocap.course.marking.sealed import Ended, Sealed, guards_files, protection
from mocap.course.marking.walls import require_sealing
from mocap.course.notebooks import library, names_of
from mocap.course.opening import stored
from mocap.course.written import Answer, answers_in
from mocap.errors import MocapError

SECONDS = 30  # time limit of an exercise
STARTING = 120  # time limit of the first cell, which imports much
BUDGET = 360  # seconds of a notebook: all its exercises, and each new start
MOST_PARTS = 2_000_000  # lists, dictionaries and texts in it
MOST_CODE = 1 << 20  # letters of code in it
SAID = 250  # characters of names that are listed
MISSING = "its cell is missing."
CHANGES_PACKAGE = "✗ changes the installed package."
_students: list[Sealed] = []  # the single one by which this process marks notebook after notebook


class _Task(NamedTuple):
    """How all notebooks are marked: the seed of the random inputs, and what earns points."""

    seed: int
    partial_points: bool = False


class _Handed(NamedTuple):
    """A notebook that was handed in: its path, its cells, the course's, and what is wrong with it."""

    path: str
    cells: list[Cell]
    sheet: Sheet = ((), frozenset())
    wrong: str = ""
    written: Sequence[Answer] = ()


def written_answers(folder: Path) -> list[Answer]:
    """List what students wrote in the cells of text of their notebooks, for a person to read.

    Examples
    --------
    >>> written_answers(Path("nowhere"))
    []
    """
    sheets = course_sheets(stored())
    notebooks = collect(folder).notebooks if folder.is_dir() else []
    return [answer for sent in notebooks for answer in _read(sent, sheets).written]


def mark(
    folder: Path,
    progress: Progress = iter,
    tell: Callable[[str], object] = str,
    jobs: int = 1,
    *,
    partial_points: bool = False,
) -> Iterator[list[Mark]]:
    """Mark the exercises of all notebooks in a folder and in the folders inside it.

    All notebooks are read before the first one runs. Each runs in a process of its own, with a new folder as
    its home, few variables in its environment, limits of time, memory, processes and files, and the `walls`
    that this system can raise; what it prints is thrown away. At the end all that it started is killed. The
    first cell runs, then each exercise with the cells that define what it uses. The checks run here, on
    random input of their own. Nothing keeps a notebook from calling the package's own functions, where the
    answers to many exercises are: a note for the teacher says so, and changes no mark.

    Parameters
    ----------
    folder : the notebooks handed in; the folder in it that holds a notebook says whose it is, or the name of
        the file, as Canvas gives it.
    progress : wraps the notebooks while they are marked.
    tell : gets a sentence that says what walls there are, before the first notebook runs.
    jobs : how many notebooks are marked at a time; one, where no wall keeps them apart.
    partial_points : whether a wrong function earns points by the random inputs on which it is right.

    Yields
    ------
    The marks of each notebook, one for each exercise: also for those that a notebook of the course has and a
    copy lacks; then a mark for each exercise that others handed in and a student did not, also of students
    who handed in no notebook.

    Raises
    ------
    MocapError : if there are no notebooks, this system cannot seal a process, or a notebook has changed the
        package where no wall kept it from that.

    Examples
    --------
    >>> list(mark(Path("nowhere")))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    library()
    require_sealing()
    collected = collect(folder) if folder.is_dir() else Collected([], {})
    if not collected.notebooks:
        raise MocapError(f"The folder {folder} holds no notebooks.")
    sheets = course_sheets(stored())
    marked: list[Mark] = []
    handed_in = [_read(sent, sheets) for sent in collected.notebooks]
    seed = int(np.random.default_rng().integers(2**32))
    hidden = [stored(), *{folder / notebook.path.split("/")[0] for notebook in handed_in}]
    with closing(Sealed(hidden)) as student:
        tell(protection(student.walls))
        fingerprint = _fingerprint(student.walls)
        _students[:] = [student]
        task = _Task(seed, partial_points=partial_points)
        work = (_marks(notebook, task) for notebook in handed_in)
        if jobs > 1 and not fingerprint:
            work = _in_parallel(handed_in, task, hidden, jobs)
        with closing(work):
            for notebook, marks in zip(progress(handed_in), work, strict=False):
                if _fingerprint(student.walls) != fingerprint:
                    yield [mark._replace(right=False, said=CHANGES_PACKAGE) for mark in marks]
                    changer = f"{notebook.path} has changed the package"
                    raise MocapError(f"{changer}: install it anew, use a container.")
                yield marks
                marked += marks
    yield from _missing(handed_in, marked)
    yield from _without_notebook(collected, marked)


def _missing(handed_in: list[_Handed], marked: list[Mark]) -> Iterator[list[Mark]]:
    """Mark as wrong the exercises that others handed in and a student did not."""
    exercises = _exercises_of(marked)
    places = {sent_by(notebook.path): notebook.path.split("/")[0] for notebook in handed_in}
    for student, place in places.items():
        submitted = {mark.exercise for mark in marked if sent_by(mark.handed_in) == student}
        names = [name for name in exercises if name not in submitted]
        _, number = student
        is_folder = place == student[0]
        if number or is_folder:  # a file without a folder names no student
            yield [_not_handed_in(place, name) for name in names]


def _without_notebook(collected: Collected, marked: list[Mark]) -> Iterator[list[Mark]]:
    """Mark as wrong all exercises of students who handed in no notebook."""
    for place, names in collected.without_notebook.items():
        files = ", ".join(names)
        problem = NO_NOTEBOOK if names else NOTHING
        said = f"is no notebook: {files}."[:SAID] if names else "nothing is in the folder."
        whole = Mark(f"{place}/", "", False, said, files[:SAID], problem)
        yield [whole, *(_not_handed_in(place, name) for name in _exercises_of(marked))]


def _exercises_of(marked: list[Mark]) -> list[str]:
    """List the exercises that have been marked, in the order of the course."""
    names = {mark.exercise for mark in marked}
    return [name for name in all_checks() if name in names]


def _not_handed_in(place: str, name: str) -> Mark:
    return Mark(f"{place}/", name, False, f"✗ {name}: not handed in.")


def _in_parallel(
    handed_in: list[_Handed], task: _Task, hidden: Sequence[Path], jobs: int
) -> Generator[list[Mark]]:
    """Mark several notebooks at a time; at the end, also an early one, no process is left."""
    fork = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(jobs, fork, _begin, (hidden,)) as pool:
        try:
            yield from pool.map(_marks, handed_in, repeat(task))
        except BrokenExecutor as error:
            raise MocapError("A worker was ended from outside: is there enough memory?") from error
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in multiprocessing.active_children():
                worker.terminate()


def _begin(hidden: Sequence[Path]) -> None:
    """Prepare a process of `_in_parallel`, with a student's process of its own."""
    serve()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _students[:] = [Sealed(hidden)]


def _fingerprint(walls: Sequence[str]) -> bytes:
    """Compute a hash of the package's files if no wall keeps a notebook from changing them."""
    if guards_files(walls):
        return b""
    sys.dont_write_bytecode = True
    files = sorted(file for file in Path(mocap.__file__).parent.rglob("*") if file.is_file())
    return hashlib.sha256(b"".join(bytes(file) + file.read_bytes() for file in files)).digest()


def _read(sent: Sent, sheets: Sequence[Sheet]) -> _Handed:
    """Read a notebook that was handed in; an error becomes its field `wrong`."""
    try:
        text = sent.read().decode("utf-8-sig", "replace")
        if sum(map(text.count, '[{"')) > MOST_PARTS:  # they would take a hundred times their place in memory
            raise MocapError("holds too much.")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of cells without ids, as some editors write them
            notebook = library().reads(text, as_version=4)
        cells = code_cells(notebook)
        if sum(len(cell.source) for cell in cells) > MOST_CODE:
            raise MocapError(f"holds more than {MOST_CODE >> 20} MB of code.")
        sheet = sheet_of(notebook, sheets)
        return _Handed(sent.path, cells, sheet, written=answers_in(notebook, sent.path, sheet[1]))
    except MocapError as error:
        wrong = f"{sent.path}: {error}"
    except Exception:  # nbformat raises errors of many kinds, and lets some things pass that are no notebooks
        wrong = f"{sent.path}: is not a notebook."
    return _Handed(sent.path, [], wrong=wrong)


def _marks(handed: _Handed, task: _Task) -> list[Mark]:
    """Mark a notebook; an error costs this notebook only."""
    try:
        return list(_marks_of(handed, task, _students[0]))
    except Exception as error:
        return [Mark(handed.path, "", False, f"cannot be marked: {type(error).__name__}.")]


def _marks_of(handed: _Handed, task: _Task, student: Sealed) -> Iterator[Mark]:
    """Mark the exercises of the course's notebook, and those of others of which it has cells."""
    exercises, course = handed.sheet
    tags = [name for cell in handed.cells for name in cell.exercises]
    names = list(dict.fromkeys([*exercises, *tags]))
    unknown = [name for name in names if name not in all_checks()]
    names = [name for name in names if name not in unknown]
    if unknown:
        listed = ", ".join(f"`{name}`" for name in unknown)
        said = f"The course does not know the tag {listed}."[:SAID]
        yield Mark(handed.path, "", False, said, ", ".join(unknown)[:SAID], UNKNOWN)
    elif not names:
        problem = NO_NOTEBOOK if handed.wrong else NO_EXERCISE
        yield Mark(handed.path, "", False, handed.wrong or "holds no exercise of the course.", "", problem)
    verdicts, passed = _judge_all(handed.cells, names, task, student)
    wrong = {name for name, verdict in verdicts.items() if not verdict.right}
    for name, verdict in verdicts.items():
        said = str(verdict)
        used = sorted(_used_by(name, handed.cells) & wrong)
        hint = note(handed.cells, all_checks()[name], course) if verdict.right else ""
        if used and not verdict.right:
            hint = f"uses {', '.join(f'`{function}`' for function in used)}, which is not right either"
            said = f"{said} It {hint}."
        tree = tree_of(handed.cells, name)
        published = is_published(tree, name, course)
        mark = Mark(handed.path, name, verdict.right, said, hint, "", passed.get(name, 0.0))
        yield mark._replace(published=published, tree=tree)


def _used_by(name: str, cells: Sequence[Cell]) -> set[str]:
    """Return the names that the cells of an exercise use from others."""
    used = {
        word
        for cell in cells
        if name in cell.exercises
        for word in names_of(without_commands(cell.source))[1]
    }
    return used - {name}


def _judge_all(
    cells: list[Cell], names: list[str], task: _Task, student: Sealed
) -> tuple[dict[str, Verdict], dict[str, float]]:
    """Judge exercises in one process, and in a new one after an exercise that ends it.

    All together have the time `BUDGET`, so that no notebook can hold up the marking of a class.

    Returns
    -------
    The verdicts, and the fractions of the inputs on which wrong functions are right, if they earn points.
    """
    judged: dict[str, Verdict] = {}
    passed: dict[str, float] = {}
    end = time.monotonic() + BUDGET
    while remaining := [name for name in names if name not in judged]:
        at_fault = remaining
        try:
            _allow(student, STARTING, end)
            student.renew()
            student.ask("begin", [tuple(cell) for cell in cells])
            for name in remaining:
                at_fault = [name]
                _ = all_checks()[name].answers  # the import is not the student's time
                _allow(student, SECONDS, end)
                judged[name] = _judge(student, name, task.seed)
                if task.partial_points and not judged[name].right:
                    passed[name] = _passed(student, name, task.seed)
        except Ended as ended:
            judged |= {name: Verdict(False, f"{name}: {ended}.") for name in at_fault if name not in judged}
            passed |= dict.fromkeys(at_fault, 0.0)
    return judged, passed


def _allow(student: Sealed, seconds: float, end: float) -> None:
    """Set the deadline of the next step, which is at most the end of the notebook's time.

    Raises
    ------
    Ended : if that is over.
    """
    remaining = end - time.monotonic()
    if remaining <= 0:
        raise Ended(f"not tried, as the notebook has used up its {BUDGET} s")
    student.allow(min(seconds, remaining))


def _judge(student: Sealed, name: str, seed: int) -> Verdict:
    """Judge an exercise by its check of the course, on input drawn from this seed."""
    check = copy.copy(all_checks()[name])
    check.seconds = 2 * SECONDS  # later than the limit of `allow`
    has_cell, error = student.ask("prepare", name)
    if not has_cell:
        return Verdict(False, f"{name}: {MISSING}")
    try:
        with np.errstate(all="ignore"):
            verdict = check.verdict(partial(call, student, name), seed)
    except Exception:  # an answer such as 10**400, which has no float
        verdict = Verdict(False, f"{name}: your answer cannot be compared with the right one.")
    if verdict.right or not error:
        return verdict
    return Verdict(False, f"{name}: {error}")


def _passed(student: Sealed, name: str, seed: int) -> float:
    """Return the fraction of the inputs on which a function is right; 0 if its cells cannot be run."""
    check = copy.copy(all_checks()[name])
    check.seconds = SECONDS
    has_cell, error = student.ask("prepare", name)
    if error or not has_cell:
        return 0.0
    with np.errstate(all="ignore"):
        return check.passed(partial(call, student, name), seed)


def call(student: Sealed, name: str, *arguments: Any) -> Any:  # noqa: ANN401
    """Call a student's function as a check calls it: the call happens in the student's process."""
    result, changes, raised, said = student.ask("call", name, arguments)
    if raised:
        raise NotImplementedError if raised == "NotImplementedError" else type(raised, (Exception,), {})(said)
    for number, changed in changes:
        requests = noted_requests(arguments[number])
        if requests is None:
            np.copyto(arguments[number], unpack(changed))
        else:
            requests[:] = unpack(changed)
    return unpack(result)
