"""The command, as a person types it."""

import subprocess
import sys
import warnings

import pytest

import mocap
from mocap.cli.main import main
from mocap.errors import MocapWarning


def test_it_runs_as_a_module_and_helps():
    run = subprocess.run(
        [sys.executable, "-m", "mocap", "demo", "--help"], capture_output=True, text=True, check=True
    )
    assert "walk.bvh" in run.stdout
    assert "--threshold" in run.stdout


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


def test_without_a_command_it_shows_the_usage(capsys):
    assert main([]) == 2
    assert capsys.readouterr().err == (
        "mocap: the following arguments are required: COMMAND (see mocap --help)\n"
    )


def test_a_warning_is_a_line_too(capsys, monkeypatch):
    def warn(*_arguments, **_settings):
        warnings.warn("7 frames stay.", MocapWarning, stacklevel=1)
        return "x"

    monkeypatch.setattr("mocap.graphs.read", warn)
    with pytest.raises(AttributeError):
        main(["graph", "info", "x.npz"])
    assert capsys.readouterr().err == "mocap: 7 frames stay.\n"
