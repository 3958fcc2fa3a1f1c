"""`.ci/release`: its legs, its summary, and the share of mutants that its legs ask for."""

import os
import shutil
import subprocess
import sys

import pytest

from tests import mutate
from tests.test_house import ROOT

SCRIPT = ROOT / ".ci" / "release"
PYTHON = """#!/bin/sh
case "$*" in
  *arithmetic*) echo "kernels fail"; exit 1 ;;
  *) echo "run $*" ;;
esac
"""
needs_script = pytest.mark.skipif(
    not SCRIPT.exists() or not shutil.which("bash"), reason="without the checkout's .ci/release, or bash"
)


def release(*arguments, **environment):
    return subprocess.run(
        ["bash", SCRIPT, *arguments],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | environment,
    )


@needs_script
def test_each_leg_that_is_listed_has_its_function_and_no_other_has():
    listed = [line.split()[0] for line in release("--list").stdout.splitlines()]
    text = SCRIPT.read_text("utf-8")
    functions = [line.split("(")[0] for line in text.splitlines() if line.startswith("leg_")]
    assert [f"leg_{name.replace('-', '_')}" for name in listed] == functions
    assert len(listed) >= 8


@needs_script
def test_help_names_the_legs():
    shown = release("--help")
    assert shown.returncode == 0
    assert shown.stdout.startswith("usage: .ci/release [LEG ...]")
    assert "\n  benchmarks  " in shown.stdout


@needs_script
@pytest.mark.parametrize("name", ["kernel", "--all", ".*", "leg_kernels"])
def test_a_leg_that_does_not_exist_is_refused_in_a_sentence(name):
    refused = release("bounds", name, MOCAP_VENV="nothing")
    assert refused.returncode == 2
    assert refused.stderr == f"There is no leg '{name}': .ci/release --list names them.\n"
    assert refused.stdout == ""


@needs_script
def test_a_leg_that_fails_stops_no_other_and_the_script_fails(tmp_path):
    python = tmp_path / "bin" / "python"
    python.parent.mkdir()
    python.write_text(PYTHON)
    python.chmod(0o755)
    result = release("kernels", "bounds", MOCAP_VENV=str(tmp_path))
    assert result.returncode == 1, result.stderr
    assert result.stdout.index("kernels fail") < result.stdout.index("run tests/mutate.py --bounds")
    heads, *rows = [line.split() for line in result.stdout.splitlines()[-3:]]
    assert heads == ["leg", "minutes", "result"]
    assert [(leg, outcome) for leg, _, outcome in rows] == [("kernels", "FAILED"), ("bounds", "passed")]
    alone = release("bounds", MOCAP_VENV=str(tmp_path))
    assert alone.returncode == 0


@needs_script
def test_each_leg_of_mutants_runs_two_seeds_and_both_must_pass(tmp_path):
    python = tmp_path / "bin" / "python"
    python.parent.mkdir()
    python.write_text(PYTHON.replace("*arithmetic*", '*"--seed 1"*"--least 93"*'))
    python.chmod(0o755)
    result = release("mutation-core", "mutation-editing-methods", MOCAP_VENV=str(tmp_path), MUTANTS="6")
    assert result.returncode == 1
    outcomes = [line.split()[-1] for line in result.stdout.splitlines()[-2:]]
    assert outcomes == ["FAILED", "passed"]
    assert result.stdout.count("--count 6 --seed 2 --jobs 2 --least 93") == 1
    for seed in (1, 2):
        assert f"--count 6 --seed {seed} --jobs 2 --rooms editing methods --least 85" in result.stdout


@pytest.mark.parametrize(("percent", "passes"), [(66, True), (67, False)])
def test_mutants_that_survive_beyond_the_share_asked_for_fail(monkeypatch, capsys, percent, passes):
    def small_copy(folder):
        (folder / "mocap").mkdir(parents=True)
        (folder / "mocap" / "limit.py").write_text("print(1 < 2)\n")
        return folder

    monkeypatch.setattr(mutate, "make_copy", small_copy)
    monkeypatch.setattr(mutate, "passes", lambda copy, tests: True)
    monkeypatch.setattr(mutate, "survives", lambda change, groups, copies: change.old == "<")
    monkeypatch.setattr(sys, "argv", ["mutate.py", "--only", "mocap/limit.py", "--least", str(percent)])
    if passes:
        mutate.main()
    else:
        with pytest.raises(SystemExit, match=r"Too few: at least 67% must be caught\."):
            mutate.main()
    assert "2 of 3 changes caught (67%)" in capsys.readouterr().out
