"""Types and completion, as users have them: from a wheel, outside the checkout.

`typed/ordinary_calls.py` and `typed/wrong_calls.py` are programs of users. Type checkers accept the first one
and report each line of the second one that says so.
"""

import ast
import importlib
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

import mocap
from tests.test_house import FACES, PACKAGE
from tests.wheels import ROOT, build, install

TYPED = Path(__file__).with_name("typed")
PYRIGHT = ROOT / "tests" / "javascript" / "node_modules" / ".bin" / "pyright"
EXPORT = re.compile(r"from \.[\w.]* import (\w+) as \1\n")  # without `as`, a stub hides the name
STUBS = sorted(PACKAGE.rglob("__init__.pyi"))

# Libraries of notebooks that have no types: mypy would report each import of them.
UNTYPED = ("networkx", "scipy", "tqdm")


# One source of a room's names -------------------------------------------------------------------------------


def module_of(stub):
    return importlib.import_module(".".join(stub.relative_to(ROOT).parent.parts))


def test_each_room_with_a_face_has_a_stub():
    lazy = [path for path in PACKAGE.rglob("__init__.py") if "faces.attach(" in path.read_text("utf-8")]
    assert [path.with_suffix(".pyi") for path in sorted(lazy)] == STUBS
    assert {PACKAGE / room / "__init__.pyi" for room in [*FACES, "methods", "."]} == set(STUBS)


@pytest.mark.parametrize("stub", STUBS, ids=lambda stub: stub.parent.name)
def test_a_room_exports_what_its_stub_lists_and_each_name_is_there(stub):
    text = stub.read_text("ascii")
    names = EXPORT.findall(text)
    room = module_of(stub)
    assert EXPORT.sub("", text).strip() == ("__version__: str" if room is mocap else "")
    assert sorted(names) == sorted(set(names)) == sorted(room.__all__) == sorted(dir(room))
    for name in names:
        exported = getattr(room, name)
        assert getattr(exported, "__name__", name).split(".")[-1] == name


def test_no_room_lists_a_name_a_second_time():
    for stub in STUBS:
        (attached,) = re.findall(r"^__getattr__.*", stub.with_suffix(".py").read_text("utf-8"), re.MULTILINE)
        assert attached == "__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)"


# Constructors that take lists -------------------------------------------------------------------------------


def typed_constructors():
    """Find the classes whose constructor has other types than their fields, as (class, its parameters)."""
    for path in sorted(PACKAGE.rglob("*.py")):
        text = path.read_text("utf-8")
        if "def __init__" not in text or "if TYPE_CHECKING" not in text:
            continue
        module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
        for part in ast.parse(text).body:
            branches = [inner for inner in ast.iter_child_nodes(part) if isinstance(inner, ast.If)]
            for branch in branches if isinstance(part, ast.ClassDef) else ():
                yield getattr(module, part.name), branch.body[0].args


CONSTRUCTORS = list(typed_constructors())


def test_the_constructors_of_bodies_motions_paths_and_constraints_take_lists():
    assert {kind.__name__ for kind, _ in CONSTRUCTORS} == {"GroundPath", "Motion", "Pins", "Skeleton"}


@pytest.mark.parametrize(("kind", "arguments"), CONSTRUCTORS)
def test_a_typed_constructor_has_the_parameters_of_the_class(kind, arguments):
    names = [argument.arg for argument in arguments.args[1:]]
    assert names == [field.name for field in fields(kind)] == list(inspect.signature(kind).parameters)
    required = [field for field in fields(kind) if field.default is field.default_factory is MISSING]
    assert len(arguments.defaults) == len(names) - len(required)
    assert not arguments.kwonlyargs and not arguments.vararg and not arguments.kwarg


# Programs of users ------------------------------------------------------------------------------------------


def is_call(node):
    return isinstance(node, ast.Call)


