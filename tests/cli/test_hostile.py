"""Hostile values for every option of every command: one sentence or an answer, never a traceback."""

import argparse
import os
import subprocess
import sys

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocap.cli.main import _parser, main
from mocap.files import load_save
from mocap.graphs import storage
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from tests.strategies import wave

HOSTILE = ["", " ", "-1", "0", "1", "3", "nan", "inf", "-inf", "1e999", "1e-300", "0x10", "é°", "a" * 5000]
HOSTILE += ["/dev/null/x", "/proc/x", ".", "..", "nowhere/x.npz", "x.bvh"]
HOSTILE += ["\n", "--", "-o", "%s", "{0}", "5:", ":"]
NEVER = {"course", "lab", "data"}  # these start programs, or are tested with theirs


def subcommands(parser, words=()):
    """Yield the words and the options of each command that has none below it."""
    inner = [a for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    if not inner:
        yield list(words), [a.option_strings[-1] for a in parser._actions if a.option_strings]
    for action in inner:
        for name, below in action.choices.items():
            if name not in NEVER:
                yield from subcommands(below, (*words, name))


COMMANDS = list(subcommands(_parser()))
FILES = {
    "graph build": ["a.bvh"],
    "graph info": ["g.npz"],
    "walk": ["g.npz", "--random", "1s"],
    "convert": ["a.bvh", "c.amc"],
    "bend": ["a.bvh", "--along", "l.csv", "-o", "w.bvh"],
    "blend": ["a.bvh", "a.bvh"],
    "retarget": ["a.bvh", "--to", "a.bvh", "-o", "r"],
    "warp": ["a.bvh", "--keys", "k.txt", "-o", "w.bvh", "--loose-feet"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("hostile")
    load_save.save(wave(60, name="a"), place / "a.bvh")
    (place / "k.txt").write_text("at 30 hand 0 0.1 0")
    (place / "l.csv").write_text("0,0\n0,3\n3,3\n")
    clip = load_save.load(place / "a.bvh")
    storage.save(prune(build([clip], window=10, threshold=0.05)), place / "g.npz")
    return place


def test_every_command_is_among_them():
    found = {" ".join(words) for words, _ in COMMANDS}
    assert found >= {"demo", "walk", "info", "convert", "view", "graph build"}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    command=st.sampled_from([c for c in COMMANDS if c[0] != ["demo"]]),
    values=st.lists(st.tuples(st.integers(0, 99), st.sampled_from(HOSTILE)), min_size=1, max_size=2),
)
def test_an_option_gets_an_answer_or_one_sentence(folder, monkeypatch, capfd, command, values):
    monkeypatch.chdir(folder)
    monkeypatch.setattr("webbrowser.open", lambda page: True)
    words, options = command
    before = {path: path.read_bytes() for path in folder.glob("[ag].*")}
    given_options = [part for at, value in values for part in (options[at % len(options)], value)]
    try:
        status = main([*words, *FILES.get(" ".join(words), ["a.bvh"]), *given_options])
    except SystemExit as stop:  # --help
        status = stop.code
    said = "".join(capfd.readouterr())  # what `convert` could not convert is part of its answer
    assert status in (0, 2)
    if status == 2:
        assert "Traceback" not in said
        assert len(said.splitlines()[-1]) <= 300
    for path, content in before.items():
        assert path.read_bytes() == content


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["walk", "g.npz", "--random", "1s", "--width", "5"], "belong to --path"),
        (["walk", "g.npz", "--random", "1s", "--label", "0:walk"], "belong to --path"),
        (["walk", "g.npz", "--random", "99h"], "up to 24h"),
        (["walk", "g.npz", "--random", "1s", "--scale", "0.01"], "--scale belongs to --clips"),
        (["walk", "g.npz", "--random", "1s", "--seed", "-1"], "--seed: '-1' is not a whole number"),
        (["walk", "g.npz", "--path", "p.csv", "--width", "-1"], "--width: '-1' is not a whole number from 1"),
        (["walk", "g.npz", "--path", "p.csv", "--seed", "1"], "--seed belongs to --random"),
        (["walk", "g.npz", "--random", "1s", "-o", "nowhere/x.bvh"], "Cannot write nowhere"),
        (["graph", "a.bvh", "--by-labels", "--whole"], "give one of them"),
        (["blend", "a.bvh"], "two clips or more"),
        (["blend", "a.bvh", "a.bvh", "--weights", "1"], "2 clips need 2 weights, got 1"),
        (["blend", "a.bvh", "a.bvh", "--weights", "1", "1"], "weights that add up to 1, got [1.0, 1.0]"),
        (["blend", "a.bvh", "a.bvh", "--at", "1"], "--at belongs to --fade"),
        (["blend", "a.bvh", "a.bvh", "a.bvh", "--fade", "1"], "got 3 clips"),
        (["blend", "a.bvh", "a.bvh", "--fade", "99"], "does not lie within"),
        (["blend", "a.bvh", "a.bvh", "--slack", "1.97"], "less than each clip lasts"),
        (["blend", "a.bvh", "a.bvh", "-o", "a.bvh"], "is one of the files to read"),
        (["blend", "a.bvh", "a.bvh", "-o", "x.fbx"], "as .bvh, .amc, .glb or .npz"),
        (["blend", "a.bvh", "gone.bvh"], "Cannot read"),
        (["info", "a.bvh", "--skeleton", "nothing.asf"], "--skeleton is for .amc clips"),
        (["info", "a.bvh", "--nope"], "unrecognized arguments: --nope (see mocap info --help)"),
        (["convert", "a.bvh", "a.bvh"], "is one of the files to convert"),
        (["convert", ".", "."], "is one of the files to convert"),
    ],
)
def test_what_would_be_ignored_or_fail_late_is_refused_at_once(folder, monkeypatch, capsys, words, message):
    monkeypatch.chdir(folder)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    assert main(words) == 2
    assert message in capsys.readouterr().err
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_a_closed_pipe_is_quiet(folder):
    command = f"'{sys.executable}' -m mocap data list | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert (done.stderr, done.stdout.count("\n")) == ("", 1)


def test_a_terminal_that_knows_ascii_only_is_served(folder):
    command = [sys.executable, "-m", "mocap", "info", str(folder / "a.bvh")]
    own = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=own)
    assert "30 Hz" in done.stdout
