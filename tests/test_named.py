"""What a public docstring names in backticks as the package's is reachable under that name."""

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from types import ModuleType

import pytest

import mocap
from tests.test_house import PACKAGE, ROOT
from tests.test_types import STUBS, module_of

TOKEN = re.compile(r"`([A-Za-z_][\w.]*)(?:\([^`]*\))?`")  # `build`, `graphs.build`, `graphs.build(clips)`
OUTSIDE = ("dataclasses", "dask", "gc", "math", "networkx", "numpy", "scipy")  # named by their own names
OTHERS = {"Client.get_executor"}  # of `dask.distributed`, which the sentence names


def defined() -> set[str]:
    """List the names of all public functions and classes of the package."""
    trees = [ast.parse(path.read_text("utf-8")) for path in PACKAGE.rglob("*.py")]
    definitions = [node for tree in trees for node in tree.body]
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name for node in definitions if isinstance(node, kinds) and not node.name.startswith("_")}


DEFINED = defined()
# The names of the course stay in its notebooks.
ROOMS = [stub for stub in STUBS if "course" not in stub.relative_to(PACKAGE).parts]


def public(room: ModuleType) -> Iterator[tuple[str, object, set[str]]]:
    """Yield the functions, classes and methods of a room, and the words that each of them explains itself."""
    for name in room.__all__:
        thing = getattr(room, name)
        if inspect.isclass(thing):
            members = {key: member for key, member in vars(thing).items() if not key.startswith("_")}
            words = {*members, *getattr(thing, "__annotations__", {})}
            yield name, thing, words
            yield from ((f"{name}.{key}", member, words) for key, member in members.items())
        elif inspect.isfunction(thing):
            yield name, thing, set(inspect.signature(thing).parameters)


def reached(token: str, start: ModuleType) -> bool:
    """Follow the parts of a name from a module: attributes, files of a room, fields of a class."""
    thing: object = start
    for part in token.split("."):
        if part in getattr(thing, "__annotations__", {}) and inspect.isclass(thing):
            return True
        if inspect.ismodule(thing) and not hasattr(thing, part):
            try:
                importlib.import_module(f"{thing.__name__}.{part}")
            except ImportError:
                return False
        if not hasattr(thing, part):
            return False
        thing = getattr(thing, part)
    return True


def unreachable(room: ModuleType) -> Iterator[str]:
    for name, thing, words in public(room):
        for token in TOKEN.findall(inspect.getdoc(thing) or ""):
            head = token.partition(".")[0]
            if head in words or head in OUTSIDE or token in OTHERS:
                continue
            if "." not in token and (token not in DEFINED or token in {*room.__all__, *mocap.__all__}):
                continue
            if not (reached(token, mocap) or ("." in token and reached(token, room))):
                yield f"{room.__name__}.{name} names `{token}`"


@pytest.mark.parametrize("stub", ROOMS, ids=lambda stub: str(stub.parent.relative_to(ROOT)))
def test_what_a_docstring_names_can_be_called_by_that_name(stub):
    assert list(unreachable(module_of(stub))) == []


def test_the_search_finds_a_name_that_is_not_there():
    room = ModuleType("mocap.graphs")
    room.__all__ = ["build"]
    room.build = lambda clips: None
    room.build.__doc__ = "Build; see `editing.wears`, `editing.wear`, `clips`, `symmetry` and `numpy.pi`."
    assert [line.split()[-1] for line in unreachable(room)] == ["`editing.wears`", "`symmetry`"]
