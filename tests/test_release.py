"""What is published: the names at the top, two archives, their numbers, and what they promise."""

import re
import sys
import tarfile
import tomllib
import zipfile
from itertools import chain
from pathlib import Path

import pytest

import mocap
from mocap import datasets
from mocap.cli.main import COMMANDS
from tests.wheels import ROOT, build, call, install


def test_every_name_is_there():
    for name in mocap.__all__:
        assert getattr(mocap, name).__name__.split(".")[-1] == name
    assert set(mocap.__all__) <= set(dir(mocap))


def test_another_name_is_not():
    with pytest.raises(AttributeError, match="mocap has no 'walk'"):
        _ = mocap.walk


def test_the_ten_lines_of_the_readme_run(tmp_path, monkeypatch):
    readme = (Path(__file__).parents[1] / "README.md").read_text()
    (lines,) = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(datasets, "SAMPLES", ["walk_circle", "walk_curve_1"])  # two clips and 2 s are quick
    exec(lines.replace("seconds=20", "seconds=2"), {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["walk.bvh", "walk.gif"]


STABLE = (ROOT / "mocap" / "STABLE.md").read_text("utf-8")
DEMO = """
import os, sys, mocap
from pathlib import Path
from mocap.course.notebooks import execute, read
from mocap.errors import missing
from nbformat.v4 import new_code_cell

assert mocap.__file__.startswith(sys.prefix)
assert '"motion-graphs[video]"' in str(missing("Films need it", "video"))
notebook = read(Path("course/00-quickstart.ipynb"))
ours = "import sys, mocap; assert mocap.__file__.startswith(sys.prefix)"
notebook.cells[27:] = [new_code_cell(ours)]  # after the first canvas; the rest measures
execute(notebook, Path("course/00-quickstart.ipynb").resolve())
"""


def test_one_version_and_one_date_stand_everywhere():
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    cited = re.search(r"^version: (.*)$", citation, re.M)[1]
    built = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert cited == built == mocap.__version__
    date = re.search(r"^date-released: (.*)$", citation, re.M)
    if date:
        assert released()[0] == (mocap.__version__, date[1])
    else:
        assert mocap.__version__ not in dict(released())


CHANGES = (ROOT / "CHANGELOG.md").read_text("utf-8")
KINDS = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]


def released():
    """List the versions in the changelog and their dates, the latest first."""
    return re.findall(r"^## \[(\d+\.\d+\.\d+)\] - (\d{4}-\d\d-\d\d)$", CHANGES, re.M)


def faults_of_sections(text):
    """List versions that are not in the form, or out of order."""
    first, *others = re.findall(r"^## (.*)$", text, re.M) or [""]
    form = re.compile(r"\[(\d+)\.(\d+)\.(\d+)\] - \d{4}-\d\d-\d\d")
    found = [] if first == "[Unreleased]" else ["the first section is not [Unreleased]"]
    found += [head for head in others if not form.fullmatch(head)]
    versions = [[*map(int, match.groups())] for head in others if (match := form.fullmatch(head))]
    if versions != sorted(versions, reverse=True):
        found.append("the latest version is not the first")
    return found


def faults_of_kinds(text):
    """List kinds of changes that are none, or out of order."""
    found = []
    for section in re.split(r"^## ", text, flags=re.M)[1:]:
        kinds = re.findall(r"^### (.*)$", section, re.M)
        unknown = [kind for kind in kinds if kind not in KINDS]
        found += unknown
        if not unknown and kinds != sorted(kinds, key=KINDS.index):
            found.append("the kinds are out of order")
    return found


def faults_of_entries(text):
    """List entries that are no single, short sentence, or stand twice."""
    lines = text.splitlines()
    entries = [line.removeprefix("- ") for line in lines if line.startswith("- ")]
    found = [entry for entry in entries if not entry.endswith(".") or len(entry) > 170]
    if any(line.startswith(" ") for line in lines):
        found.append("an entry has two lines")
    if len(set(entries)) < len(entries):
        found.append("an entry stands twice")
    return found


def faults(text):
    """List what is not in the form of Keep a Changelog."""
    return faults_of_sections(text) + faults_of_kinds(text) + faults_of_entries(text)


def test_the_changelog_has_one_section_per_version_and_one_line_per_entry():
    assert faults(CHANGES) == []


def test_what_never_was_released_is_not_listed_as_changed_or_removed():
    first = re.split(r"^## ", CHANGES, flags=re.M)[1]
    assert released() or re.findall(r"^### (.*)$", first, re.M) == ["Added"]


FORM = """# Changelog

## [Unreleased]

### Added

- A thing.

## [0.1.0] - 2030-01-31

### Fixed

- A fault.
"""


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("## [Unreleased]", "## 0.2.0 (unreleased)", "the first section is not [Unreleased]"),
        ("[0.1.0] - 2030-01-31", "0.1.0", "0.1.0"),
        ("### Fixed", "### Gone", "Gone"),
        ("- A fault.", "- A fault.\n  In two lines.", "an entry has two lines"),
        ("- A fault.", "- A fault", "A fault"),
        ("- A fault.", "- A thing.", "an entry stands twice"),
        ("### Fixed", "### Removed\n\n- Another.\n\n### Changed", "the kinds are out of order"),
        ("## [0.1.0]", "## [0.0.9] - 2029-01-31\n\n## [0.1.0]", "the latest version is not the first"),
    ],
)
def test_another_form_would_be_noticed(old, new, fault):
    assert faults(FORM) == []
    assert fault in faults(FORM.replace(old, new))


