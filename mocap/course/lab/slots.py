"""The place of an exercise in the course, in which a student's function runs, or the package's in its stead.

A student's function that passed its check may still fail on other input. So each call is guarded: where the
function raises an error, gives another form of answer than the package's (a NaN, say), or takes longer than
`SECONDS`, one sentence says so, and the package's stands in from then on. What it prints is dropped: a line
for each of some thousand calls would hide the page.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from typing import Any

import numpy as np

from mocap._shared.limits import Overdue
from mocap.course.check import Check
from mocap.course.comparisons import as_numbers
from mocap.course.guarded_calls import guarded

SECONDS = 6.0  # of one call; what the course asks for takes a thousandth of it
SHAPES: dict[str, tuple[int, ...]] = {"climb": (3,), "edge_cost": (2,), "hamilton": (4,)}
"""The answers of functions that are called thousands of times; others are compared with the package's."""
YOURS = "yours"
FAILING = "yours, which does not pass"
PACKAGE = "the package's"


class Slot:
    """The place of an exercise in the course; call it like the function that the exercise asks for.

    Parameters
    ----------
    check : the exercise's check, whose oracle stands in for a function that is missing.

    Attributes
    ----------
    adopted : the student's function, once it has passed the check; else None.
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
        self.check = check
        self.name = check.name
        self.stand_in = check.truth
        self.adopted: Callable[..., Any] | None = None
        self.written: Callable[..., Any] = check.truth
        self.kept = False
        self.stopped = ""
        self._has_printed = False

    def adopt(self, function: Callable[..., Any] | None, *, kept: bool) -> None:
        """Put a function that has passed its check here, or take it away."""
        self.adopted = function
        self.kept = kept
        self.stopped = ""

    @property
    def yours(self) -> bool:
        """Whether the student's function runs here."""
        return self.adopted is not None and not self.stopped

    @property
    def runs(self) -> str:
        """Whose function runs here, in words."""
        return YOURS if self.yours else PACKAGE

    def __repr__(self) -> str:
        return f"{self.name}: {self.runs}"

    def __call__(self, *arguments: Any) -> Any:  # noqa: ANN401 (as the exercise asks)
        """Return the student's answer, or the package's where there is none or it will not do."""
        if self.adopted is None or self.stopped:
            return self.stand_in(*arguments)
        try:
            with guarded(SECONDS, quick=True), redirect_stdout(io.StringIO()) as unseen:
                answer = self.adopted(*arguments)
        except Overdue:
            self.stopped = f"did not end within {SECONDS:g} s"
        except (Exception, SystemExit) as error:  # a student's function may raise anything
            self.stopped = f"raised {type(error).__name__}: {error}".removesuffix(": ")[:110]
        else:
            self._note_prints(unseen.getvalue())
            try:
                return self._converted(answer, arguments)
            except (TypeError, ValueError) as error:
                self.stopped = str(error)
        print(f"{self.name}: yours {self.stopped}; the package's stands in from here on.")
        return self.stand_in(*arguments)

    def _note_prints(self, text: str) -> None:
        """Say once that what the function prints is dropped."""
        if text and not self._has_printed:
            self._has_printed = True
            print(f"{self.name}: yours prints; it is shown where the check runs, and not here.")

    def _converted(self, answer: Any, arguments: tuple[Any, ...]) -> Any:  # noqa: ANN401
        """Return an answer in the types of the package's; raise for one of another form."""
        shape = SHAPES.get(self.name)
        return in_form(answer, np.zeros(shape) if shape else self.stand_in(*arguments))


