"""Every command of the README, as a newcomer types it: in a folder of clips, one after the other."""

import re
import shlex
from dataclasses import replace
from pathlib import Path

import pytest
from walking import generate_walk

from mocap.body.motion import resample
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.files import load_save
from tests.files.acclaim_clips import write_acclaim

README = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
SLOW = ("pytest", "pip", "demo", "lab", "data", "course")  # tested elsewhere, or not a command of ours


def commands():
    """List the lines of shell blocks, and the commands in tables, that start with `mocap`."""
    blocks = re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    lines += re.findall(r"^\| `(mocap [^`]*)`", README, re.MULTILINE)
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
