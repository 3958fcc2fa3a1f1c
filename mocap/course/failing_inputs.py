"""The smallest input on which a student's function fails, in one sentence of at most 400 characters."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np

LONGEST_INPUT = 170  # characters of all arguments
LONGEST_ANSWER = 90  # characters of an answer
MOST_NUMBERS = 12  # of an array that is written out


def size_of(value: Any) -> int:  # noqa: ANN401
    """Count the numbers in an argument, also in lists, dictionaries and the attributes of an object.

    Examples
    --------
    >>> size_of(([1, 2], {3: [4.0]})), size_of(np.zeros((2, 3)))
    (4, 6)
    """
    if isinstance(value, np.ndarray):
        return value.size
    if isinstance(value, dict):
        return len(value) + sum(map(size_of, value.values()))
    if isinstance(value, list | tuple | set | frozenset):
        return sum(map(size_of, value))
    if isinstance(value, partial):
        return size_of(value.args) + sum(map(size_of, value.keywords.values()))
    attributes = getattr(value, "__dict__", None)
    return sum(map(size_of, attributes.values())) if attributes else 1


def in_words(value: Any, room: int = LONGEST_ANSWER) -> str:  # noqa: ANN401
    """Write a value on one line, with four digits, and cut it at the end of the room.

    Examples
    --------
    >>> in_words({1: [0.123456, 2]}), in_words(np.zeros((9, 2))), in_words(list(range(99)), 12)
    ('{1: [0.1235, 2]}', 'an array of shape (9, 2)', '[0, 1, 2, 3…')
    """
    text = _written(value)
    return text if len(text) <= room else text[: room - 1].rstrip() + "…"


def _written(value: Any) -> str:  # noqa: ANN401
    """Write a value on one line."""
    if isinstance(value, np.ndarray):
        is_short = value.size <= MOST_NUMBERS
        return _written(value.tolist()) if is_short else f"an array of shape {value.shape}"
    if isinstance(value, dict):
        return _written_dict(value)
    if isinstance(value, list | tuple | set | frozenset):
        return _written_items(value)
    return _single(value)


def _written_items(values: Any) -> str:  # noqa: ANN401
    """Write a list, a tuple or a set, whose items are put in order."""
    if isinstance(values, list):
        return f"[{_listed(values)}]"
    if isinstance(values, tuple):
        return f"({_listed(values)}{',' if len(values) == 1 else ''})"
    return f"{{{_listed(sorted(values, key=repr))}}}"


def _listed(values: Iterable[Any]) -> str:
    """Write the items of a list."""
    return ", ".join(map(_written, values))


def _written_dict(values: dict[Any, Any]) -> str:
    """Write a dictionary."""
    entries = [f"{_written(key)}: {_written(item)}" for key, item in values.items()]
    return f"{{{', '.join(entries)}}}"


def _single(value: Any) -> str:  # noqa: ANN401
    """Write a number, or name the kind of another object."""
    if isinstance(value, bool | np.bool_ | int | np.integer | str | None):
        return str(value)
    if isinstance(value, float | complex | np.number):
        return f"{value:.4g}"
    name = type(value).__name__
    return "a function" if callable(value) else f"a {name}"


def smallest(trials: list[tuple[tuple[Any, ...], Any, Any]]) -> tuple[tuple[Any, ...], Any, Any]:
    """Return the trial with the fewest numbers in its arguments; of equal ones, that with small integers."""
    return min(trials, key=lambda trial: (size_of(trial[0]), _sum_of_integers(trial[0])))


def _sum_of_integers(arguments: tuple[Any, ...]) -> int:
    """Add up the arguments that are integers, such as the length of a window."""
    return sum(abs(argument) for argument in arguments if isinstance(argument, int))


def failing_input(function: Callable[..., Any], arguments: tuple[Any, ...], wanted: Any, answer: Any) -> str:  # noqa: ANN401
    """Say for which arguments a student's function is wrong, what it returns, and what is right.

    Parameters
    ----------
    function : the student's; its parameters name the arguments.
    arguments : those of the call.
    wanted : the right answer.
    answer : the student's.

    Examples
    --------
    >>> print(failing_input(lambda x: 2 * x, (2.0,), 5.0, 4.0))
    For x = 2, you return 4; it should be 5.
    >>> print(failing_input(lambda grid: set(), (np.zeros((9, 3)),), {(1, 1)}, set()))
    For grid = an array of shape (9, 3), (1, 1) is missing.
    """
    room = LONGEST_INPUT // max(1, len(arguments)) - 2
    named = zip(_parameters(function, len(arguments)), arguments, strict=True)
    answered = ", ".join(f"{name}{in_words(argument, room - len(name))}" for name, argument in named)
    return f"For {answered}, {_difference(wanted, answer)}."


def _parameters(function: Callable[..., Any], count: int) -> list[str]:
    """Return how each argument is introduced: by the name of its parameter, if the function has them."""
    try:
        parameters = inspect.signature(function).parameters
    except (TypeError, ValueError):
        return [""] * count
    names = [name for name, parameter in parameters.items() if parameter.kind != parameter.VAR_POSITIONAL]
    return [f"{name} = " for name in names] if len(names) == count else [""] * count


def _difference(wanted: Any, answer: Any) -> str:  # noqa: ANN401
    """Say where two answers differ: what is missing, or the first item that is wrong."""
    try:
        return _first_difference(wanted, answer)
    except Exception:  # the answer may have any type
        return _returned("you return", answer, wanted)


def _returned(place: str, answer: Any, wanted: Any) -> str:  # noqa: ANN401
    return f"{place} {in_words(answer)}; it should be {in_words(wanted)}"


def _first_difference(wanted: Any, answer: Any) -> str:  # noqa: ANN401
    """Say where two answers of the same kind differ; raise for others."""
    if isinstance(wanted, set):
        return _items_differ(wanted, {tuple(item) if np.ndim(item) else item for item in answer})
    if isinstance(wanted, dict):
        return _entries_differ(wanted, answer)
    if isinstance(wanted, tuple) and len(answer) == len(wanted):
        return _parts_differ(wanted, answer)
    if isinstance(wanted, np.ndarray) and wanted.size > MOST_NUMBERS:
        return _numbers_differ(wanted, np.asarray(answer, wanted.dtype))
    return _returned("you return", answer, wanted)


def _parts_differ(wanted: tuple[Any, ...], answered: Any) -> str:  # noqa: ANN401
    """Say which parts of a tuple are wrong, and how the first of them is."""
    wrong = [part for part in range(len(wanted)) if not _are_close(answered[part], wanted[part])]
    if len(wrong) in {0, len(wanted)} and np.ndim(wanted[0]) == 0:
        return _returned("you return", answered, wanted)
    numbers = " and ".join(str(part + 1) for part in wrong)
    first = wrong[0]
    return f"part {numbers} of {len(wanted)} is wrong: {_difference(wanted[first], answered[first])}"


def _are_close(answer: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare two parts of answers."""
    try:
        return bool(np.allclose(answer, wanted, rtol=1e-8, atol=1e-9, equal_nan=True))
    except (TypeError, ValueError):
        return bool(answer == wanted)


