"""CONTRIBUTING.md: each path, name and option that it mentions exists, and the code of its recipes runs."""

import re
import shlex
import sys
from dataclasses import replace
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import pytest
from cyclopts import CycloptsError

from mocap.files import formats
from mocap.matching import other_metrics
from mocap.quality import judging
from mocap.quality.measures import see
from tests.cli.listing import understood
from tests.strategies import wave

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.skipif(not (ROOT / ".ci").is_dir(), reason="only a checkout has all that is named")
PAGE = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
TEXT = re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)
CODE = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
LINES = [
    line.partition("  #")[0].strip()
    for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    for line in block.strip().splitlines()
    if line.strip()
]
SUFFIXES = (".py", ".md", ".toml", ".txt", ".json")


def is_path(word):
    return ("/" in word or word.endswith(SUFFIXES)) and " " not in word


def exists(path):
    """Check for a file or folder; a name in capitals, such as FORMAT.py, stands for a new file."""
    new = re.search(r"/[^/]*FORMAT[^/]*$", path)
    return (ROOT / (path[: new.start()] if new else path)).exists()


def missing(words):
    """Return the paths that do not exist."""
    return sorted({word for word in words if not exists(word)})


def test_each_path_exists():
    words = re.findall(r"`([^`\n]+)`", TEXT)
    paths = [word for word in words if is_path(word) and word not in ("xyz.py", "__init__.py")]
    assert len(paths) > 30
    assert missing(paths) == []


def resolve(name):
    """Import as much of a dotted name as is a module, and take the rest as attributes."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            module = import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        return attrgetter(".".join(parts[count:]))(module) if parts[count:] else module
    raise ModuleNotFoundError(name)


def test_each_dotted_name_exists():
    names = re.findall(r"`(mocap(?:\.\w+)+)`", TEXT)
    assert len(names) > 8
    for name in names:
        resolve(name)


PLACES = {
    "diagonal_sum": "mocap/matching/window_sums.py",
    "METRICS": "mocap/matching/other_metrics.py",
    "READ": "mocap/files/formats.py",
    "refused_texts": "tests/refusals.py",
    "FLAWS": "tests/quality/test_judging.py",
    "COMMANDS": "mocap/cli/main.py",
    "real_data": "conftest.py",
    "test_root_grid_adds_metres_and_radians": "tests/matching/test_distance_grids.py",
    "measure_smoothness": "mocap/quality/smoothness.py",
    "measure_feet": "mocap/quality/standing_feet.py",
    "measure_joints": "mocap/quality/judging.py",
    "measure_limbs": "mocap/quality/judging.py",
    "measure_body": "mocap/quality/judging.py",
}


@pytest.mark.parametrize(("name", "path"), PLACES.items())
def test_each_name_of_a_recipe_is_defined_in_its_file(name, path):
    assert f"`{name}`" in TEXT or f".{name}`" in TEXT
    assert f"`{path}`" in TEXT or name == "diagonal_sum"
    assert re.search(rf"^(def )?{name}\b", (ROOT / path).read_text("utf-8"), re.MULTILINE)


def options_of(words):
    return [word.partition("=")[0] for word in words if re.match(r"-{1,2}\w", word)]


def commands():
    """Split the lines of shell into commands: a list of words each, without variables before them."""
    for line in LINES:
        for part in line.split(" && "):
            words = shlex.split(part)
            while words and re.fullmatch(r"[A-Z_]+=\S+", words[0]):
                del words[0]
            yield [words[0].removeprefix(".venv/bin/"), *words[1:]]


def test_each_command_has_its_options_and_its_files(request):
    known = request.config._parser
    tried = set()
    for program, *words in commands():
        tried.add(program)
        if program == "pytest":
            unknown = known.parse_known_and_unknown_args(words)[1]
            assert unknown == []
        elif program == "mocap":
            assert understood(words)
        elif program == "python" and words[0].endswith(".py"):
            script = (ROOT / words[0]).read_text("utf-8")
            assert all(f'"{option}"' in script for option in options_of(words)), words
        paths = [word.partition("::")[0] for word in words if is_path(word) and not word.startswith("-")]
        assert missing(paths) == []
    assert tried >= {"pytest", "mocap", "python", "ruff", "mypy"}


def test_an_option_or_a_path_that_is_not_there_would_be_noticed(request):
    parsed = request.config._parser.parse_known_and_unknown_args(["--no-such-option"])
    assert parsed[1] == ["--no-such-option"]
    with pytest.raises(CycloptsError, match="no-such-command"):
        understood(["no-such-command"])
    assert missing(["tests/no_such_file.py", "mocap/no_such_room/FORMAT.py"]) == [
        "mocap/no_such_room/FORMAT.py",
        "tests/no_such_file.py",
    ]
    with pytest.raises(AttributeError):
        resolve("mocap.matching.no_such_name")


def recipe(text):
    """Return the only block of Python code that holds a text."""
    (block,) = (block for block in CODE if text in block)
    return dedent(block)


def test_the_metric_of_the_recipe_has_the_interface(monkeypatch):
    space = dict(vars(other_metrics))
    exec(recipe("def height_grid"), space)
    a, b = wave(9), wave(7, phase=1.0)
    grid = space["height_grid"](a, b, window=3)
    heights_a, heights_b = a.root_positions[2:5, 1], b.root_positions[1:4, 1]
    assert grid.shape == (7, 5)
    assert grid[2, 1] == pytest.approx(abs(heights_a - heights_b).mean())


def test_the_reader_of_the_recipe_reads_and_its_tests_pass(monkeypatch, tmp_path):
    monkeypatch.setattr(formats, "READ", dict(formats.READ))
    module = ModuleType("mocap.files.xyz")
    exec(recipe("POINT = Skeleton"), vars(module))
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setattr("mocap.files.xyz", module, raising=False)
    exec(f"from __future__ import annotations\n{recipe('def read_xyz')}", dict(vars(formats)))
    tests = {}
    exec(recipe("def test_a_point_moves"), tests)
    names = [name for name in tests if name.startswith("test_")]
    assert len(names) == 2
    for name in names:
        tests[name](tmp_path)


def test_the_measure_of_the_recipe_stands_out_in_its_flaw():
    constant = re.search(r"`(SLOWEST_RATE = .*?)  #", PAGE)[1]
    space = dict(vars(judging))
    line = recipe("yield Measure(").strip()
    exec(f"{constant}\ndef measure(seen):\n    {line}", space)
    (fine,) = space["measure"](see(wave(20), ()))
    (coarse,) = space["measure"](see(replace(wave(20), fps=15.0), ()))
    assert fine.ratio < 1 < coarse.ratio