def test_the_page_lists_what_is_stable():
    named = set(re.findall(r"`mocap\.(\w+)`", STABLE.partition("**May change**")[0]))
    assert named == {name for name in mocap.__all__ if not hasattr(getattr(mocap, name), "__path__")}
    assert set(re.findall(r"`mocap ([a-z]+)`", STABLE)) == set(chain.from_iterable(COMMANDS.values()))
    assert "twine upload dist/*" in STABLE


@pytest.fixture(scope="module")
def archives(tmp_path_factory):
    pytest.importorskip("twine", reason="pip install '.[ci]'")
    out = tmp_path_factory.mktemp("dist")
    build(out)
    return next(out.glob("*.tar.gz")), next(out.glob("*.whl"))


@pytest.mark.sweep
def test_the_archives_hold_what_they_should_and_nothing_else(archives):
    call(sys.executable, "-m", "twine", "check", "--strict", *archives, folder=ROOT)
    with tarfile.open(archives[0]) as whole, zipfile.ZipFile(archives[1]) as wheel:
        source = {name.partition("/")[2] for name in whole.getnames()}
        held = set(wheel.namelist())
    if (ROOT / ".git").exists():
        assert source <= {*call("git", "ls-files", folder=ROOT).split("\n"), "PKG-INFO"}
    assert not any(name.startswith((".ci", ".binder")) for name in source)
    assert {"LICENSE", "README.md", "CITATION.cff", "tests/test_release.py", "pyproject.toml"} <= source
    assert any(name.endswith("licenses/LICENSE") for name in held)
    assert {name.removeprefix("mocap/") for name in held if name.endswith(".ipynb")} == {
        name for name in source if name.endswith(".ipynb")
    }
    of_exam = [name for name in held | source if "teaching/answers" in name or name.endswith(".key")]
    assert not of_exam and not any(name.startswith(("tests", "figures")) for name in held)
    typed = {str(path.relative_to(ROOT)) for path in (ROOT / "mocap").rglob("__init__.pyi")}
    assert typed | {"mocap/py.typed"} <= source & held
    assert not [name for name in source | held if Path(name).suffix.lower() in (".amc", ".asf", ".c3d")]


@pytest.mark.sweep
def test_the_wheel_alone_makes_a_walk_and_runs_a_notebook(archives, tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    env = install(archives[1], tmp_path)
    python = env / "bin" / "python"
    call(env / "bin" / "mocap", "demo", "--seconds", "2", folder=empty)
    assert {path.name for path in (empty / "mocap-demo").iterdir()} >= {"walk.bvh", "walk.gif", "walk.html"}
    call(env / "bin" / "mocap", "course", "handout", "--wheel", "-o", "course", folder=empty)
    call(python, "-c", DEMO, folder=empty)