def _items_differ(wanted: set[Any], answered: set[Any]) -> str:
    """Say which item of a set is missing, and which does not belong to it."""
    missing = sorted(wanted - answered, key=repr)
    extra = sorted(answered - wanted, key=repr)
    parts = [f"{in_words(missing[0])} is missing"] if missing else []
    parts += [f"{in_words(extra[0])} does not belong to the answer"] if extra else []
    return " and ".join(parts)


def _entries_differ(wanted: dict[Any, Any], answered: dict[Any, Any]) -> str:
    """Say which key of a dictionary is missing, is not wanted, or has a wrong value."""
    missing = [key for key in wanted if key not in answered]
    extra = [key for key in answered if key not in wanted]
    if missing:
        return f"the key {in_words(missing[0])} is missing"
    if extra:
        return f"{in_words(extra[0])} should not be a key"
    key = next(key for key in wanted if sorted(answered[key]) != sorted(wanted[key]))
    return _returned(f"at {in_words(key)} you return", answered[key], wanted[key])


def _numbers_differ(wanted: Any, answered: Any) -> str:  # noqa: ANN401
    """Say which entry of an array is most wrong, and how many are wrong."""
    is_wrong = ~np.isclose(answered, wanted, rtol=1e-8, atol=1e-9, equal_nan=True)
    error = np.where(is_wrong, abs(answered.astype(complex) - wanted), 0)
    place = tuple(int(index) for index in np.unravel_index(np.argmax(error), error.shape))
    count = f"{int(is_wrong.sum())} of {wanted.size} entries are wrong"
    return (
        f"{count}: entry {list(place)} is {in_words(answered[place])}; it should be {in_words(wanted[place])}"
    )
