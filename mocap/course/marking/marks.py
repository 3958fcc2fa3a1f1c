"""Marks for the notebooks in a folder, exercise by exercise."""

from __future__ import annotations

import copy
import hashlib
import multiprocessing
import signal
import stat
import sys
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
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
from mocap.course.marking.cells import Cell, Sheet, code_cells, course_sheets, named_oracle, sheet_of
from mocap.course.marking.grades import Mark, sent_by
from mocap.course.marking.plain_data import unpack
from mocap.course.marking.sealed import Ended, Sealed, protection
from mocap.course.marking.walls import require_sealing
from mocap.course.notebooks import library
from mocap.course.opening import stored
from mocap.errors import MocapError

SECONDS = 30  # time limit of an exercise
STARTING = 120  # time limit of the first cell, which imports much
LARGEST = 100 << 20  # bytes of a notebook's file
MOST_PARTS = 2_000_000  # lists, dictionaries and texts in it
MOST_CODE = 1 << 20  # letters of code in it
MISSING = "its cell is missing."
CHANGES_PACKAGE = "✗ changes the installed package."
_students: list[Sealed] = []  # the single one by which this process marks notebook after notebook


class _Handed(NamedTuple):
    """A notebook that was handed in: its path, its cells, the course's, and what is wrong with it."""

    path: str
    cells: list[Cell]
    sheet: Sheet = ((), frozenset())
    wrong: str = ""


def mark(
    folder: Path, progress: Progress = iter, tell: Callable[[str], object] = str, jobs: int = 1
) -> Iterator[list[Mark]]:
    """Mark the exercises of all notebooks in a folder and in the folders inside it.

    All notebooks are read before the first one runs. Each runs in a process of its own, with a new folder as
    its home, few variables in its environment, limits of time, memory, processes and files, and the `walls`
    that this system can raise; what it prints is thrown away. At the end all that it started is killed. The
    first cell runs, then each exercise with the cells that define what it uses. The checks run here, on
    random input of their own. Nothing keeps a notebook from calling the package's own functions, where the
    answers to many exercises are: the mark of one that names them says so.

    Parameters
    ----------
    folder : the notebooks handed in; the folder in it that holds a notebook says whose it is, or the name of
        the file, as Canvas gives it.
    progress : wraps the notebooks while they are marked.
    tell : gets a sentence that says what walls there are, before the first notebook runs.
    jobs : how many notebooks are marked at a time; one, where no wall keeps them apart.

    Yields
    ------
    The marks of each notebook, one for each exercise: also for those that a notebook of the course has and a
    copy lacks; then a mark for each exercise that others handed in and a student did not.

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
    files = [file for file in sorted(folder.rglob("*.ipynb")) if ".ipynb_checkpoints" not in file.parts]
    if not files:
        raise MocapError(f"The folder {folder} holds no notebooks.")
    sheets = course_sheets(stored())
    marked: list[Mark] = []
    handed_in = [_read(file, file.relative_to(folder).as_posix(), sheets) for file in files]
    seed = int(np.random.default_rng().integers(2**32))
    hidden = [stored(), *{folder / notebook.path.split("/")[0] for notebook in handed_in}]
    with closing(Sealed(hidden)) as student:
        tell(protection(student.walls))
        fingerprint = _fingerprint(student.walls)
        _students[:] = [student]
        work = (_marks(notebook, seed) for notebook in handed_in)
        if jobs > 1 and not fingerprint:
            work = _in_parallel(handed_in, seed, hidden, jobs)
        with closing(work):
            for notebook, marks in zip(progress(handed_in), work, strict=False):
                if _fingerprint(student.walls) != fingerprint:
                    yield [mark._replace(right=False, said=CHANGES_PACKAGE) for mark in marks]
                    changer = f"{notebook.path} has changed the package"
                    raise MocapError(f"{changer}: install it anew, use a container.")
                yield marks
                marked += marks
    yield from _missing(handed_in, marked)


def _missing(handed_in: list[_Handed], marked: list[Mark]) -> Iterator[list[Mark]]:
    """Mark as wrong the exercises that others handed in and a student did not."""
    exercises = [name for name in all_checks() if any(mark.exercise == name for mark in marked)]
    places = {sent_by(notebook.path): notebook.path.split("/")[0] for notebook in handed_in}
    for student, place in places.items():
        submitted = {mark.exercise for mark in marked if sent_by(mark.handed_in) == student}
        names = [name for name in exercises if name not in submitted]
        _, number = student
        is_folder = place == student[0]
        if number or is_folder:  # a file without a folder names no student
            yield [Mark(f"{place}/", name, False, f"✗ {name}: not handed in.") for name in names]


def _in_parallel(
    handed_in: list[_Handed], seed: int, hidden: Sequence[Path], jobs: int
) -> Generator[list[Mark]]:
    """Mark several notebooks at a time; at the end, also an early one, no process is left."""
    fork = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(jobs, fork, _begin, (hidden,)) as pool:
        try:
            yield from pool.map(_marks, handed_in, repeat(seed))
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


def _fingerprint(walls: Iterable[str]) -> bytes:
    """Compute a hash of the package's files if no wall keeps a notebook from changing them."""
    if "landlock" in walls:
        return b""
    sys.dont_write_bytecode = True
    files = sorted(file for file in Path(mocap.__file__).parent.rglob("*") if file.is_file())
    return hashlib.sha256(b"".join(bytes(file) + file.read_bytes() for file in files)).digest()