def test_the_ordinary_calls_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = (TYPED / "ordinary_calls.py").read_text("utf-8")
    exec(code, {})
    assert {path.name for path in tmp_path.iterdir()} == {
        "walk.bvh",
        "graph.npz",
        "group.npz",
        "walk.gif",
        "web.npz",
    }
    calls = [part for part in ast.parse(code).body if any(map(is_call, ast.walk(part)))]
    assert len(calls) >= 40


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Return the Python of an environment that has the package from its wheel."""
    folder = tmp_path_factory.mktemp("typed")
    build(folder, "--wheel")
    python = install(next(folder.glob("*.whl")), folder) / "bin" / "python"
    asked = [python, "-c", "import mocap; print(mocap.__file__)"]
    found = subprocess.run(asked, cwd=folder, capture_output=True, text=True, check=True).stdout
    assert str(folder) in found and not ROOT.samefile(folder)
    return python


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """Write README's code, the first code cell of each notebook and the examples into one folder."""
    folder = tmp_path_factory.mktemp("programs")
    (readme,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.DOTALL)
    (folder / "readme.py").write_text(readme, "utf-8")
    for notebook in sorted((ROOT / "notebooks").glob("*.ipynb")):
        cells = json.loads(notebook.read_text("utf-8"))["cells"]
        first = next("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        (folder / f"cell_{re.sub(r'[^0-9a-z]', '_', notebook.stem)}.py").write_text(first + "\n", "utf-8")
    for program in (ROOT / "notebooks" / "examples").glob("*.py"):
        shutil.copy(program, folder / f"example_{program.name}")
    for program in TYPED.glob("*.py"):
        shutil.copy(program, folder)
    assert len(list(folder.glob("cell_*.py"))) == 31
    return folder


@pytest.fixture(scope="module")
def by_pyright(installed, programs):
    """Return the errors of pyright, as (file, line, message)."""
    if not shutil.which("node") or not PYRIGHT.exists():
        pytest.skip("no pyright here: npm install --prefix tests/javascript")
    (programs / "pyrightconfig.json").write_text('{"typeCheckingMode": "basic"}')
    command = [PYRIGHT, "--outputjson", "--pythonpath", installed, "--project", programs]
    done = subprocess.run(command, cwd=programs, capture_output=True, text=True, check=False)
    report = json.loads(done.stdout)
    assert report["summary"]["filesAnalyzed"] == len(list(programs.glob("*.py"))), done.stdout
    return [
        (Path(part["file"]).name, part["range"]["start"]["line"] + 1, part["message"])
        for part in report["generalDiagnostics"]
        if part["severity"] == "error"
    ]


@pytest.fixture(scope="module")
def by_mypy(installed, programs):
    """Return the errors of mypy, as (file, line, message)."""
    pytest.importorskip("mypy", reason="no mypy here: pip install '.[ci]'")
    sections = [f"[mypy-{name}.*]\nignore_missing_imports = true\n" for name in UNTYPED]
    (programs / "mypy.ini").write_text("[mypy]\n" + "".join(sections))
    options = ["--config-file=mypy.ini", f"--cache-dir={os.devnull}", f"--python-executable={installed}"]
    files = sorted(path.name for path in programs.glob("*.py"))
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *options, *files],
        cwd=programs,
        capture_output=True,
        text=True,
        check=False,
    )
    assert f"(checked {len(files)} source files)" in done.stdout, done.stdout + done.stderr
    errors = re.findall(r"^(\S+?\.py):(\d+): error: (.*)$", done.stdout, re.MULTILINE)
    return [(file, int(line), message) for file, line, message in errors]


@pytest.mark.tools
@pytest.mark.parametrize("checker", ["by_pyright", "by_mypy"])
def test_the_code_of_readers_and_users_has_no_type_error(checker, request):
    errors = request.getfixturevalue(checker)
    assert [error for error in errors if error[0] != "wrong_calls.py"] == []


@pytest.mark.tools
@pytest.mark.parametrize("checker", ["by_pyright", "by_mypy"])
def test_each_wrong_call_is_reported_at_its_line(checker, request):
    errors = request.getfixturevalue(checker)
    lines = (TYPED / "wrong_calls.py").read_text("utf-8").splitlines()
    wrong = {number for number, line in enumerate(lines, 1) if "  # wrong: " in line}
    assert len(wrong) >= 20
    assert {line for file, line, _ in errors if file == "wrong_calls.py"} == wrong


# Code, and what an editor completes at its end.
COMPLETED = {
    "from mocap import graphs\ngraphs.": {"build", "prune", "load", "save", "summary", "MotionGraph"},
    "import mocap\nmocap.lo": {"load"},
    "import mocap\nmocap.graphs.bui": {"build"},
    "import mocap\nmocap.load('walk.bvh').": {
        "skeleton",
        "root_positions",
        "rotations",
        "fps",
        "duration",
        "positions",
        "velocities",
    },
    "from mocap import datasets\ndatasets.cmu('16_15').root_p": {"root_positions"},
    "from mocap.methods import match_webs\nmatch_webs.": {"build_web", "search", "MotionSpace"},
    "from mocap import widgets\nwidgets.draw_path(follow, [[0, 0]]).": {"path", "player", "error", "frame"},
    "from mocap import widgets\nwidgets.handles(ax, [[0, 0]]).": {"value", "limits", "count"},
    "from mocap import widgets\nwidgets.steered(characters).": {"command", "delays"},
    "from mocap import graphs\ngraphs.build(clips, exec": {"executor="},
}


@pytest.mark.tools
@pytest.mark.parametrize("code", COMPLETED)
def test_jedi_completes_names_fields_and_options(code, installed, tmp_path):
    jedi = pytest.importorskip("jedi", reason="no Jedi here: pip install '.[test]'")
    environment = jedi.create_environment(str(installed.parents[1]), safe=False)
    script = jedi.Script(code, environment=environment, project=jedi.Project(str(tmp_path)))
    assert {completion.name for completion in script.complete()} >= COMPLETED[code]
