"""Mistakes that can be made in any exercise: the right values in another form, order, unit or sign.

A check looks here when an answer fits none of the mistakes of its own exercise. Each kind of mistake compares
the student's answers with the right ones; it is named only if it explains all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from mocap._shared import records

IsSame = Callable[[Any, Any], bool]
Maker = Callable[[Any], Any]

COMPLEX = (
    "your answer is complex; it must be real. Of a point z + ix, `.imag` is x and `.real` is z; "
    "np.angle gives an angle."
)
REPEATED = "the right values, but some of them more than once."
PLACES = "these are the values at the right places; return the places, that is, their indices."
MASK = "that is a mask; return indices: np.argwhere and np.flatnonzero list where it is True."
INDICES = "those are indices; return a mask: an array that is True at these indices and False elsewhere."
ANOTHER_ORDER = "the right values, but in the wrong order."
PARTS = "your answer has {count} parts; it should have {wanted}."
ONE_PART = "that is part {number} of {count} alone; return all {count} parts, as a tuple."
QUATERNION = 4  # numbers of a quaternion
SWAPPED = "these are the right parts, in reverse order."


def _flat(answer: Any) -> Any:  # noqa: ANN401
    """Join the items of a nested answer; raise for one that is flat already."""
    if np.ndim(answer[0]) + np.ndim(answer[-1]) == 0:
        raise ValueError("flat already")
    return np.concatenate([np.ravel(item) for item in answer])


def _single_item(answer: Any) -> Any:  # noqa: ANN401
    """Return the only item of a list."""
    (item,) = answer
    return item


def _moved(answer: Any, step: int) -> Any:  # noqa: ANN401
    """Add a step to integers, also to those of pairs."""
    numbers = np.array(sorted(answer) if isinstance(answer, set) else answer)
    if not np.issubdtype(numbers.dtype, np.integer):
        raise TypeError("not integers")
    return numbers + step


# reads: statement: a table of sentences, each with the function that it explains
FROM_ANSWER: dict[str, Maker] = {
    "the answer is right, but inside another list: return it without the outer brackets.": _single_item,
    "the right numbers, but nested: join them into one flat array, as np.append does.": _flat,
    "the right values in reverse order.": lambda a: a[::-1],
    "the right values, but transposed: rows and columns are interchanged.": np.transpose,
    "that is in degrees; use radians.": np.radians,
    "that is in percent: divide by 100.": lambda a: np.divide(a, 100),
    "the sign is wrong: that is minus the right answer.": np.negative,
    "these are the squares of the right values: take the square root.": np.sqrt,
    "these are the square roots of the right values.": np.square,
    "that is one minus the right answer.": lambda a: np.subtract(1, a),
    "that is the reciprocal of the right answer.": lambda a: np.divide(1, a),
    "each number is one too small.": lambda a: _moved(a, 1),
    "each number is one too large.": lambda a: _moved(a, -1),
    "these are the single terms; return their sum.": lambda a: np.sum(a, axis=0),
    "these are the parts of the answer; add them all up.": np.sum,
    "these are single values; return their mean.": lambda a: np.mean(a, axis=0),
    "these are all steps on the way; return the last one.": lambda a: a[-1],
    "the first item should not be there.": lambda a: a[1:],
    "the last item should not be there.": lambda a: a[:-1],
    "the first and the last item should not be there.": lambda a: a[1:-1],
    "that is the opposite mask: True and False are interchanged.": np.logical_not,
    "these are several answers, the right one first; return that one alone.": lambda a: a[0],
}
"""What turns a wrong answer into the right one, by what is said then."""

# reads: statement: a table of sentences, each with the function that it explains
FROM_WANTED: dict[str, Maker] = {
    "that is the sum of the right values; return the values themselves.": np.sum,
    "that is the mean of the right values; return the values themselves.": np.mean,
    "that is how many there are; return the items themselves.": len,
    "that is the first of the right values; return all of them.": lambda w: w[0],
    "that is the last of the right values; return all of them.": lambda w: w[-1],
    "these are running sums of the right values: np.cumsum is too much here.": lambda w: np.cumsum(w, axis=0),
    "the first item is missing.": lambda w: w[1:],
    "the last item is missing.": lambda w: w[:-1],
    "the first and the last item are missing.": lambda w: w[1:-1],
    "these are the right values, put in order of size; keep their own order.": np.sort,
}
"""What turns the right answer into a wrong one, by what is said then."""


class Attempt(records.NamedTuple):
    """One call of a student's function.

    Attributes
    ----------
    arguments : those of the call.
    wanted : the right answer.
    answer : the student's.
    """

    arguments: tuple[Any, ...]
    wanted: Any
    answer: Any


def name_mistake(attempts: list[Attempt], is_same: IsSame) -> str:
    """Name the kind of mistake that explains all answers of a student, or return "".

    Parameters
    ----------
    attempts : the calls, at least one with a wrong answer.
    is_same : compares an answer with the right one.

    Examples
    --------
    >>> from mocap.course.comparisons import close
    >>> name_mistake([Attempt((), np.array([1.0, 2.0]), (1.0, [2.0]))], close)
    'the right numbers, but nested: join them into one flat array, as np.append does.'
    >>> name_mistake([Attempt((), 3.0, 4.0), Attempt((), 5.0, 8.0)], close)
    ''
    """
    for sentence, fits in _kinds(is_same, attempts[0].wanted):
        if all(_holds(fits, attempt) for attempt in attempts):
            return sentence
    return _parts_missing(attempts[0]) or _factor(attempts)


def _kinds(is_same: IsSame, wanted: Any) -> Iterator[tuple[str, Callable[[Attempt], bool]]]:  # noqa: ANN401
    """Yield each kind of mistake: what is said of it, and whether a call shows it.

    Parameters
    ----------
    is_same : compares an answer with the right one.
    wanted : a right answer, which may have several parts.
    """
    for part in range(len(wanted) if isinstance(wanted, tuple) else 0):
        yield ONE_PART.format(number=part + 1, count=len(wanted)), partial(_is_part, part)
    yield MASK, _is_mask
    yield INDICES, _is_indices
    yield PLACES, _are_values_at
    yield SWAPPED, partial(_are_parts_swapped, is_same)
    for sentence, make in FROM_ANSWER.items():
        yield sentence, partial(_becomes_right, is_same, make)
    for sentence, make in FROM_WANTED.items():
        yield sentence, partial(_is_made_of_wanted, make)
    yield COMPLEX, _is_complex
    yield REPEATED, partial(_is_right_without_repeats, is_same)
    yield ANOTHER_ORDER, _is_in_another_order


def _holds(fits: Callable[[Attempt], bool], attempt: Attempt) -> bool:
    """Check whether a call shows a kind of mistake; one that cannot be compared does not."""
    try:
        return bool(fits(attempt))
    except Exception:  # an answer may have any type
        return False


def _becomes_right(is_same: IsSame, make: Maker, attempt: Attempt) -> bool:
    """Check whether an answer, changed, is the right one."""
    with np.errstate(all="ignore"):
        changed = make(attempt.answer)
    return is_same(changed, attempt.wanted)


def _is_made_of_wanted(make: Maker, attempt: Attempt) -> bool:
    """Check whether the right answer, changed, is the student's."""
    return _equal_arrays(attempt.answer, make(attempt.wanted))


