"""Marking in a container, with an engine that records its words, and runs on the mounted places."""

import json
import os
import stat
import sys
from itertools import pairwise

import pytest

from mocap.cli.main import main
from mocap.course.marking import container
from tests.course.marking.students import HONEST, hand_in

pytestmark = pytest.mark.skipif(os.name != "posix", reason="marking needs Linux or macOS")
ENGINE = """#!{python}
import json, os, subprocess, sys
words = sys.argv[1:]
with open({log!r}, "a") as log:
    log.write(json.dumps(words) + "\\n")
if words[0] == "image":
    sys.exit(0 if os.path.exists({log!r} + ".image") else 1)
if words[0] == "build":
    folder = words[-1]
    with open({log!r} + ".image", "w") as image:
        image.write(open(os.path.join(folder, "Dockerfile")).read() + " ".join(sorted(os.listdir(folder))))
if words[0] == "run":
    parts = [word.split(",") for word in words if "source=" in word]
    places = [dict(part.partition("=")[::2] for part in several) for several in parts]
    inner = words[words.index("mocap"):]
    for place in places:
        inner = [word.replace(place["target"], place["source"]) for word in inner]
    sys.exit(subprocess.run([sys.executable, "-m", *inner]).returncode)
"""


@pytest.fixture
def engine(tmp_path, monkeypatch):
    """Install an engine called docker, and hide all others; return what it was asked."""
    program = tmp_path / "bin" / "docker"
    program.parent.mkdir()
    log = tmp_path / "log"
    program.write_text(ENGINE.format(python=sys.executable, log=str(log)))
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", os.pathsep.join([str(program.parent), "/usr/bin", "/bin"]))
    monkeypatch.setattr(container, "ENGINES", ("docker",))
    return lambda: [json.loads(line) for line in log.read_text().splitlines()]


def test_the_command_runs_on_the_hand_ins_in_a_container_without_a_network(engine, tmp_path, capfd):
    hand_in(HONEST, tmp_path / "in" / "ada" / "x.ipynb")
    (tmp_path / "points.toml").write_text("speed = 3")
    line = [
        "course",
        "mark",
        tmp_path / "in",
        "-o",
        tmp_path / "out" / "marks.csv",
        "--partial",
        "--container",
    ]
    line += ["--points", tmp_path / "points.toml", "--feedback", tmp_path / "pages"]
    assert main([*map(str, line)]) == 0
    asked = engine()
    assert [words[0] for words in asked] == ["info", "image", "build", "run"]
    recipe = (tmp_path / "log.image").read_text()
    assert recipe.startswith("FROM python:3.") and ".whl[notebooks]" in recipe and recipe.endswith(".whl")
    run = asked[-1]
    pairs = pairwise(run)
    assert {("--network", "none"), ("--cap-drop", "ALL"), ("--user", f"{os.getuid()}:{os.getgid()}")} <= {
        *pairs
    }
    mounted = {word.split("source=")[1].split(",")[0]: word for word in run if "source=" in word}
    assert {*mounted} == {str(tmp_path / name) for name in ("in", "points.toml", "out", "pages")}
    readonly = {place.rpartition("/")[2] for place, word in mounted.items() if "readonly" in word}
    assert readonly == {"in", "points.toml"}
    assert "ada,3,1,4," in (tmp_path / "out" / "marks-table.csv").read_text()
    assert [file.name for file in (tmp_path / "pages").iterdir()] == ["ada_feedback.html"]
    assert "marking in a container of docker" in capfd.readouterr().err
    assert main([*map(str, line)]) == 0
    assert [words[0] for words in engine()[4:]] == ["info", "image", "run"]  # the image is there


def test_without_an_engine_one_sentence_says_so(monkeypatch, tmp_path, run):
    monkeypatch.setattr(container, "ENGINES", ("no-such-engine",))
    assert (
        "neither podman nor docker is here: install or start one" in run("course mark . --container", 2).err
    )
    monkeypatch.setattr(container, "ENGINES", ("false",))
    assert "false do not answer: install or start one" in run("course mark . --container", 2).err
