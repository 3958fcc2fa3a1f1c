"""The house: its rooms and their faces, its floors, its bounds, its tools."""

import ast
import importlib
import inspect
import re
import subprocess
import sys
import tomllib
from itertools import chain
from pathlib import Path
from types import ModuleType

import pytest
from packaging.requirements import Requirement

import mocap

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "mocap"
MODULES = {str(path.relative_to(PACKAGE)): path for path in sorted(PACKAGE.rglob("*.py"))}
ROOMS = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
STOREYS = ("course", "methods")  # rooms in them are rooms too
ROOMS += sorted(
    f"{storey}/{path.parent.name}" for storey in STOREYS for path in PACKAGE.glob(f"{storey}/*/__init__.py")
)
ROOMS.remove("course/checks")  # a file a notebook, found by itself
LISTED = dict(re.findall(r"^([a-z_]+)  +\w.*?(?:\(([\d, to]+)\))?$", mocap.__doc__, re.MULTILINE))
FACES = [room for room in ROOMS if room not in ("_shared", "cli", "methods")]
every_room = pytest.mark.parametrize("room", ROOMS)
every_face = pytest.mark.parametrize("room", FACES)


def face(room: str) -> ModuleType:
    return importlib.import_module(f"mocap.{room.replace('/', '.')}")


def files(room: str) -> list[str]:
    return sorted(path.stem for path in (PACKAGE / room).glob("*.py") if path.stem != "__init__")


def test_the_rooms_are_those_of_the_plan():
    assert {path.name for path in PACKAGE.glob("*.py")} == {
        "__init__.py",
        "__main__.py",
        "errors.py",
        "plain.py",
    }
    assert {"_shared", *LISTED} == {room for room in ROOMS if "/" not in room}


def test_the_rooms_are_listed_from_the_ground_floor_up_with_the_notebooks_that_their_faces_name():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    layers = project["tool"]["importlinter"]["contracts"][0]["layers"]
    floors = {room: floor for floor, rooms in enumerate(reversed(layers)) for room in rooms.split(" | ")}
    assert list(LISTED) == sorted(LISTED, key=floors.get)
    for room, notebooks in LISTED.items():
        told = re.findall(r"^Reading order(?: \(notebooks? (.*)\))?$", face(room).__doc__, re.MULTILINE)
        assert told == [notebooks], room


@every_room
def test_the_face_of_a_room_lists_its_files_in_reading_order(room):
    listed = re.findall(r"^ ?\d+\. `(\w+)`: ", face(room).__doc__, re.MULTILINE)
    folders = [path.parent.name for path in (PACKAGE / room).glob("*/__init__.py")]
    assert sorted(listed) == sorted([*files(room), *folders])


@every_face
def test_a_face_gives_its_names_without_a_further_import(room):
    name = room.replace("/", ".")
    code = (
        f"import mocap.{name} as room; print(*(getattr(room, n).__name__ for n in dir(room) if n.islower()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@every_face
def test_a_face_solves_the_keys_of_papers_that_its_files_name(room):
    texts = [path.read_text("utf-8") for path in (PACKAGE / room).glob("*.py")]
    named = {key for text in texts for key in re.findall(r"\[([A-Z][A-Za-z]+\d\d)", text)}
    assert named <= set(re.findall(r"^\.\. \[(\w+)\]", face(room).__doc__, re.MULTILINE))


@every_room
def test_no_file_bears_the_name_of_a_function_that_its_room_exports(room):
    own = face(room)
    assert not set(files(room)) & {name for name in dir(own) if not inspect.ismodule(getattr(own, name))}


@pytest.mark.parametrize("room", ROOMS)
def test_the_tests_stand_in_the_same_rooms(room):
    tested = {path.stem.removeprefix("test_") for path in (ROOT / "tests" / room).glob("test_*.py")}
    assert tested & set(files(room)) or room in STOREYS


@pytest.mark.parametrize("name", MODULES)
def test_a_module_is_short_and_so_are_its_functions(name):
    text = MODULES[name].read_text()
    assert len(text.splitlines()) <= 300
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            lines = body[-1].end_lineno - body[0].lineno + 1 if body else 0
            assert lines <= 30, f"{name}.{node.name} has {lines} lines"


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.js")), ids=lambda path: path.name)
def test_a_script_is_short(path):
    assert len(path.read_text("utf-8").splitlines()) <= 300


def test_importing_the_package_is_light():
    code = "import sys, mocap; print(sorted({m.split('.')[0] for m in sys.modules} & set(sys.argv[1:])))"
    heavy = ["matplotlib", "ipywidgets", "networkx", "scipy", "numpy", "argparse", "tqdm"]
    done = subprocess.run([sys.executable, "-c", code, *heavy], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_dependency_has_a_lower_bound():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = [*project["dependencies"], *chain(*project["optional-dependencies"].values())]
    for need in map(Requirement, needs):
        assert need.name == "mocap" or any(s.operator == ">=" for s in need.specifier), need


def run(*command: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.tools
def test_style():
    run("ruff", "check", ".")
    run("ruff", "format", "--check", ".")


@pytest.mark.tools
def test_types():
    run("mypy")


@pytest.mark.tools
def test_floors():
    """Who may import whom stands in pyproject.toml."""
    run("importlinter.cli", "--no-cache")
