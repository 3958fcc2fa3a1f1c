"""Every command of the README, as a newcomer types it: in a folder of clips, one after the other."""

import re
import shlex
from pathlib import Path

import pytest

from mocap.cli.main import main
from mocap.files import load_save
from tests.strategies import wave

README = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
SLOW = ("pytest", "pip", "demo", "lab", "data", "course")  # tested elsewhere, or not a command of ours


def commands():
    """List the lines of shell blocks, and the commands in tables, that start with `mocap`."""
    blocks = re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    lines += re.findall(r"^\| `(mocap [^`]*)`", README, re.MULTILINE)
    return [line for line in lines if line.startswith("mocap ") and not re.search("|".join(SLOW), line)]


def test_the_readme_shows_commands():
    shown = " ".join(commands())
    for command in ("mocap graph", "mocap walk", "--path", "--random", "mocap info", "mocap view"):
        assert command in shown


@pytest.fixture
def newcomer(tmp_path, monkeypatch):
    """Give a newcomer a folder with clips, and with a path."""
    (tmp_path / "my-clips").mkdir()
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, tmp_path / "my-clips" / f"{clip.name}.bvh")
    load_save.save(wave(60), tmp_path / "walk.amc")
    (tmp_path / "path.svg").write_text('<svg><path d="M0 0 L 0 -300"/></svg>')
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda page: True)
    return tmp_path


def test_each_command_works_after_those_before_it(newcomer, capsys):
    for line in commands():
        words = shlex.split(line.replace("1h", "10s").replace(" --clean", ""))
        assert main(words[1:]) == 0, (line, capsys.readouterr().err)
    for made in ("graph.npz", "walk.bvh", "long.bvh"):
        assert (newcomer / made).exists()
