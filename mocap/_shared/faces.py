"""Lazy imports of the names of a room. The error for an unknown name suggests another name or room.

A room's `__init__.py` calls `attach`, and its stub `__init__.pyi` lists the names.
"""

import importlib.util
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lazy_loader

from mocap._shared import renamed
from mocap.errors import shortened

EXPORT = re.compile(r"import (\w+) as \1$", re.MULTILINE)
PACKAGE = Path(__file__).parents[1]
FROM_IMPORT = "_handle_fromlist"  # the function of Python's import that asks a package for its names


def attach(room: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a room, from the stub beside its file.

    Examples
    --------
    >>> from mocap import graphs
    >>> graphs.align
    Traceback (most recent call last):
    AttributeError: mocap.graphs has no 'align'; mocap.matching has: from mocap.matching import align
    >>> from mocap.graphs import biuld
    Traceback (most recent call last):
    ImportError: mocap.graphs has no 'biuld'; do you mean mocap.graphs.build?
    """
    attribute, directory, names = lazy_loader.attach_stub(room, file)

    def find(name: str) -> object:
        if name in names:
            return attribute(name)
        is_from_import = sys._getframe(1).f_code.co_name == FROM_IMPORT
        if name.startswith("_"):
            raise AttributeError(f"{room} has no '{name}'.")
        sentence = renamed.sentence(room, name)
        if not sentence and is_from_import and is_module(room, name):
            raise AttributeError(f"{room} has no '{name}'.")
        sentence = sentence or missing_name(room, name, names)
        raise ImportError(sentence, name=room) if is_from_import else AttributeError(sentence)

    return find, directory, names


def is_module(room: str, name: str) -> bool:
    """Return whether a room has a module of that name."""
    module = f"{room}.{name}"
    return module in sys.modules or importlib.util.find_spec(module) is not None


def missing_name(room: str, name: str, names: list[str]) -> str:
    """Return the error message for an unknown name, with the room that has it or the nearest name.

    Examples
    --------
    >>> missing_name("mocap", "lod", ["load", "save"])
    "mocap has no 'lod'; do you mean mocap.load?"
    >>> missing_name("mocap", "clean", ["load", "save"])
    "mocap has no 'clean'; dir(mocap) lists its names."
    """
    from difflib import get_close_matches

    lack = f"{room} has no '{shortened(name, 40)}'"
    if is_module(room, name):
        return f"{lack} among its names: write import {room}.{name} for the file of that name."
    homes = [home for home, exported in exports().items() if name in exported]
    if homes:
        return f"{lack}; {' and '.join(homes[:2])} has: from {homes[0]} import {name}"
    if close := get_close_matches(name, names, 1, cutoff=0.7):
        return f"{lack}; do you mean {room}.{close[0]}?"
    elsewhere = {exported: home for home, listed in exports().items() for exported in listed}
    if close := get_close_matches(name, elsewhere, 1, cutoff=0.85):
        return f"{lack}; do you mean {elsewhere[close[0]]}.{close[0]}?"
    return f"{lack}; dir({room}) lists its names."


def exports() -> dict[str, list[str]]:
    """Return the names that each room exports, by room, from all stubs."""
    stubs = sorted(PACKAGE.rglob("__init__.pyi"), key=lambda stub: len(stub.parts))
    return {
        ".".join(["mocap", *stub.relative_to(PACKAGE).parent.parts]): EXPORT.findall(stub.read_text("ascii"))
        for stub in stubs
    }
