"""Checks of the arguments of a call, including missing ones."""

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

from mocap.errors import MocapError

Call = TypeVar("Call", bound=Callable[..., Any])


def checked_by(check: Callable[..., object]) -> Callable[[Call], Call]:
    """Return a decorator that calls `check` with the arguments of a function before the function itself.

    Python raises a TypeError for a missing argument, without an example of a correct call. A check has the
    default None for each parameter, and can therefore raise `MocapError` instead. Type checkers see the
    parameters of the function.

    Parameters
    ----------
    check : a function of the same arguments, whose result is ignored.

    Examples
    --------
    >>> def require_two(first=None, second=None):
    ...     if second is None:
    ...         raise MocapError("This takes two numbers, as in add(1, 2).")
    >>> @checked_by(require_two)
    ... def add(first, second):
    ...     return first + second
    >>> from mocap.errors import MocapError
    >>> add(1)
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes two numbers, as in add(1, 2).
    >>> add(1, 2)
    3
    """

    def decorate(function: Call) -> Call:
        @wraps(function)
        def checked(*arguments: object, **options: object) -> object:
            check(*arguments, **options)
            return function(*arguments, **options)

        return cast(Call, checked)

    return decorate


def called_as(right_call: str) -> Callable[[Call], Call]:
    """Return a decorator that raises `MocapError`, with a correct call, for too many or too few arguments.

    Parameters
    ----------
    right_call : the correct call, for the error.

    Examples
    --------
    >>> @called_as("walk(graph, seconds=4)")
    ... def walk(graph, *, seconds):
    ...     return seconds
    >>> walk(None, 4)
    Traceback (most recent call last):
    mocap.errors.MocapError: The call is walk(graph, seconds=4): too many positional arguments.
    >>> walk(None)
    Traceback (most recent call last):
    mocap.errors.MocapError: The call is walk(graph, seconds=4): missing a required argument: 'seconds'.
    """

    def decorate(function: Call) -> Call:
        signature = inspect.signature(function)

        @wraps(function)
        def checked(*arguments: object, **options: object) -> object:
            try:
                signature.bind(*arguments, **options)
            except TypeError as error:
                raise MocapError(f"The call is {right_call}: {error}.") from None
            return function(*arguments, **options)

        return cast(Call, checked)

    return decorate
