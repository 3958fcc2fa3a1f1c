"""The house: its rooms and their faces, its floors, its tools."""

import ast
import importlib
import inspect
import re
import subprocess
import sys
import tomllib
from graphlib import TopologicalSorter
from itertools import chain
from pathlib import Path
from types import ModuleType

import pytest
from packaging.requirements import Requirement

import mocap
from tests import mutate

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "mocap"
ROOMS = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
STOREYS = ("course", "methods")  # rooms in them are rooms too
ROOMS += sorted(f"{s}/{path.parent.name}" for s in STOREYS for path in PACKAGE.glob(f"{s}/*/__init__.py"))
ROOMS.remove("course/checks")  # modules of answers, found by themselves
LISTED = dict(re.findall(r"^([a-z_]+)  +\w.*?(?:\(([\d, to]+)\))?$", mocap.__doc__, re.MULTILINE))
FACES = [room for room in ROOMS if room not in ("_shared", "cli", "methods")]


def face(room: str) -> ModuleType:
    return importlib.import_module(f"mocap.{room.replace('/', '.')}")


def files(room: str) -> list[str]:
    return sorted(path.stem for path in (PACKAGE / room).glob("*.py") if path.stem != "__init__")


def test_the_rooms_are_those_of_the_plan():
    assert {p.name for p in PACKAGE.glob("*.py")} == {"__init__.py", "__main__.py", "errors.py", "plain.py"}
    assert {"_shared", *LISTED} == {room for room in ROOMS if "/" not in room}


def test_the_rooms_are_listed_from_the_ground_floor_up_with_the_notebooks_that_their_faces_name():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    layers = project["tool"]["importlinter"]["contracts"][0]["layers"]
    floors = {room: floor for floor, rooms in enumerate(reversed(layers)) for room in rooms.split(" | ")}
    assert list(LISTED) == sorted(LISTED, key=floors.get)
    for room, notebooks in LISTED.items():
        told = re.findall(r"^Reading order(?: \(notebooks? (.*)\))?$", face(room).__doc__, re.MULTILINE)
        assert told == [notebooks], room


def test_the_face_of_a_room_lists_its_files_in_reading_order():
    for room in ROOMS:
        listed = re.findall(r"^ ?\d+\. `(\w+)`: ", face(room).__doc__, re.MULTILINE)
        folders = [path.parent.name for path in (PACKAGE / room).glob("*/__init__.py")]
        assert sorted(listed) == sorted([*files(room), *folders]), room


def test_faces_give_their_names_without_a_further_import():
    code = "import importlib, sys\nfor name in sys.argv[1:]:\n room = importlib.import_module(name)\n"
    code += " print(*(getattr(room, n).__name__ for n in dir(room) if n.islower()))"
    names = [f"mocap.{room.replace('/', '.')}" for room in FACES]
    run("-c", code, *names)


def test_a_face_solves_the_keys_of_papers_that_its_files_name():
    for room in FACES:
        texts = [path.read_text("utf-8") for path in (PACKAGE / room).glob("*.py")]
        named = {key for text in texts for key in re.findall(r"\[([A-Z][A-Za-z]+\d\d)", text)}
        assert named <= set(re.findall(r"^\.\. \[(\w+)\]", face(room).__doc__, re.MULTILINE)), room


def test_no_file_bears_the_name_of_a_function_that_its_room_exports():
    for room in ROOMS:
        own = face(room)
        exported = {name for name in dir(own) if not inspect.ismodule(getattr(own, name))}
        assert not set(files(room)) & exported, room


def test_the_tests_stand_in_the_same_rooms():
    for room in set(ROOMS) - set(STOREYS):
        tested = {path.stem.removeprefix("test_") for path in (ROOT / "tests" / room).glob("test_*.py")}
        assert tested & set(files(room)), room


def imports_of(file: Path) -> set[str]:
    """List the modules that a file imports: at its head, in functions, and for types only."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            names |= {str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)}
    return names


@pytest.mark.parametrize("room", [".", *ROOMS])
def test_no_files_of_a_room_import_each_other_in_a_circle(room):
    """Imports for types count: `if TYPE_CHECKING` hides a circle from Python, not from a reader."""
    prefix = ".".join(["mocap", *Path(room).parts])
    modules = {f"{prefix}.{path.stem}": path for path in (PACKAGE / room).glob("*.py")}
    below = {name: imports_of(path) & (modules.keys() - {name}) for name, path in modules.items()}
    assert set(TopologicalSorter(below).static_order()) == modules.keys()


def test_changes_are_made_in_modules_that_there_are():
    assert all((ROOT / path).is_file() for path in mutate.modules())


@pytest.mark.parametrize("bound", mutate.bounds())
def test_a_bound_with_room_has_a_change_that_can_be_made(bound):
    """Whether the change is caught, `python tests/mutate.py --bounds` finds out."""
    file, _, name = bound.test.partition("[")[0].partition("::")
    assert f"def {name}(" in (ROOT / file).read_text("utf-8")
    assert (ROOT / bound.asserting).read_text("utf-8").count(bound.assertion) == 1
    assert (ROOT / bound.file).read_text("utf-8").count(bound.old) == 1
    assert bound.new != bound.old and bound.room


def test_importing_the_package_is_light():
    code = "import sys, mocap; print(sorted({m.split('.')[0] for m in sys.modules} & set(sys.argv[1:])))"
    heavy = ["matplotlib", "ipywidgets", "networkx", "scipy", "numpy", "argparse", "tqdm"]
    assert run("-c", code, *heavy).strip() == "[]"


def test_every_dependency_has_a_lower_bound():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = [*project["dependencies"], *chain(*project["optional-dependencies"].values())]
    for need in map(Requirement, needs):
        assert need.name == "motion-graphs" or any(s.operator == ">=" for s in need.specifier), need


def run(*command: str) -> str:
    """Run Python with some arguments, and give what it prints."""
    done = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.tools
def test_style():
    run("-m", "ruff", "check", ".")
    run("-m", "ruff", "format", "--check", ".")


@pytest.mark.tools
def test_types():
    run("-m", "mypy")


@pytest.mark.tools
def test_floors():
    """Who may import whom stands in pyproject.toml."""
    linting = "from importlinter.cli import lint_imports_command as lint; lint(['--no-cache'])"
    assert "0 broken" in run("-c", linting)


def test_what_takes_long_is_there():
    for line in (ROOT / "tests" / "long.txt").read_text("utf-8").splitlines():
        file, _, name = line.partition("::")
        function = name.partition("[")[0].rpartition(".")[2]  # without its case; doctests have dots
        defined = rf"(def|class) {function}\b"
        assert not name or re.search(defined, (ROOT / file).read_text("utf-8")), line