class AsWritten(Slot):
    """The place of an exercise in which the student's function runs as it stands, right or wrong.

    An answer may be longer or shorter than the package's. Where the function raises, does not end, or gives
    nothing that a program could go on with, the package's stands in, which a sentence says.

    Parameters
    ----------
    slot : the place in the course.

    Examples
    --------
    >>> from mocap.course import checks
    >>> slot = Slot(checks.hamilton)
    >>> slot.written = lambda a, b: b
    >>> hamilton = AsWritten(slot)
    >>> hamilton
    hamilton: yours, which does not pass
    >>> hamilton([0, 1, 0, 0], [0, 0, 1, 0])
    array([0., 0., 1., 0.])
    """

    def __init__(self, slot: Slot) -> None:
        super().__init__(slot.check)
        self.passes = slot.adopted is slot.written
        self.adopt(slot.written, kept=slot.kept)

    @property
    def runs(self) -> str:
        """Whose function runs here, and whether it passes its check."""
        return FAILING if self.yours and not self.passes else super().runs

    def _converted(self, answer: Any, arguments: tuple[Any, ...]) -> Any:  # noqa: ANN401
        try:
            return super()._converted(answer, arguments)
        except (TypeError, ValueError):
            if self.name in SHAPES or not isinstance(answer, list | tuple | set | dict | np.ndarray):
                raise
            return answer


def whose_run(places: Iterable[Slot]) -> str:
    """State whose functions run in some places, grouped by whose: the student's first."""
    groups: dict[str, list[str]] = {YOURS: [], FAILING: [], PACKAGE: []}
    for slot in places:
        groups[slot.runs].append(slot.name)
    return " · ".join(f"{', '.join(names)}: {runs}" for runs, names in groups.items() if names)


def in_form(answer: Any, model: Any) -> Any:  # noqa: ANN401
    """Convert an answer to the types of another of the same form, as what follows may need an array or a set.

    Parameters
    ----------
    answer : the student's.
    model : the package's.

    Raises
    ------
    ValueError, TypeError
        If the form is another one: another shape, or NaN where the model has none.

    Examples
    --------
    >>> in_form([[1, 2], (3,)], ({0}, np.zeros(1)))
    ({1, 2}, array([3.]))
    >>> in_form([1.0], (3, 4))
    Traceback (most recent call last):
    ValueError: gave an answer of the shape (1,)
    """
    if isinstance(model, set | frozenset):
        return _as_set(answer, type(model))
    if isinstance(model, dict | str) or model is None:
        if isinstance(answer, type(model)):
            return answer
        raise _other_type(answer)
    model_numbers = as_numbers(model)
    if model_numbers is None:
        return _item_by_item(answer, model)
    return _as_numbers(answer, model, model_numbers)


def _as_set(answer: Any, kind: type) -> Any:  # noqa: ANN401
    """Convert a list or a set of items, of which pairs may be lists, to a set."""
    if not isinstance(answer, list | tuple | np.ndarray | set | frozenset):
        raise _other_type(answer)
    return kind(tuple(item) if np.ndim(item) else item for item in answer)


def _item_by_item(answer: Any, model: Any) -> Any:  # noqa: ANN401
    """Convert the items of a list of different kinds."""
    if not isinstance(answer, list | tuple | np.ndarray) or len(answer) != len(model):
        raise _other_type(answer)
    kind = list if isinstance(model, list) else tuple
    return kind(map(in_form, answer, model))


def _as_numbers(answer: Any, model: Any, model_numbers: Any) -> Any:  # noqa: ANN401
    """Convert numbers to an array, a list or a number of the type of the model's."""
    numbers = as_numbers(answer)
    if numbers is None:
        raise _other_type(answer)
    if numbers.shape != model_numbers.shape or (np.isnan(numbers) & ~np.isnan(model_numbers)).any():
        has_nan = np.isnan(numbers).any()
        raise ValueError("gave NaN" if has_nan else f"gave an answer of the shape {numbers.shape}")
    if isinstance(model, list | tuple):
        return _item_by_item(answer, model)
    if isinstance(model, np.ndarray):
        return np.asarray(answer, model.dtype)
    return type(model)(answer)


def _other_type(answer: Any) -> ValueError:  # noqa: ANN401
    """Return the error for an answer that cannot be converted."""
    return ValueError(f"gave an answer of the type {type(answer).__name__} that does not fit")
