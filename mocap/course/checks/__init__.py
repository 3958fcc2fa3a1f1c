"""The checks of the course's exercises, by the names of the functions that they ask for.

Each file here belongs to one notebook; `mocap.course.check` says how a check works.

>>> from mocap.course import checks
>>> checks.speed(lambda positions, fps: ...)
✗ speed: not there yet. It must return ...
"""

import pkgutil
from functools import cache
from importlib import import_module

from mocap.course.check import Check


@cache
def all_checks() -> dict[str, Check]:
    """Return every check by its name, notebook by notebook."""
    modules = [import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)]
    found = [value for module in modules for value in vars(module).values() if isinstance(value, Check)]
    return {check.name: check for check in found}


def __getattr__(name: str) -> Check:
    if name not in all_checks():
        raise AttributeError(f"the course has no check '{name}'; it has: {', '.join(all_checks())}")
    return all_checks()[name]
