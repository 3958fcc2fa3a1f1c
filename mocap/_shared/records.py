"""Classes with named fields: printed in one line, compared by their values, and pickled by their fields.

`dataclass` and `NamedTuple` are those of the standard library, except that a record is printed in one line,
with arrays as their shapes and long lists as their lengths. Import them from here in place of `dataclasses`
and `typing`. Type checkers see the originals.

`same_fields` compares records that contain arrays, whose `==` would be an array of booleans.
"""

from __future__ import annotations

import types
import typing
from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

LONGEST = 200  # characters of a printed record
FEW = 8  # the largest number of items in a collection that is not abbreviated
SHORT = 70  # the largest number of characters of a field that is not abbreviated


def one_line(record: Any) -> str:  # noqa: ANN401
    """Format a record with named fields in one line of at most `LONGEST` characters.

    The longest fields are abbreviated first.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> class Track(NamedTuple):
    ...     positions: object
    ...     seconds: float
    >>> one_line(Track(np.zeros((471, 3)), 3.9))
    'Track(positions=<array (471, 3)>, seconds=3.9)'
    """
    values = {name: getattr(record, name) for name in _field_names(record)}
    parts = {name: _brief(value) for name, value in values.items()}
    last_first = list(parts)[::-1]
    for name in sorted(last_first, key=lambda name: -len(parts[name])):
        line = _joined(record, parts)
        if len(line) <= LONGEST:
            return line
        parts[name] = _abbreviation(values[name])
    line = _joined(record, parts)
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 5]} ...)"


def _joined(record: object, parts: Mapping[str, str]) -> str:
    return f"{type(record).__name__}({', '.join(f'{name}={part}' for name, part in parts.items())})"


def _field_names(record: Any) -> list[str]:  # noqa: ANN401
    if is_dataclass(record):
        return [field.name for field in fields(record) if field.repr]
    return list(record._fields)


def _brief(value: object) -> str:
    """Format the value of a field, abbreviated unless it is short."""
    if isinstance(value, np.ndarray):
        size = value.size
    elif isinstance(value, Collection) and not hasattr(value, "_fields"):
        size = len(value)
    else:
        size = 0
    if size > FEW:
        return _abbreviation(value)
    line = repr(value)
    return line if len(line) <= SHORT and "\n" not in line else _abbreviation(value)


def _abbreviation(value: object) -> str:
    """Format the type of a value, with its shape or length if it has one."""
    if isinstance(value, np.ndarray):
        return f"<array {value.shape}>"
    kind = type(value).__name__
    if isinstance(value, Collection) and not hasattr(value, "_fields"):
        return f"<{kind} of {len(value)}>"
    return f"<{kind}>"


def same_fields(record: Any, second: Any) -> bool:  # noqa: ANN401
    """Compare two dataclasses of one class field by field, arrays by shape and values, without tolerance.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(eq=False)
    ... class Path:
    ...     points: object
    >>> same_fields(Path(np.zeros(3)), Path(np.zeros(3))), same_fields(Path(np.zeros(3)), Path(np.ones(3)))
    (True, False)
    """
    if record is second:
        return True
    names = [field.name for field in fields(record)]
    return all(_equal(getattr(record, name), getattr(second, name)) for name in names)


def _equal(value: Any, second: Any) -> bool:  # noqa: ANN401
    if isinstance(value, np.ndarray):
        return np.array_equal(value, second)
    if isinstance(value, Mapping):
        return value.keys() == second.keys() and all(_equal(value[key], second[key]) for key in value)
    return bool(value == second)


def rebuilding(record: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:  # noqa: ANN401
    """Return the result of `__reduce__`, by which unpickling calls the constructor with the fields.

    An unpickled record has therefore been checked, and its arrays are read-only. Cached values are not
    pickled.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class Rate:
    ...     fps: float
    >>> rebuilding(Rate(30.0))[1]
    (30.0,)
    """
    return type(record), tuple(getattr(record, field.name) for field in fields(record))


if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
    from typing import NamedTuple as NamedTuple
else:
    from dataclasses import dataclass as standard_dataclass

    def dataclass(kind: type | None = None, **options: bool) -> type | Callable[[type], type]:
        """Make a dataclass that is printed in one line, unless it has a `__repr__`."""

        def decorate(kind: type) -> type:
            if "__repr__" not in vars(kind):
                kind.__repr__ = one_line
            return standard_dataclass(kind, **options)

        return decorate if kind is None else decorate(kind)

    class _OneLine(type):
        """The metaclass of `NamedTuple`: its subclasses become named tuples that are printed in one line."""

        def __new__(cls, name: str, bases: tuple[type, ...], body: dict[str, Any]) -> type:
            if not bases:
                return super().__new__(cls, name, bases, body)
            record = types.new_class(name, (typing.NamedTuple,), {}, lambda namespace: namespace.update(body))
            if "__repr__" not in body:
                record.__repr__ = one_line
            return record

    class NamedTuple(metaclass=_OneLine):
        """Make a named tuple that is printed in one line, unless it has a `__repr__`."""
