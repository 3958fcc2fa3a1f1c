"""The source of a student's function with all that it needs: its imports, its helpers, its constants."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Collection
from importlib import import_module
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

from mocap.course.names import names_of
from mocap.errors import MocapError


class Plain(NamedTuple):
    """What a function needs, as text: lines of imports, and its source after that of its helpers."""

    imports: frozenset[str]
    source: str


def plain_source(function: FunctionType, known: Collection[str] = ()) -> Plain:
    """Write down a function so that a new Python can run it.

    Parameters
    ----------
    function : made in a notebook or a file.
    known : names that are there wherever it runs, as those of the course's exercises.

    Raises
    ------
    MocapError : where its source cannot be found, or it uses an object that has no short text.

    Examples
    --------
    >>> sorted(plain_source(textwrap.shorten).imports)
    ['from textwrap import TextWrapper']
    """
    imports: set[str] = set()
    helpers: dict[str, str] = {}
    _gather(inspect.unwrap(function), {*known, function.__name__}, imports, helpers)
    return Plain(frozenset(imports), "\n\n".join([*helpers.values(), _source(function)]))


def _gather(function: FunctionType, known: set[str], imports: set[str], helpers: dict[str, str]) -> None:
    """Collect what a function uses, its helpers' helpers first."""
    for name in sorted(names_of(_source(function))[1]):
        if name in known or name not in function.__globals__:
            continue
        known.add(name)
        value = function.__globals__[name]
        own = inspect.unwrap(value) if callable(value) else None  # as it stands below its decorators
        if isinstance(own, FunctionType) and own.__globals__ is function.__globals__:
            _gather(own, known, imports, helpers)
            helpers[name] = _source(own)
        elif line := _import(name, value):
            imports.add(line)
        elif _is_plain(value):
            helpers[name] = f"{name} = {value!r}\n"
        else:
            raise MocapError(f"It uses `{name}`, a {type(value).__name__} that no short text can make.")


def _import(name: str, value: Any) -> str:  # noqa: ANN401
    """Write the import that gives a name its value, or "" where none does."""
    if isinstance(value, ModuleType):
        room, _, leaf = value.__name__.rpartition(".")
        line = f"from {room} import {leaf}" if room else f"import {leaf}"
        return line if leaf == name else f"{line} as {name}"
    module, own = getattr(value, "__module__", None), getattr(value, "__name__", None)
    if not module or not own or module == "__main__":
        return ""
    try:
        found = getattr(import_module(module), own, None)
    except ImportError:
        return ""
    line = f"from {module} import {own}"
    return (line if own == name else f"{line} as {name}") if found is value else ""


def _is_plain(value: Any) -> bool:  # noqa: ANN401
    if isinstance(value, tuple):
        return all(map(_is_plain, value))
    return value is None or isinstance(value, bool | int | float | complex | str)


def _source(function: FunctionType) -> str:
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError) as error:
        raise MocapError("Its source cannot be found.") from error
    if not source.lstrip().startswith(("def ", "@")):
        raise MocapError("It is no `def` with a name of its own.")
    return source.rstrip() + "\n"
