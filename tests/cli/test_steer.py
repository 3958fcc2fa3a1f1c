"""`mocap steer`: what it prints and writes, and how it ends."""

import json
import os
import signal
import socket
import subprocess
import sys
import urllib.request
from functools import partial

import pytest

from mocap import datasets, load
from mocap.cli.main import main
from mocap.files import load_save

INTERRUPTED = 130


@pytest.fixture
def graph(tmp_path, monkeypatch):
    """Stand in a folder with the graph of a walk."""
    monkeypatch.chdir(tmp_path)
    load_save.save(datasets.sample("walk_curve_1")[:1200], tmp_path / "walk-2.bvh")
    assert main(["graph", "walk-2.bvh", "-o", "g.npz", "-q"]) == 0
    return tmp_path / "g.npz"


def interrupted(address):
    interrupted.address = address
    raise KeyboardInterrupt


def test_the_address_is_printed_and_opened_and_ctrl_c_ends_it_in_a_sentence(graph, monkeypatch, capsys):
    monkeypatch.setattr("webbrowser.open", interrupted)
    capsys.readouterr()
    assert main(["steer", str(graph)]) == INTERRUPTED
    out, err = capsys.readouterr()
    assert out == f"steer        {interrupted.address}\n" and "http://127.0.0.1:" in out
    assert err.splitlines()[-1] == "mocap: the page has ended, after 0 recordings."


def test_the_licences_of_the_clips_are_said(graph, monkeypatch, capsys):
    licensed = ["graph", "walk-2.bvh", "--licence", "CC BY-NC 4.0", "-o", str(graph)]
    assert main(licensed) == 0
    monkeypatch.setattr("webbrowser.open", interrupted)
    capsys.readouterr()
    assert main(["steer", str(graph)]) == INTERRUPTED
    assert "licences     CC BY-NC 4.0\n" in capsys.readouterr().out


def test_an_unknown_label_and_a_port_in_use_are_refused(graph, capsys):
    assert main(["steer", str(graph), "--label", "fly"]) == 2
    assert "No clip of the graph bears the label 'fly'" in capsys.readouterr().err
    with socket.create_server(("127.0.0.1", 0)) as taken:
        assert main(["steer", str(graph), "--port", str(taken.getsockname()[1])]) == 2
    assert "choose another --port, or 0 for a free one" in capsys.readouterr().err


def post(address, word, **content):
    headers = {"Content-Type": "application/json"}
    request = urllib.request.Request(address + word, json.dumps(content).encode(), headers)
    with urllib.request.urlopen(request, timeout=30) as answer:
        return json.load(answer)


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.skipif(os.name == "nt", reason="no such signals")
def test_recordings_are_written_beside_each_other_and_a_signal_ends_it(graph, name):
    command = [sys.executable, "-m", "mocap", "steer", graph, "--no-browser", "-o", "walk.bvh"]
    obeyed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # a shell's background ignores it
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, cwd=graph.parent, preexec_fn=obeyed, **pipes) as process:
        address = process.stdout.readline().split()[1]
        first = post(address, "walk", seconds=1.0, command=[0, 1, ""])["first"]
        for frames in (20, 10):
            answer = post(address, "record", first=first, last=first + frames - 1)
            assert answer["bvh"].startswith("HIERARCHY")
        process.send_signal(getattr(signal, name))
        out, err = process.communicate(timeout=60)
    assert process.returncode == INTERRUPTED
    assert err.splitlines()[-1] == "mocap: the page has ended, after 2 recordings."
    assert "wrote        walk.bvh, 0.6 s\nwrote        walk-3.bvh, 0.3 s" in out  # walk-2.bvh is a clip
    assert [len(load(graph.with_name(file))) for file in ("walk.bvh", "walk-3.bvh")] == [20, 10]
