"""The package as a wheel for students: what is in it, and whether a handout installs itself from it."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import mocap
from mocap.course.handout import WHEEL, hand_out
from mocap.course.notebooks import read, tagged
from mocap.course.opening import stored
from mocap.course.student_wheel import requirement_from
from tests.refusals import refused
from tests.wheels import HIDDEN, call

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the environments have the folders of Linux")
FIRST = "00-quickstart.ipynb"
ENVIRONMENT = {name: value for name, value in os.environ.items() if name not in HIDDEN}


HEADING = b"# Answers, version"  # of a sheet that `mocap course exam` writes


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("handout") / "class"
    hand_out([stored() / FIRST], out, WHEEL)
    return out


@pytest.fixture(scope="module")
def wheel(folder):
    (file,) = folder.glob("*.whl")
    return file


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    """Make an environment without the package, which finds the libraries of this one; return its Python."""
    environment = tmp_path_factory.mktemp("environment") / "env"
    call(sys.executable, "-m", "venv", environment, folder=environment.parent)
    (site,) = environment.glob("lib/*/site-packages")
    libraries = environment / "libraries"
    libraries.mkdir()
    for path in (path for path in sys.path if path.endswith(("site-packages", "dist-packages"))):
        for part in Path(path).iterdir():  # but not the package itself, nor the path to its checkout
            if "motion_graphs" not in part.name and part.suffix != ".pth" and part.name != "mocap":
                (libraries / part.name).exists() or (libraries / part.name).symlink_to(part)
    (site / "libraries.pth").write_text(f"{libraries}\n")
    return environment / "bin" / "python"


def test_it_has_no_solutions_and_no_answers_to_the_exam(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        notebook = json.loads(archive.read(f"mocap/notebooks/{FIRST}"))
        assert not any("teaching/answers" in name for name in names)
        texts = [archive.read(name) for name in names if name.endswith((".md", ".ipynb"))]
    tags = [tag for cell in notebook["cells"] for tag in cell["metadata"].get("tags", [])]
    assert any(tag.startswith("exercise:") for tag in tags)
    assert not any(tag.startswith("solution:") for tag in tags)
    assert not any(HEADING in text for text in texts)
    assert not any("my_graph" in name for name in names)


def test_the_same_package_gives_the_same_wheel(wheel, tmp_path):
    hand_out([stored() / FIRST], tmp_path / "again", WHEEL)
    assert (tmp_path / "again" / wheel.name).read_bytes() == wheel.read_bytes()


def test_it_has_what_the_package_needs_and_a_record_of_all(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (info,) = {name.split("/")[0] for name in names if ".dist-info/" in name}
        recorded = [line.split(",")[0] for line in archive.read(f"{info}/RECORD").decode().splitlines()]
        assert recorded == names
        assert f"Version: {mocap.__version__}" in archive.read(f"{info}/METADATA").decode()
        assert b"mocap.__main__:main" in archive.read(f"{info}/entry_points.txt")
    package = Path(mocap.__file__).parent
    for name in ("py.typed", "STABLE.md", "course/site.css", "course/checks/hints/00-quickstart.toml"):
        assert f"mocap/{name}" in names and (package / name).exists()
    assert not any("__pycache__" in name or "/." in name for name in names)


def test_requirements_and_the_first_cell_install_it_from_the_handouts_own_folder(folder, python, tmp_path):
    """No index is asked, and the libraries are there: so all comes from the folder."""
    offline = {"PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1", "PIP_QUIET": "1"}
    where = "import sys, mocap; print(mocap.__file__.startswith(sys.prefix), len(mocap.datasets.SAMPLES) > 3)"
    away = {"folder": tmp_path, **offline}
    assert subprocess.run([python, "-c", "import mocap"], cwd=tmp_path, env=ENVIRONMENT, stderr=-3).returncode
    first = read(folder / FIRST).cells[0].source
    shell = "from IPython.core.interactiveshell import InteractiveShell as S; s = S.instance()"
    runs = f"import os; {shell}; s.run_cell({first!r}).raise_error(); os.chdir({str(tmp_path)!r}); {where}"
    assert call(python, "-c", runs, folder=folder, **offline).splitlines()[-1] == "True True"
    call(python, "-m", "pip", "uninstall", "-y", "motion-graphs", **away)
    call(python, "-m", "pip", "install", "-r", "requirements.txt", folder=folder, **offline)
    assert call(python, "-c", where, **away).split() == ["True", "True"]
    check = "from mocap.course import checks; checks.speed(lambda positions, fps: ...)"
    assert "not there yet" in call(python, "-c", check, **away)
    again = "from mocap.course.opening import stored; print(stored().parent.name)"
    assert call(python, "-c", again, **away).strip() == "mocap"
    command = (python, "-m", "mocap", "course", "handout", "--wheel", "-o", tmp_path / "second")
    call(*command, **away)  # of an installed package: the same wheel again
    (second,) = (tmp_path / "second").glob("*.whl")
    with zipfile.ZipFile(second) as theirs, zipfile.ZipFile(next(folder.glob("*.whl"))) as ours:
        assert {*theirs.namelist()} == {*ours.namelist()}
    assert not list(tagged(read(tmp_path / "second" / FIRST), "solution"))


def test_a_name_or_an_address_that_cannot_be_installed_is_refused_and_one_that_can_is_taken(
    wheel, tmp_path, monkeypatch
):
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    refused("cannot install 'motion-graphs.*: hand out with origin='wheel'", requirement_from, "")
    refused("cannot install .* on this machine", requirement_from, f"file://{tmp_path}/nothing.whl")
    refused("is no address", requirement_from, 'https://"')
    address = wheel.as_uri()
    assert requirement_from(address) == f"motion-graphs[notebooks] @ {address}"
    monkeypatch.setenv("PIP_FIND_LINKS", str(wheel.parent))
    assert requirement_from("") == f"motion-graphs[notebooks]=={mocap.__version__}"


def test_nothing_is_written_if_the_package_cannot_be_installed(tmp_path, monkeypatch):
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    refused("cannot install", hand_out, [stored() / FIRST], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_command_names_the_options_that_help(tmp_path, monkeypatch, run):
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    said = run(f"course handout {stored() / FIRST} -o {tmp_path / 'out'}", 2).err
    assert "on this machine: add --wheel, which puts the package into the handout, or correct --from." in said
