"""Comparisons of a student's answer with the right one, and of arguments before and after a call."""

from __future__ import annotations

from typing import Any

import numpy as np


def close(answer: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether two answers are the same: numbers to 8 digits, all else exactly, item by item.

    Examples
    --------
    >>> close([1, 2.0], np.array([1.0, 2.0])), close({(0, 1)}, {(1, 0)})
    (True, False)
    """
    if isinstance(wanted, set | frozenset):  # students list its items in any type
        return {tuple(item) if np.ndim(item) else item for item in answer} == wanted
    if isinstance(wanted, dict | str) or wanted is None:
        return bool(answer == wanted)
    try:
        kind = complex if np.iscomplexobj(wanted) else float
        a = as_real(answer) if kind is float else np.asarray(answer, kind)
        b = np.asarray(wanted, kind)
    except (TypeError, ValueError):
        return len(answer) == len(wanted) and all(map(close, answer, wanted))
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-8, atol=1e-9, equal_nan=True)


def as_real(answer: Any) -> Any:  # noqa: ANN401
    """Convert an answer to real numbers.

    Raises
    ------
    ValueError : if an imaginary part is not zero.

    Examples
    --------
    >>> as_real([1 + 0j, 2])
    array([1., 2.])
    """
    numbers = np.asarray(answer)
    if np.iscomplexobj(numbers):
        if np.any(abs(numbers.imag) > 1e-9):
            raise ValueError("the answer is complex")
        numbers = numbers.real
    return np.asarray(numbers, float)


def close_angles(answer: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether angles in radians are the same up to whole turns."""
    a = as_real(answer)
    b = np.asarray(wanted, float)
    return close(np.cos(a), np.cos(b)) and close(np.sin(a), np.sin(b))


def close_rotations(answer: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether quaternions are the same rotations: q and -q are."""
    a = np.asarray(answer, float)
    b = np.asarray(wanted, float)
    if a.shape != b.shape:
        return False
    return close(a * np.where(np.sum(a * b, axis=-1, keepdims=True) < 0, -1, 1), b)


def as_numbers(value: Any) -> Any:  # noqa: ANN401
    """Return a value as an array of numbers; None if it is something else."""
    try:
        return np.asarray(value, complex)
    except (TypeError, ValueError):
        return None


def altered(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Check whether a function has changed an argument, or anything in it.

    Parameters
    ----------
    old : a copy of the argument from before the call.
    new : the argument after the call.

    Examples
    --------
    >>> altered([1, {2}], [1, {2}]), altered([1, {2}], [1, {2, 3}])
    (False, True)
    """
    if isinstance(old, np.ndarray):
        return not _equal_arrays(old, new)
    if isinstance(old, dict):
        return old.keys() != new.keys() or any(altered(old[key], new[key]) for key in old)
    if isinstance(old, list | tuple):
        return len(old) != len(new) or any(map(altered, old, new))
    if isinstance(old, float | complex):
        return not np.array_equal(old, new, equal_nan=True)
    if isinstance(old, set | frozenset | str | int | None):
        return bool(old != new)
    return _altered_attributes(old, new)


def _equal_arrays(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Check whether two arrays are equal; NaN equals NaN."""
    is_numeric = np.issubdtype(old.dtype, np.number)
    return bool(np.array_equal(old, new, equal_nan=is_numeric))


def _altered_attributes(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Check whether an attribute of an object, such as a motion, has changed; new ones are caches."""
    attributes = getattr(new, "__dict__", {})
    for name, value in getattr(old, "__dict__", {}).items():
        if name in attributes and altered(value, attributes[name]):
            return True
    return False
