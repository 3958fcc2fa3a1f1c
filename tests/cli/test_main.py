"""The command, `course run`, `lab` and every command of the page of commands, as a person types them.

More of `course` is in tests/course.
"""

import io
import os
import re
import shlex
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import nbformat
import pytest
from walking import generate_walk

import mocap
from mocap.body.motion import resample
from mocap.cli import help_pages
from mocap.cli.main import main
from mocap.cli.stages import bar
from mocap.course import opening
from mocap.datasets import samples
from mocap.files import load_save
from tests.files.acclaim_clips import write_acclaim


def test_help_is_quick():
    code = (
        "import io, sys, contextlib, mocap.cli.main as m\n"
        "with contextlib.redirect_stdout(io.StringIO()): m.main(['--help'])\n"
        "print(*set(sys.modules) & set(sys.argv))"
    )
    heavy = [
        "matplotlib",
        "scipy",
        "networkx",
        "numpy",
        "tqdm",
        "ipywidgets",
        "rich.console",
        "concurrent.futures",
    ]
    done = subprocess.run([sys.executable, "-c", code, *heavy], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_it_says_its_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"mocap {mocap.__version__}\n"


def test_help_is_a_command_too(capsys):
    for words in (["help"], ["help", "graph", "info"]):
        assert main(words) == 0
        told = capsys.readouterr().out
        assert main([*words[1:], "--help"]) == 0
        assert told == capsys.readouterr().out != ""


def test_paragraphs_of_a_help_page_are_folded_but_for_those_with_indented_lines():
    text = "one two three\n\nkeys:\n  at 1s"
    assert help_pages._fold(text, 8) == "one two\nthree\n\nkeys:\n  at 1s"


def test_examples_in_a_help_page_begin_a_line(capsys):
    assert main(["help", "inbetween"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert sum(line.startswith("Example: mocap inbetween ") for line in lines) == 2


def test_as_a_module_a_closed_pipe_is_quiet():
    command = f"'{sys.executable}' -m mocap data list | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert (done.stderr, done.stdout.count("\n")) == ("", 1)


def test_ctrl_c_while_the_package_is_loaded_is_one_sentence():
    code = (
        "import signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # a shell's background ignores it
        "class Interrupted:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'cyclopts': signal.raise_signal(signal.SIGINT)\n"
        "sys.meta_path.insert(0, Interrupted())\n"
        "from mocap.__main__ import main\n"
        "sys.exit(main())"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "mocap: interrupted before anything was done.\n"


def test_a_terminal_that_knows_ascii_only_is_served():
    command = [sys.executable, "-m", "mocap", "warp", "--help"]
    own = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=own)
    assert "--loose-feet" in done.stdout


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize(
    ("screen", "settings", "drawn"),
    [
        (Terminal(), {"delay": 0.0, "mininterval": 0.0}, True),
        (Terminal(), {}, False),  # of quick work
        (io.StringIO(), {"delay": 0.0, "mininterval": 0.0}, False),
    ],
)
def test_a_bar_is_drawn_on_a_terminal_only(monkeypatch, screen, settings, drawn):
    monkeypatch.setattr(sys, "stderr", screen)
    assert list(bar("spelling")("abcd", **settings)) == list("abcd")
    assert ("spelling" in screen.getvalue()) == drawn


def test_a_cell_that_fails_is_named_in_one_sentence(tmp_path, run):
    path = tmp_path / "n.ipynb"
    cells = [nbformat.v4.new_markdown_cell("# Title"), nbformat.v4.new_code_cell("x = 1\nx / 0")]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    before = path.read_text("utf-8")
    assert run(f"course run {path}", 2).err == f"mocap: {path}, cell 1: ZeroDivisionError: division by zero\n"
    assert path.read_text("utf-8") == before


class Started:
    """A JupyterLab that ends when it has been asked twice."""

    def __init__(self, command):
        self.command, self.asked = command, 0

    def wait(self):
        self.asked += 1
        if self.asked == 1:
            raise KeyboardInterrupt
        return 7


@pytest.mark.parametrize(("user", "allowed"), [(0, ["--allow-root"]), (1000, [])])
def test_lab_opens_the_first_notebook_and_leaves_ctrl_c_to_jupyterlab(monkeypatch, tmp_path, user, allowed):
    started = []
    monkeypatch.setattr(
        opening.subprocess, "Popen", lambda command: started.append(Started(command)) or started[0]
    )
    monkeypatch.setattr(opening.os, "geteuid", lambda: user, raising=False)
    own = ["--no-browser", "--port", "8890"]
    assert main(["lab", str(tmp_path), "--", *own]) == 7  # JupyterLab's own status
    command = started[0].command
    assert command[1:3] == ["-m", "jupyterlab"]
    assert command[3] == str(
        tmp_path / "00-quickstart.ipynb"
    )  # also where notebooks of a checkout are at hand
    assert command[4:] == [*allowed, *own]
    assert started[0].asked == 2


PAGE = (Path(__file__).parents[2] / "notebooks" / "COMMANDS.md").read_text("utf-8")
# Tested elsewhere, or no command of ours.
SLOW = ("pytest", "pip", "demo", "lab", "data", "course", "--end stand", "--without", "--layout")


def commands():
    """List the lines of shell blocks, and the commands in tables, that start with `mocap`."""
    blocks = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    lines += re.findall(r"^\| `(mocap [^`]*)`", PAGE, re.MULTILINE)
    return [line for line in lines if line.startswith("mocap ") and not re.search("|".join(SLOW), line)]


@pytest.fixture
def newcomer(tmp_path, monkeypatch):
    """Give a newcomer a folder with clips, and with a path."""
    (tmp_path / "my-clips").mkdir()
    walk, *others = (resample(samples.sample(f"walk_{n}"), 30) for n in ("curve_1", "curve_2", "circle"))
    for name, clip in zip("ab", others, strict=True):
        load_save.save(clip[:240], tmp_path / "my-clips" / f"{name}.bvh")
    write_acclaim(walk[:200], tmp_path / "walk.amc")
    monkeypatch.setattr("mocap.files.acclaim.CMU_RATE", 30.0)  # the format does not tell it
    for name, speed in (("slow", 0.8), ("brisk", 1.2)):
        straight = generate_walk([[0, 0], [0, 5]], speed=speed)
        load_save.save(resample(straight, 30), tmp_path / f"{name}.bvh")
    small = replace(walk.skeleton, offsets=0.6 * walk.skeleton.offsets)
    child = replace(walk, skeleton=small, root_positions=0.6 * walk.root_positions)
    load_save.save(child[:150], tmp_path / "child.bvh")
    (tmp_path / "keys.txt").write_text("at 1.5s rhand -0.1 0.2 0.1\n")
    (tmp_path / "points.csv").write_text("1, 6\n")
    (tmp_path / "discs.csv").write_text("-3, 4, 0.5\n")
    (tmp_path / "path.svg").write_text('<svg><path d="M0 0 L 0 -300"/></svg>')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda page: True)
    return tmp_path


def test_each_command_works_after_those_before_it(newcomer, capsys):
    for line in commands():
        words = shlex.split(
            line.replace("1h", "10s")
            .replace("mocap crowd", "mocap crowd --members 3 --no-film")
            .replace(" --clean", "")
        )
        assert main(words[1:]) == 0, (line, capsys.readouterr().err)
    for made in ("graph.npz", "walk.bvh", "long.bvh", "bent.bvh", "reach.bvh", "half.bvh", "child", "found"):
        assert (newcomer / made).exists()
