"""A student's function drives the course from the exercise on; until then the package's stands in."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from mocap.course.checks import all_checks, nearest, withheld
from mocap.course.copies import progress as read_progress
from mocap.course.guarded_calls import read_report, write_report_to
from mocap.course.lab import program
from mocap.course.lab.kept_functions import is_stub, keep, place, plain_source, read_text, run_sections
from mocap.course.lab.slots import FAILING, PACKAGE, YOURS, AsWritten, Slot, whose_run
from mocap.errors import MocapError

NAMES = (
    *("climb", "window_sums", "inner_minima", "best_angle", "best_shift", "undo", "choice_points"),
    *("successors_of", "tarjan", "component_to_keep", "edge_cost", "lengthen", "look_ahead"),
    *("survivors", "product_of", "hamilton", "quintic", "mix", "next_edge"),
)
"""The exercises in the order in which a motion graph needs them."""

Tools = SimpleNamespace  # a function for each of `NAMES`, as `tools.climb`


def mine(exercise: str | Callable[..., Any] | Slot) -> Slot:
    """Put a student's function in its place, or return what stands there: theirs, or the package's.

    A function that passes its check is adopted: it is written into `my_graph.py` beside the notebook, and
    from then on it is what all notebooks get by its name. One that does not pass leaves its place as it was.
    Whose code stands there is printed. The environment variable MOCAP_MINE names another file; where it is
    empty, nothing is read or written.

    Parameters
    ----------
    exercise : the function that an exercise asks for, or its name.

    Returns
    -------
    The place; call it like the function. While a notebook is marked, the student's function as it is.

    Raises
    ------
    MocapError
        For a name that no exercise has.

    Examples
    --------
    >>> def hamilton(a, b):
    ...     return ...
    >>> hamilton = mine(hamilton)
    hamilton: the package's stands in until yours passes its check.
    >>> hamilton([0, 1, 0, 0], [0, 0, 1, 0]).tolist()
    [0.0, 0.0, 0.0, 1.0]

    Notebook: 08-path-synthesis
    """
    if withheld():
        return cast(Slot, _while_marked(exercise))
    if isinstance(exercise, Slot):
        has_own = exercise.written is not exercise.stand_in
        exercise = exercise.written if has_own else exercise.name
    if isinstance(exercise, str):
        slot = slots(exercise)[0]
        has_failed = False
    else:
        slot = slots(exercise.__name__)[0]
        has_failed = not _take(slot, exercise)
    print(_standing(slot, has_failed))
    return slot


def _while_marked(exercise: Any) -> Any:  # noqa: ANN401
    """Return a student's function as it is; for a name, one that is not written yet: no answer stands in."""
    return (lambda *_: ...) if isinstance(exercise, str) else exercise


def _standing(slot: Slot, has_failed: bool) -> str:
    """State whose function stands in a place, after another one failed or not."""
    if slot.yours:
        kept = f", kept in {place()}" if slot.kept else ""
        earlier = "; it is the one that passed, not this one" if has_failed else ""
        return f"{slot.name}: yours{kept}{earlier}."
    reason = f"; yours {slot.stopped}." if slot.stopped else " until yours passes its check."
    return f"{slot.name}: the package's stands in{reason}"


def slots(*names: str) -> list[Slot]:
    """Return the places of some exercises, with what the file beside the notebook holds; print what is new.

    Raises
    ------
    MocapError
        For a name that no exercise has.
    """
    unknown = [name for name in names if name not in all_checks()]
    if unknown:
        raise MocapError(f"The course has no exercise '{unknown[0][:40]}'; {nearest(unknown[0])}.")
    _refresh()
    return [_slots()[name] for name in names]


def tools() -> Tools:
    """Return the student's functions, where they passed their checks, and the package's for the rest.

    Notebook: 05-motion-graph
    """
    return Tools(**{slot.name: slot for slot in slots(*NAMES)})


def as_written() -> Tools:
    """Return the student's functions as they stand, right or wrong, and the package's for the rest.

    Notebook: 07-walks-and-search
    """
    _refresh("so that it runs as you wrote it")
    chosen = {}
    for slot in slots(*NAMES):
        is_begun = slot.written is not slot.stand_in and not is_stub(slot.written)
        chosen[slot.name] = AsWritten(slot) if is_begun else slot
    return Tools(**chosen)


