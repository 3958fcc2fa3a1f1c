"""The machinery of the benchmarks, with made-up ratios: they are held to bounds, printed and recorded."""

import os
import subprocess
import sys

import numpy as np
import pytest

from tests.benchmarks import history, timing
from tests.benchmarks.timing import Ratio
from tests.test_house import ROOT

BENCHMARKS = """
import pytest
from tests.benchmarks.timing import hold

pytestmark = pytest.mark.benchmark

def test_within_its_bound():
    hold("within", 0.5, 1)

def test_over_its_bound():
    hold("over", 1.5, 1)

def test_over_twice_its_bound():
    hold("twice", 2.5, 1)
"""


@pytest.fixture(autouse=True)
def held(monkeypatch):
    """Let no ratio of these tests reach the table of a run."""
    ratios = []
    monkeypatch.setattr(timing, "HELD", ratios)
    return ratios


@pytest.mark.parametrize(
    ("value", "mark"), [(0.5, ""), (1.0, ""), (1.01, "over its bound"), (1.99, "over its bound")]
)
def test_a_ratio_below_twice_its_bound_passes_and_one_over_its_bound_is_marked(held, capsys, value, mark):
    timing.hold("clean_up, in yardsticks", value, 1)
    assert held == [Ratio("clean_up, in yardsticks", value, 1.0)]
    assert held[0].mark == mark
    assert capsys.readouterr().out.strip().endswith(mark or "bound 1")


@pytest.mark.parametrize("value", [2.0, 3.0, np.inf, np.nan])
def test_a_ratio_of_twice_its_bound_fails_and_is_noted_as_well(held, value):
    with pytest.raises(AssertionError, match=r"clean_up: .* is 2 times the bound 1"):
        timing.hold("clean_up", value, 1)
    assert [ratio.mark for ratio in held] == ["FAILS"]


def test_two_benchmarks_of_one_name_are_refused():
    timing.hold("a step", 0.5, 1)
    with pytest.raises(ValueError, match="'a step' already"):
        timing.hold("a step", 0.5, 1)


def test_a_ratio_is_that_of_the_fastest_runs(monkeypatch):
    times = iter([0, 3, 10, 11, 20, 22, 30, 34])  # work: 3 and 2 s; base: 1 and 4 s
    monkeypatch.setattr(timing.time, "process_time", lambda: next(times))
    assert timing.ratio(lambda: None, lambda: None, repeats=2) == 2


def test_recorded_ratios_are_read_back(tmp_path):
    file = tmp_path / "history.tsv"
    assert history.read_history(file) == []
    history.record([Ratio("clean_up", 1.23456, 2)], file, "load 0.1")
    history.record([Ratio("clean_up", 1.5, 2), Ratio("a step", 0.25, 1 / 3)], file)
    first, second, step = history.read_history(file)
    assert (first.benchmark, first.ratio, first.bound, first.note) == ("clean_up", 1.235, 2.0, "load 0.1")
    assert (second.ratio, second.note) == (1.5, "")
    assert (step.benchmark, step.ratio, step.bound) == ("a step", 0.25, 0.3333)
    assert (first.commit, first.processor) == (history.commit(), history.processor())


@pytest.mark.parametrize("name", ["a\tstep", "a\nstep"])
def test_a_name_that_would_break_a_line_is_refused(tmp_path, name):
    with pytest.raises(ValueError, match="a tab or a line end"):
        history.record([Ratio(name, 1, 1)], tmp_path / "history.tsv")


def test_the_stored_history_is_read_and_its_ratios_are_above_0():
    entries = history.read_history()
    assert all(entry.ratio > 0 and entry.bound > 0 for entry in entries)
    assert all(entry.date and entry.commit and entry.processor and entry.benchmark for entry in entries)


def test_new_ratios_stand_beside_the_last_recorded_ones(tmp_path):
    file = tmp_path / "history.tsv"
    history.record([Ratio("clean_up", 4, 2)], file)
    history.record([Ratio("clean_up", 1, 2)], file)
    table = history.compare([Ratio("clean_up", 3, 2), Ratio("a step", 0.1, 1)], history.read_history(file))
    _, old_benchmark, new_benchmark = (line.split() for line in table.splitlines())
    assert old_benchmark == ["3", "2", "1", "3.00", "clean_up", "over", "its", "bound"]
    assert new_benchmark == ["0.1", "1", "a", "step"]


def test_a_run_prints_its_table_records_it_and_fails_at_twice_a_bound(tmp_path):
    (tmp_path / "test_made_up.py").write_text(BENCHMARKS)
    file = tmp_path / "history.tsv"
    options = ["-q", "-n0", "-p", "tests.benchmarks.conftest", "-m", "benchmark"]
    command = [sys.executable, "-m", "pytest", *options, f"--rootdir={tmp_path}", "-c", os.devnull]
    result = subprocess.run(
        [*command, tmp_path / "test_made_up.py", "--record-benchmarks", file],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 1, result.stdout + result.stderr
    assert "1 failed, 2 passed" in result.stdout
    assert "over  over its bound" in result.stdout
    assert "twice  FAILS" in result.stdout
    entries = history.read_history(file)
    assert {entry.benchmark: entry.ratio for entry in entries} == {"within": 0.5, "over": 1.5, "twice": 2.5}
