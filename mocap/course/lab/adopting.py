"""A student's function drives the course from the exercise on; until then the package's stands in.

A student's function that passed its check may still fail on other input. So each call is guarded: where the
function raises an error, gives another form of answer than the package's (a NaN, say), or takes longer than
`SECONDS`, one sentence says so, and the package's stands in from then on. What it prints is dropped: a line
for each of some thousand calls would hide the page.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from mocap._shared.limits import Overdue, time_limit
from mocap.course.check import Check, as_numbers
from mocap.course.checks import all_checks, nearest, withheld
from mocap.course.lab.kept_functions import keep, place, plain_source, read_text, run_sections
from mocap.errors import MocapError

SECONDS = 30.0  # of one call; what the course asks for takes a thousandth of it
SHAPES: dict[str, tuple[int, ...]] = {"climb": (3,), "edge_cost": (2,), "hamilton": (4,)}
"""The answers of functions that are called thousands of times; others are compared with the package's."""

NAMES = (
    *("climb", "window_sums", "inner_minima", "best_angle", "best_shift", "undo", "choice_points"),
    *("successors_of", "tarjan", "component_to_keep", "edge_cost", "lengthen", "look_ahead"),
    *("survivors", "product_of", "hamilton", "quintic", "mix", "next_edge"),
)
"""The exercises in the order in which a motion graph needs them."""

Tools = SimpleNamespace  # a function for each of `NAMES`, as `tools.climb`


class Slot:
    """The place of an exercise in the course; call it like the function that the exercise asks for.

    Parameters
    ----------
    check : the exercise's check, whose oracle stands in for a function that is missing.

    Attributes
    ----------
    own : the student's function, once it has passed the check; else None.
    written : what the student wrote last, right or wrong: this is what a check judges.
    kept : whether the file beside the notebooks holds it.
    stopped : why the package's stands in again, or "".

    Examples
    --------
    >>> from mocap.course import checks
    >>> slot = Slot(checks.hamilton)
    >>> slot
    hamilton: the package's
    >>> slot(np.array([0.0, 1, 0, 0]), np.array([0.0, 0, 1, 0]))
    array([0., 0., 0., 1.])
    """

    def __init__(self, check: Check) -> None:
        self.name, self.stand_in, self.check = check.name, check.truth, check
        self.own: Callable[..., Any] | None = None
        self.written: Callable[..., Any] = check.truth
        self.kept, self.stopped, self._prints = False, "", False

    def adopt(self, own: Callable[..., Any] | None, *, kept: bool) -> None:
        """Put a function that has passed its check here, or take it away."""
        self.own, self.stopped, self.kept = own, "", kept

    @property
    def yours(self) -> bool:
        """Whether the student's function runs here."""
        return self.own is not None and not self.stopped

    def __repr__(self) -> str:
        return f"{self.name}: " + ("yours" if self.yours else "the package's")

    def __call__(self, *arguments: Any) -> Any:  # noqa: ANN401 (as the exercise asks)
        """Give the student's answer, or the package's where there is none or it will not do."""
        if self.own is None or self.stopped:
            return self.stand_in(*arguments)
        try:
            with time_limit(SECONDS), redirect_stdout(io.StringIO()) as unseen:
                given = self.own(*arguments)
        except Overdue:
            self.stopped = f"did not end within {SECONDS:g} s"
        except (Exception, SystemExit) as error:  # a student's function may raise anything
            self.stopped = f"raised {type(error).__name__}: {error}".removesuffix(": ")[:110]
        else:
            if unseen.getvalue() and not self._prints:
                self._prints = True
                print(f"{self.name}: yours prints; it is shown where the check runs, and not here.")
            shape = SHAPES.get(self.name)
            try:
                return in_form(given, np.zeros(shape) if shape else self.stand_in(*arguments))
            except (TypeError, ValueError) as error:
                self.stopped = str(error)
        print(f"{self.name}: yours {self.stopped}; the package's stands in from here on.")
        return self.stand_in(*arguments)


def in_form(given: Any, wanted: Any) -> Any:  # noqa: ANN401
    """Give an answer the types of another of the same form, as what follows may need an array or a set.

    Raises
    ------
    ValueError, TypeError : where the form is another one: another shape, or NaN where that has none.

    Examples
    --------
    >>> in_form([[1, 2], (3,)], ({0}, np.zeros(1)))
    ({1, 2}, array([3.]))
    >>> in_form([1.0], (3, 4))
    Traceback (most recent call last):
    ValueError: gave an answer of the shape (1,)
    """
    listed, kind = isinstance(given, list | tuple | np.ndarray), type(wanted)
    here, there = as_numbers(given), as_numbers(wanted)
    if isinstance(wanted, set | frozenset) and (listed or isinstance(given, set | frozenset)):
        return kind(tuple(item) if np.ndim(item) else item for item in given)
    if isinstance(wanted, dict | str) or wanted is None:
        if isinstance(given, kind):
            return given
    elif there is None:  # items of different kinds
        if listed and len(given) == len(wanted):
            return (list if kind is list else tuple)(map(in_form, given, wanted))
    elif here is not None:
        if here.shape == there.shape and not (np.isnan(here) & ~np.isnan(there)).any():
            if isinstance(wanted, list | tuple):
                return (list if kind is list else tuple)(map(in_form, given, wanted))
            return np.asarray(given, wanted.dtype) if kind is np.ndarray else kind(given)
        raise ValueError("gave NaN" if np.isnan(here).any() else f"gave an answer of the shape {here.shape}")
    raise ValueError(f"gave an answer of the type {type(given).__name__} that does not fit")