def _equal_arrays(a: Any, b: Any) -> bool:  # noqa: ANN401
    """Compare two answers as arrays of numbers."""
    if np.iscomplexobj(a):
        return False
    first = np.asarray(a, float)
    second = np.asarray(b, float)
    return first.shape == second.shape and np.allclose(first, second, rtol=1e-8, atol=1e-9, equal_nan=True)


def _is_mask(attempt: Attempt) -> bool:
    """Check whether an answer is a mask where indices are asked for."""
    mask = np.asarray(attempt.answer)
    is_countable = isinstance(attempt.wanted, set) or np.asarray(attempt.wanted).dtype == int
    return mask.dtype == bool and mask.ndim > 0 and is_countable


def _is_bool(wanted: Any) -> bool:  # noqa: ANN401
    """Check whether an answer should be a mask."""
    return isinstance(wanted, np.ndarray) and wanted.dtype == bool


def _is_indices(attempt: Attempt) -> bool:
    """Check whether an answer gives the indices of a mask."""
    if not _is_bool(attempt.wanted):
        return False
    indices = np.flatnonzero(attempt.wanted).tolist()
    return sorted(np.ravel(attempt.answer).tolist()) == indices


def _are_values_at(attempt: Attempt) -> bool:
    """Check whether an answer gives the entries of an argument at the right indices."""
    arrays = [argument for argument in attempt.arguments if isinstance(argument, np.ndarray)]
    is_set = isinstance(attempt.wanted, set)
    places = np.array(sorted(attempt.wanted) if is_set else attempt.wanted)
    if not np.issubdtype(places.dtype, np.integer):
        return False
    values = np.sort(np.ravel(np.array(list(attempt.answer), float)))
    for array in arrays:
        index = tuple(places.T) if is_set else places
        entries = np.sort(np.ravel(array[index]))
        has_right_form = array.ndim == (2 if is_set else 1)
        if has_right_form and _equal_arrays(values, entries):
            return True
    return False


