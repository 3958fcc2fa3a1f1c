"""The checks of the course's exercises, by the names of the functions that they ask for.

A notebook has a table here, such as `06-pruning.toml`: what each of its exercises asks for, with which input
it is tried, the right answer, and the mistakes that students make, each with its hint. Beside them, `shared`
has what tables use by name.

>>> from mocap.course import checks
>>> checks.speed(lambda positions, fps: ...)
✗ speed: not there yet. It must return ...
"""

import tomllib
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

from mocap.course.check import Check
from mocap.course.checks import shared


@cache
def all_checks() -> dict[str, Check]:
    """Return every check by its name, notebook by notebook."""
    found: dict[str, Check] = {}
    for file in sorted(Path(__file__).parent.glob("*.toml")):
        for name, table in tomllib.loads(file.read_text("utf-8")).items():
            found[name] = Check(name, table, vars(shared), file.stem.partition("-")[0])
    return found


def nearest(name: str) -> str:
    """Say what to do about a name that no exercise has.

    Examples
    --------
    >>> nearest("sped"), nearest("<lambda>")
    ('write `speed`', 'write `def` and the name that the exercise gives')
    """
    near = get_close_matches(name, all_checks(), 1)
    return f"write `{near[0]}`" if near else "write `def` and the name that the exercise gives"


def __getattr__(name: str) -> Check:
    if name not in all_checks():
        known = ", ".join(all_checks())
        raise AttributeError(f"the course has no check '{name}'; it has: {known}; {nearest(name)}")
    return all_checks()[name]