def _read(file: Path, path: str, sheets: Sequence[Sheet]) -> _Handed:
    """Read a notebook that was handed in; an error becomes its field `wrong`."""
    try:
        status = file.lstat()
        if not stat.S_ISREG(status.st_mode) or status.st_size > LARGEST:
            raise MocapError(f"is no plain file, or one of more than {LARGEST >> 20} MB.")
        text = file.read_bytes().decode("utf-8-sig", "replace")
        if sum(map(text.count, '[{"')) > MOST_PARTS:  # they would take a hundred times their place in memory
            raise MocapError("holds too much.")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of cells without ids, as some editors write them
            notebook = library().reads(text, as_version=4)
        cells = code_cells(notebook)
        if sum(len(cell.source) for cell in cells) > MOST_CODE:
            raise MocapError(f"holds more than {MOST_CODE >> 20} MB of code.")
        return _Handed(path, cells, sheet_of(notebook, sheets))
    except MocapError as error:
        wrong = f"{path}: {error}"
    except Exception:  # nbformat raises errors of many kinds, and lets some things pass that are no notebooks
        wrong = f"{path}: is not a notebook."
    return _Handed(path, [], wrong=wrong)


def _marks(handed: _Handed, seed: int) -> list[Mark]:
    """Mark a notebook; an error costs this notebook only."""
    try:
        return list(_marks_of(handed, seed, _students[0]))
    except Exception as error:
        return [Mark(handed.path, "", False, f"cannot be marked: {type(error).__name__}.")]


def _marks_of(handed: _Handed, seed: int, student: Sealed) -> Iterator[Mark]:
    """Mark the exercises of the course's notebook, and those of others of which it has cells."""
    exercises, course = handed.sheet
    tags = [name for cell in handed.cells for name in cell.exercises]
    names = list(dict.fromkeys([*exercises, *tags]))
    strange = [name for name in names if name not in all_checks()]
    note = f" The course does not know the tag `{strange[0]}`." if strange else ""
    names = [name for name in names if name not in strange]
    if not names:
        yield Mark(handed.path, "", False, handed.wrong or f"holds no exercise of the course.{note}")
    for name, verdict in _judge_all(handed.cells, names, seed, student).items():
        said = str(verdict).replace(MISSING, MISSING + note)
        right = verdict.right
        oracle = named_oracle(handed.cells, all_checks()[name], course) if right else ""
        if oracle:
            right = oracle in all_checks()[name].oracles  # the package's own function may be called, perhaps
            sign = "✓" if right else "✗"
            said = f"{sign}{said[1:]} Look at its cells: they name `{oracle}`, which knows it."
        yield Mark(handed.path, name, right, said)


def _judge_all(cells: list[Cell], names: list[str], seed: int, student: Sealed) -> dict[str, Verdict]:
    """Judge exercises in one process, and in a new one after an exercise that ends it."""
    judged: dict[str, Verdict] = {}
    while remaining := [name for name in names if name not in judged]:
        student.renew()
        at_fault = remaining
        try:
            student.allow(STARTING)
            student.ask("begin", [tuple(cell) for cell in cells])
            for name in remaining:
                at_fault = [name]
                _ = all_checks()[name].answers  # the import is not the student's time
                student.allow(SECONDS)
                judged[name] = _judge(student, name, seed)
        except Ended as ended:
            judged |= {name: Verdict(False, f"{name}: {ended}.") for name in at_fault}
    return judged


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
    return Verdict(False, f"{name}: its cells raise {error}")


def call(student: Sealed, name: str, *arguments: Any) -> Any:  # noqa: ANN401
    """Call a student's function as a check calls it: the call happens in the student's process."""
    result, changes, raised, said = student.ask("call", name, arguments)
    if raised:
        raise NotImplementedError if raised == "NotImplementedError" else type(raised, (Exception,), {})(said)
    for number, changed in changes:
        np.copyto(arguments[number], unpack(changed))
    return unpack(result)