def _are_parts_swapped(is_same: IsSame, attempt: Attempt) -> bool:
    """Check whether the two or three parts of an answer are the right ones, the last one first."""
    is_tuple = isinstance(attempt.wanted, tuple) and isinstance(attempt.answer, tuple | list)
    return is_tuple and is_same(tuple(attempt.answer)[::-1], attempt.wanted)


def _is_complex(attempt: Attempt) -> bool:
    """Check whether an answer is complex where it should be real."""
    items = attempt.answer if isinstance(attempt.answer, tuple | list) else [attempt.answer]
    return any(map(np.iscomplexobj, items)) and not np.iscomplexobj(attempt.wanted)


def _is_right_without_repeats(is_same: IsSame, attempt: Attempt) -> bool:
    """Check whether an answer is right up to values that it repeats."""
    unique = list(dict.fromkeys(attempt.answer))
    return is_same(unique, attempt.wanted) or is_same(sorted(unique), attempt.wanted)


def _is_in_another_order(attempt: Attempt) -> bool:
    """Check whether an answer has the right values, in any order."""
    if isinstance(attempt.wanted, set | dict | float | int):
        return False
    return _equal_arrays(np.sort(np.ravel(attempt.answer)), np.sort(np.ravel(attempt.wanted)))


def _parts_missing(attempt: Attempt) -> str:
    """Return how many parts an answer should have; "" for one of as many, or of no parts."""
    has_parts = isinstance(attempt.wanted, tuple) and isinstance(attempt.answer, tuple | list)
    if not has_parts:
        return ""
    count = len(attempt.answer)
    wanted = len(attempt.wanted)
    return "" if count == wanted else PARTS.format(count=count, wanted=wanted)


def _is_part(part: int, attempt: Attempt) -> bool:
    """Check whether an answer is one part of the right one."""
    answer = attempt.answer
    is_wrapped = isinstance(answer, tuple) and len(answer) == 1
    item = answer[0] if is_wrapped else answer
    wanted = attempt.wanted[part]
    return _equal_arrays(item, wanted) or _equal_signs(item, wanted)


def _equal_signs(a: Any, b: Any) -> bool:  # noqa: ANN401
    """Compare quaternions, of which q and -q are the same."""
    are_quaternions = np.ndim(b) > 1 and np.shape(b)[-1] == QUATERNION
    return are_quaternions and _equal_arrays(np.abs(a), np.abs(b))


def _factor(attempts: list[Attempt]) -> str:
    """Return by which constant factor all answers differ from the right ones, if there is one."""
    if len(attempts) < 2:
        return ""
    try:
        answers = _joined([attempt.answer for attempt in attempts])
        wanted = _joined([attempt.wanted for attempt in attempts])
        factor = float(answers @ wanted / (wanted @ wanted))
    except (TypeError, ValueError):
        return ""
    has_factor = factor != 0 and np.allclose(answers, factor * wanted, rtol=1e-8, atol=1e-9)
    return f"your values are {factor:.4g} times the right ones." if has_factor else ""


def _joined(answers: list[Any]) -> Any:  # noqa: ANN401
    """Join the numbers of all answers."""
    return np.concatenate([np.ravel(np.asarray(answer, float)) for answer in answers])
