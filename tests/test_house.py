"""The house: its layers, its bounds, its tools."""

import ast
import subprocess
import sys
import tomllib
from itertools import chain
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "mocap"
MODULES = {path.stem: path for path in sorted(PACKAGE.glob("*.py"))}
CHECKS = {f"checks.{path.stem}": path for path in sorted((PACKAGE / "checks").glob("*.py"))}

# From below to above. In a layer, too, a module uses only those that stand before it.
LAYERS = {
    "what all need": "errors progress collecting atomic rotations style",
    "motion": "skeleton motion kinematics transforms inverse_kinematics",
    "files": "amc acclaim_skeleton acclaim acclaim_writer bvh_hierarchy bvh files inspection conversion",
    "clips to begin with": "footsteps gait walker pacing synthetic cmu datasets",
    "what is alike": "point_clouds cloud_grid matching minima transitions",
    "seams and feet": "blending joining legs plants footprints leg_posing foot_targets root_rise calm_knees "
    "footskate quality homework_slips",
    "graphs": "pruning segment_graph motion_graph merging thresholds graph_summary graph_files",
    "out of the graph": "walks synthesis dumping search paths path_files compiling routes layered_search "
    "follow paper_search keyframes crowd control",
    "what one sees": "stills stage player animation graph_drawing plotting search_drawing live pointing "
    "widgets",
    "the course": "checking course handout course_site course_lite lab",
    "commands": "demo gallery commands show_commands walk_command course_command __main__",
}
ORDER = " ".join(LAYERS.values()).split()


def imported(path: Path, *, at_import: bool = False) -> set[str]:
    """Name the modules of the package that a module imports; `at_import`: only those outside functions."""
    found: set[str] = set()
    tree = ast.parse(path.read_text())
    for node in tree.body if at_import else ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "mocap":
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mocap."):
            found.add(str(node.module).split(".")[1])
        elif isinstance(node, ast.Import):
            found |= {a.name.split(".")[1] for a in node.names if a.name.startswith("mocap.")}
    return found


def test_every_module_has_its_place_in_the_layers():
    assert sorted([*ORDER, "__init__"]) == sorted(MODULES)


@pytest.mark.parametrize("name", ORDER)
def test_a_module_imports_only_what_stands_before_it(name):
    assert imported(MODULES[name]) <= set(ORDER[: ORDER.index(name)])


@pytest.mark.parametrize("name", CHECKS)
def test_checks_import_anything_but_what_opens_the_course(name):
    assert not imported(CHECKS[name]) & {"__main__", "course", "lab", "widgets", "plotting"}


@pytest.mark.parametrize("name", MODULES | CHECKS)
def test_a_module_is_short_and_so_are_its_functions(name):
    text = (MODULES | CHECKS)[name].read_text()
    assert len(text.splitlines()) <= 300
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            lines = body[-1].end_lineno - body[0].lineno + 1 if body else 0
            assert lines <= 30, f"{name}.{node.name} has {lines} lines"


@pytest.mark.parametrize("path", sorted(PACKAGE.glob("*.js")), ids=lambda path: path.name)
def test_a_script_is_short(path):
    assert len(path.read_text("utf-8").splitlines()) <= 300


def test_importing_the_package_is_light():
    code = "import sys, mocap; print(sorted({m.split('.')[0] for m in sys.modules} & set(sys.argv[1:])))"
    heavy = ["matplotlib", "ipywidgets", "networkx", "scipy", "numpy"]
    done = subprocess.run([sys.executable, "-c", code, *heavy], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_plotting_stays_out_of_the_method():
    code = "import sys, mocap.synthesis, mocap.files, mocap.datasets; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


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