def mine(what: str | Callable[..., Any] | Slot) -> Slot:
    """Put a student's function in its place, or give what stands there: theirs, or the package's.

    A function that passes its check is adopted: it is written into `my_graph.py` beside the notebook, and
    from then on it is what all notebooks get by its name. One that does not pass leaves its place as it was.
    Whose code stands there is printed. The environment variable MOCAP_MINE names another file; where it is
    empty, nothing is read or written.

    Parameters
    ----------
    what : the function that an exercise asks for, or its name.

    Returns
    -------
    The place; call it like the function. While a notebook is marked, the student's function as it is.

    Raises
    ------
    MocapError : for a name that no exercise has.

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
        return cast(Slot, _while_marked(what))
    if isinstance(what, Slot):
        what = what.written if what.written is not what.stand_in else what.name
    slot = slots(what if isinstance(what, str) else what.__name__)[0]
    failed = callable(what) and not _take(slot, what)
    if slot.yours:
        kept = f", kept in {place()}" if slot.kept else ""
        print(f"{slot.name}: yours{kept}{'; it is the one that passed, not this one' if failed else ''}.")
    else:
        why = f"; yours {slot.stopped}." if slot.stopped else " until yours passes its check."
        print(f"{slot.name}: the package's stands in{why}")
    return slot


def _while_marked(what: Any) -> Any:  # noqa: ANN401
    """Return a student's function as it is; for a name, one that is not written yet: no answer stands in."""
    return (lambda *_: ...) if isinstance(what, str) else what


def slots(*names: str) -> list[Slot]:
    """Give the places of some exercises, with what the file beside the notebook holds, and print nothing new.

    Raises
    ------
    MocapError : for a name that no exercise has.
    """
    if unknown := [name for name in names if name not in all_checks()]:
        raise MocapError(f"The course has no exercise '{unknown[0][:40]}'; {nearest(unknown[0])}.")
    _refresh()
    return [_slots()[name] for name in names]


def tools() -> Tools:
    """Take the student's functions, where they passed their checks, and the package's for the rest.

    Notebook: 07-walks-and-search
    """
    return Tools(**{slot.name: slot for slot in slots(*NAMES)})


def whose(*names: str) -> str:
    """Say whose functions run in some places, as a line for a caption.

    Examples
    --------
    >>> whose("hamilton", "climb")
    "hamilton, climb: the package's"

    Notebook: 00-quickstart
    """
    found = slots(*names)
    groups = {"yours": [slot.name for slot in found if slot.yours]}
    groups["the package's"] = [slot.name for slot in found if not slot.yours]
    return " · ".join(f"{', '.join(some)}: {of}" for of, some in groups.items() if some)


def _take(slot: Slot, written: Callable[..., Any]) -> bool:
    """Adopt a function if it is right, and write it into the file; say whether it is right."""
    slot.written = written
    if not slot.check.verdict(written).right:
        return False
    slot.adopt(written, kept=False)
    try:
        if file := place():
            plain = plain_source(written, all_checks())  # type: ignore[arg-type]
            _read[0] = keep(file, slot.name, slot.check.notebook, plain)
            slot.kept = True
    except MocapError as error:
        print(f"{slot.name}: adopted until this kernel ends, but not kept. {error}"[:200])
    return True


_read = [""]  # what the file held when it was read last


def _refresh() -> None:
    """Read the file anew if it has changed: what was deleted from it goes, what passes its check comes."""
    file, text = place(), ""
    try:
        text = read_text(file)
    except MocapError as error:
        print(error)
    if text == _read[0]:
        return
    _read[0] = text
    found, said = run_sections(file, text, _slots()) if file else ({}, [])
    for slot in _slots().values():
        if slot.kept and slot.name not in found:
            slot.adopt(None, kept=False)
    for name in found.keys() - all_checks().keys():
        said.append(f"{file}: the course has no exercise '{name}'; it is not used."[:200])
    for slot in (_slots()[name] for name in found if name in all_checks()):
        slot.written = found[slot.name]
        with redirect_stdout(io.StringIO()):
            verdict = slot.check.verdict(slot.written)
        slot.adopt(slot.written if verdict.right else None, kept=verdict.right)
        if not verdict.right:
            why = "does not pass its check any more, so the package's stands in."
            said.append(f"{file}: {slot.name} {why}\n{verdict}")
    print(*said, sep="\n", end="\n" * bool(said))


@cache
def _slots() -> dict[str, Slot]:
    return {name: Slot(check) for name, check in all_checks().items()}
