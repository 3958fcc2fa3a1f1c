"""The place of an exercise in the course, and the guard around what a student put there.

A student's function that passed its check may still fail on other input. So each call is guarded: where the
function raises an error, gives another form of answer than the package's (a NaN, say), or takes longer than
`SECONDS`, one sentence says so, and the package's stands in from then on. What it prints is dropped: a line
for each of some thousand calls would hide the page.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stdout
from typing import Any

import numpy as np

from mocap._shared.limits import Overdue, time_limit
from mocap.course.check import Check

SECONDS = 30.0  # of one call; what the course asks for takes a thousandth of it
SHAPES: dict[str, tuple[int, ...]] = {"climb": (3,), "edge_cost": (2,), "hamilton": (4,)}
"""The answers of functions that are called thousands of times; others are compared with the package's."""


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
        self.name, self.stand_in = check.name, check.truth
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
        return self._guarded(arguments) if self.yours else self.stand_in(*arguments)

    def _guarded(self, arguments: tuple[Any, ...]) -> Any:  # noqa: ANN401
        try:
            with time_limit(SECONDS), redirect_stdout(io.StringIO()) as unseen:
                given = self.own(*arguments)  # type: ignore[misc] # `yours` says that there is one
        except Overdue:
            return self._give_up(f"did not end within {SECONDS:g} s", arguments)
        except (Exception, SystemExit) as error:  # a student's function may raise anything
            said = f": {error}" if str(error) else ""
            return self._give_up(f"raised {type(error).__name__}{said}"[:110], arguments)
        if unseen.getvalue() and not self._prints:
            self._prints = True
            print(f"{self.name}: yours prints; it is shown where the check runs, and not here.")
        shape = SHAPES.get(self.name)
        wanted = np.zeros(shape) if shape else self.stand_in(*arguments)
        try:
            return in_form(given, wanted)
        except (TypeError, ValueError) as error:
            return self._give_up(str(error), arguments)

    def _give_up(self, why: str, arguments: tuple[Any, ...]) -> Any:  # noqa: ANN401
        self.stopped = why
        print(f"{self.name}: yours {why}; the package's stands in from here on.")
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
    here, there = _numbers(given), _numbers(wanted)
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


def _numbers(value: Any) -> Any:  # noqa: ANN401
    """Give a value as an array of numbers; None where it is something else."""
    try:
        return np.asarray(value, complex)
    except (TypeError, ValueError):
        return None
