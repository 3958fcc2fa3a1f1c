"""Plain data between two processes, one of which cannot be trusted: JSON that says what is an array.

Reading JSON runs no code, unlike reading a pickle.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any

import numpy as np

PLAIN = re.compile(r"[|<>=][biufc]\d{1,2}")  # the types of arrays that are numbers


def pack(value: Any) -> Any:  # noqa: ANN401
    """Turn a value into what JSON can hold; of what is no plain data only the type is told.

    Examples
    --------
    >>> pack((1, {2.5}, None, len))
    ['tuple', [1, ['set', [2.5]], None, '<builtin_function_or_method>']]
    """
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic) and not isinstance(value, complex):
        return float(value) if isinstance(value, np.longdouble) else pack(value.item())
    if hasattr(value, "__array__") and not isinstance(value, complex):
        array = np.asarray(value)
        if not PLAIN.fullmatch(array.dtype.str):
            return pack(array.tolist())
        text = base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()
        return ["array", array.dtype.str, array.shape, text]
    return _pack_group(value)


def _pack_group(value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, complex):
        return ["complex", value.real, value.imag]
    if isinstance(value, Mapping):
        return ["dict", [[pack(key), pack(item)] for key, item in value.items()]]
    for kind, group in (("tuple", tuple), ("set", Set), ("list", Sequence)):
        if isinstance(value, group):
            return [kind, [pack(item) for item in value]]
    return ["..."] if value is ... else f"<{type(value).__name__}>"


def unpack(packed: Any) -> Any:  # noqa: ANN401
    """Turn what `pack` gave back into a value.

    Raises
    ------
    ValueError : if `pack` cannot have given it; also KeyError or TypeError.

    Examples
    --------
    >>> unpack(pack({"a": np.arange(3), "b": (...,)}))
    {'a': array([0, 1, 2]), 'b': (Ellipsis,)}
    """
    if not isinstance(packed, list):
        return packed
    kind, *parts = packed
    return READERS[kind](*parts)


def _array(kind: str, shape: list[int], text: str) -> Any:  # noqa: ANN401
    if not PLAIN.fullmatch(kind):
        raise ValueError(f"an array of {kind}")
    return np.frombuffer(base64.b64decode(text), kind).reshape(shape).copy()


def _dict(items: list[Any]) -> dict[Any, Any]:
    return {unpack(key): unpack(item) for key, item in items}


READERS: dict[str, Callable[..., Any]] = {
    "...": lambda: ...,
    "complex": complex,
    "array": _array,
    "dict": _dict,
}
READERS["list"] = lambda items: list(map(unpack, items))
READERS["tuple"] = lambda items: tuple(map(unpack, items))
READERS["set"] = lambda items: set(map(unpack, items))
