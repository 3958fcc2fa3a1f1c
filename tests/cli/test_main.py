"""The command, as a person types it."""

import io
import os
import subprocess
import sys
import warnings

import pytest

import mocap
from mocap.cli.main import main
from mocap.cli.options import bar
from mocap.errors import MocapWarning


def test_help_is_quick():
    code = (
        "import sys, mocap.cli.main as m; m._parser().format_help(); print(*set(sys.modules) & set(sys.argv))"
    )
    heavy = ["matplotlib", "scipy", "networkx", "numpy", "tqdm", "ipywidgets"]
    done = subprocess.run([sys.executable, "-c", code, *heavy], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_it_says_its_version(capsys):
    with pytest.raises(SystemExit, match="0"):
        main(["--version"])
    assert capsys.readouterr().out == f"mocap {mocap.__version__}\n"


def test_a_warning_is_a_line_too(capsys, monkeypatch):
    def warn(*_arguments, **_settings):
        warnings.warn("7 frames stay.", MocapWarning, stacklevel=1)
        return "x"

    monkeypatch.setattr("mocap.graphs.read", warn)
    with pytest.raises(AttributeError):
        main(["graph", "info", "x.npz"])
    assert capsys.readouterr().err == "mocap: 7 frames stay.\n"


def test_as_a_module_a_closed_pipe_is_quiet():
    command = f"'{sys.executable}' -m mocap data list | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert (done.stderr, done.stdout.count("\n")) == ("", 1)


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
