"""What the rooms export."""

import importlib
import typing

import pytest

from mocap._shared import faces

MAKERS = ("build", "make_", "load", "register", "judge", "find_", "follow", "search")
MAKERS += ("in_between", "fill_gap")
EXPORTED = faces.exports()
FUNCTIONS = [
    f"{room}.{name}"
    for room, names in EXPORTED.items()
    for name in names
    if name.startswith(MAKERS) and not room.startswith("mocap.course") and room != "mocap.methods"
]


def classes_in(hint: object) -> list[type]:
    """Return the classes of the package that a return type names, inside lists and unions, too."""
    parts = typing.get_args(hint)
    if parts:
        return [kind for part in parts for kind in classes_in(part)]
    return [hint] if isinstance(hint, type) and hint.__module__.startswith("mocap.") else []


@pytest.mark.parametrize("path", FUNCTIONS)
def test_what_a_function_makes_is_exported_by_a_room(path):
    room, name = path.rsplit(".", 1)
    function = getattr(importlib.import_module(room), name)
    public = {exported for names in EXPORTED.values() for exported in names}
    hints = typing.get_type_hints(function, vars(importlib.import_module(function.__module__)))
    assert [kind.__name__ for kind in classes_in(hints["return"]) if kind.__name__ not in public] == []
