"""Deprecated names: they warn for one whole 0.x version before removal, as `mocap/STABLE.md` promises."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import ParamSpec, TypeVar
from warnings import warn

from mocap.errors import MocapError

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Deprecation:
    """A stable name that will be removed in a later version.

    name : the name that users write, such as "mocap.load".
    since : the first version that warns, such as "0.2".
    removed_in : the version that no longer has the name.
    instead : its replacement.

    Raises
    ------
    MocapError : for a name that would not warn for one whole 0.x version.

    Examples
    --------
    >>> print(Deprecation("mocap.read", since="0.2", removed_in="0.3", instead="mocap.load"))
    mocap.read is deprecated since version 0.2 and is removed in version 0.3: use mocap.load.
    """

    name: str
    since: str
    removed_in: str
    instead: str

    def __post_init__(self) -> None:
        """Check that the name warns for one whole version."""
        major, minor, patch = version_numbers(self.since)
        whole = minor + 1 if patch == 0 else minor + 2  # 0.2.3 is not all of 0.2: all of 0.3 must warn
        if version_numbers(self.removed_in) < (major, whole, 0):
            raise MocapError(
                f"{self.name} must warn for one whole version: deprecated since {self.since}, "
                f"it can be removed in {major}.{whole}, got {self.removed_in}."
            )

    def __str__(self) -> str:
        """Return the message of the warning."""
        return (
            f"{self.name} is deprecated since version {self.since} and is removed in version "
            f"{self.removed_in}: use {self.instead}."
        )

    def is_due(self, version: str) -> bool:
        """Return whether the name must be removed in a version."""
        return version_numbers(version) >= version_numbers(self.removed_in)


DEPRECATED: list[Deprecation] = []
"""All deprecated names of the modules imported so far. A test fails if the removal of one is due."""


def version_numbers(version: str) -> tuple[int, int, int]:
    """Return the first three numbers of a version, 0 for missing ones.

    Examples
    --------
    >>> version_numbers("0.2"), version_numbers("1.10.3.dev1")
    ((0, 2, 0), (1, 10, 3))
    """
    parts = [*version.split("."), "0", "0"]
    major, minor, patch, *_ = parts
    return int(major), int(minor), int(patch)


def deprecated(
    name: str, *, since: str, removed_in: str, instead: str
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator for a function, or an alias of one, that warns with each call.

    Parameters
    ----------
    name, since, removed_in, instead : as for `Deprecation`.

    Examples
    --------
    A function is renamed to `load` in version 0.2, and its old name is kept for that version:

    >>> def load(path):
    ...     return f"the motion of {path}"
    >>> read = deprecated("mocap.read", since="0.2", removed_in="0.3", instead="mocap.load")(load)
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     read("walk.bvh")
    'the motion of walk.bvh'
    >>> caught[0].category.__name__
    'DeprecationWarning'
    >>> _ = DEPRECATED.pop()  # it was an example
    """
    deprecation = Deprecation(name, since, removed_in, instead)
    DEPRECATED.append(deprecation)

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @wraps(function)
        def warning(*values: P.args, **options: P.kwargs) -> R:
            warn(str(deprecation), DeprecationWarning, stacklevel=2)  # the line of the caller
            return function(*values, **options)

        warning.__doc__ = f"{deprecation}\n\n{function.__doc__ or ''}".rstrip()
        warning.__name__ = name.rpartition(".")[2]
        return warning

    return decorate