def compare(draw: Callable[[Tools], Any], *names: str) -> dict[str, Any]:
    """Make a picture or a motion by the student's functions as they stand, beside that of the package's.

    Parameters
    ----------
    draw : makes something of the functions, which are attributes of its argument. If it fails with functions
        that do not pass their checks, which is printed, theirs is left out.
    names : the exercises whose functions it calls.

    Returns
    -------
    What `draw` made, by whose functions ran. If a function does not pass, the first is "yours, which does not
    pass" and the last "the package's". Otherwise there is one alone.

    Examples
    --------
    >>> compare(lambda by: "a picture", "local_fit")
    {"the package's": 'a picture'}

    Notebooks: 00-quickstart to 07-walks-and-search
    """
    places = slots(*names)
    begun = [slot for slot in places if slot.written is not slot.stand_in and not is_stub(slot.written)]
    results: dict[str, Any] = {}
    failing = [slot.name for slot in begun if slot.adopted is not slot.written]
    if failing:
        theirs = {slot.name: AsWritten(slot) if slot in begun else slot for slot in places}
        try:
            results[FAILING] = draw(Tools(**theirs))
        except Exception as error:  # whatever functions that do not pass lead to
            problem = f"{type(error).__name__}: {error}"
            print(f"As you wrote {', '.join(failing)}, this fails. {problem}"[:200])
        results[PACKAGE] = draw(Tools(**{slot.name: slot.stand_in for slot in places}))
    else:
        label = YOURS if all(slot.yours for slot in places) else PACKAGE
        results[label] = draw(Tools(**{slot.name: slot for slot in places}))
    return results


def progress() -> None:
    """Print how many exercises of each notebook of the way are solved, and which is next.

    Notebook: 00-quickstart
    """
    print(read_progress(place()))


def whose(*names: str) -> str:
    """State whose functions run in some places, as a line for a caption.

    Examples
    --------
    >>> whose("hamilton", "climb")
    "hamilton, climb: the package's"

    Notebook: 05-motion-graph
    """
    return whose_run(slots(*names))


def _take(slot: Slot, function: Callable[..., Any]) -> bool:
    """Adopt a function if it is right, and write it into the file; return whether it is right."""
    slot.written = function
    if not slot.check.verdict(function).right:
        return False
    slot.adopt(function, kept=False)
    try:
        file = place()
        if file:
            source = plain_source(function, all_checks())  # type: ignore[arg-type]
            _kernel.text = keep(file, slot.name, slot.check.notebook, source, program.text())
            slot.kept = True
    except MocapError as error:
        print(f"{slot.name}: adopted until this kernel ends, but not kept. {error}"[:200])
    return True


@dataclass
class _Kernel:
    """The code that this kernel has read from the files beside the notebook."""

    text: str = ""  # of the file with the student's functions
    report: Path | None = None  # the file that tells at which function a kernel was ended
    ended: tuple[str, ...] = ()  # the functions that ran when the last kernel was ended


_kernel = _Kernel()


def _refresh(consequence: str = "so the package's stands in") -> None:
    """Read the file anew if it has changed: what was deleted from it goes, what passes its check comes.

    Parameters
    ----------
    consequence : what follows for a function that does not pass its check, as the end of a sentence.
    """
    file = place()
    text = ""
    try:
        text = read_text(file)
    except MocapError as error:
        print(error)
    if file is not None and _kernel.report is None:
        _tell_of_last_kernel(file)
    if text == _kernel.text:
        return
    _kernel.text = text
    for message in _read_functions(file, text, consequence):
        print(message)


def _read_functions(file: Path | None, text: str, consequence: str) -> list[str]:
    """Put the functions of the file into their places; return a message for each that is not used."""
    functions, messages = run_sections(file, text, _slots()) if file else ({}, [])
    for slot in _slots().values():
        if slot.kept and slot.name not in functions:
            slot.adopt(None, kept=False)
    for name, function in functions.items():
        if name not in all_checks():
            messages.append(f"{file}: the course has no exercise '{name}'; it is not used."[:200])
        elif name not in _kernel.ended:
            messages += _read_function(_slots()[name], function, f"{file}: {name}", consequence)
    return messages


def _read_function(
    slot: Slot, function: Callable[..., Any], place_in_file: str, consequence: str
) -> list[str]:
    """Adopt a function of the file if it passes its check; return a message if it does not."""
    slot.written = function
    with redirect_stdout(io.StringIO()):
        verdict = slot.check.verdict(function)
    slot.adopt(function if verdict.right else None, kept=verdict.right)
    if verdict.right:
        return []
    return [f"{place_in_file} does not pass its check any more, {consequence}.\n{verdict}"]


def _tell_of_last_kernel(file: Path) -> None:
    """Print which function ended the last kernel, and leave it out until it is handed in again.

    Parameters
    ----------
    file : that of the student's functions. A report that is older than it is about an earlier version.
    """
    report = file.with_name(f".{file.stem}.stopped")
    _kernel.report = report
    stopped = read_report(report)
    if stopped and file.exists() and report.stat().st_mtime < file.stat().st_mtime:
        stopped = None
    if stopped:
        _kernel.ended = stopped.functions
        line = f"line {stopped.line} of `{stopped.function}`" if stopped.function else "a function"
        print(
            f"The last kernel was ended: {line} ran compiled code without an end. Change it and run it again."
        )
    write_report_to(report, anew=stopped is None)


@cache
def _slots() -> dict[str, Slot]:
    return {name: Slot(check) for name, check in all_checks().items()}
