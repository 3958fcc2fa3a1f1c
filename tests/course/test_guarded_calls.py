"""A student's function neither stops nor freezes the notebook."""

import itertools
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from mocap._shared.limits import Overdue
from mocap.course import guarded_calls
from mocap.course.guarded_calls import Stopped, guarded, read_report, write_report_to


def endless():
    while True:
        pass


def endless_recursion():
    return endless_recursion()


def in_a_thread():
    threading.Thread(target=lambda: [][0]).start()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (endless, Overdue, None),
        (endless_recursion, RecursionError, "recursion"),
        (lambda: time.sleep(9) if hasattr(os, "fork") else endless(), Overdue, None),
        (lambda: input("Which angle?"), RuntimeError, "waits for a person"),
        (lambda: os._exit(0), RuntimeError, "would end the notebook's kernel"),
        (os.abort, RuntimeError, "would end the notebook's kernel"),
        (lambda: sys.exit(3), SystemExit, "3"),
        (in_a_thread, IndexError, "list index out of range"),
    ],
)
def test_what_would_stop_or_freeze_a_notebook_is_an_error(call, error, message):
    called = {"abort": lambda: os.abort()}.get(getattr(call, "__name__", ""), call)
    with pytest.raises(error, match=message), guarded(0.2):
        called()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells how much memory a process has")
def test_ten_gigabytes_are_refused_and_ordinary_arrays_are_not():
    with pytest.raises(MemoryError), guarded(5.0):
        np.ones(10 * 2**30 // 8)
    with guarded(5.0):
        assert np.ones(2**20).sum() == 2**20


def test_everything_is_as_before_after_a_call():
    def state():
        return input, os._exit, os.abort, threading.excepthook

    before = state()
    with pytest.raises(ZeroDivisionError), guarded(1.0):
        1 / 0  # noqa: B018
    assert state() == before
    with guarded(1.0), guarded(0.01):  # an inner guard has no effect
        time.sleep(0.05)
    assert state() == before


LOOP = """
import itertools, pathlib, sys
from mocap.course import guarded_calls
guarded_calls.SPARE = 0.2
guarded_calls.write_report_to(pathlib.Path("report"))

def longest():
    return sum(itertools.count())

with guarded_calls.guarded(0.2):
    longest()
"""


def test_a_compiled_loop_ends_the_process_and_the_next_one_knows_where(tmp_path):
    script = tmp_path / "student.py"
    script.write_text(LOOP)
    done = subprocess.run([sys.executable, script], cwd=tmp_path, timeout=60, check=False)
    assert done.returncode != 0
    line = LOOP.splitlines().index("    return sum(itertools.count())") + 1
    assert read_report(tmp_path / "report") == Stopped("longest", line, ("longest",))


def test_a_report_is_empty_and_goes_where_nothing_was_ended(tmp_path):
    report = tmp_path / "report"
    write_report_to(report)
    with guarded(1.0):
        assert report.exists() and read_report(report) is None
    assert not report.exists()
    report.write_text("Timeout (0:00:08)!\n")
    assert read_report(report) == Stopped("", 0, ())
    write_report_to(report, anew=True)
    assert not report.exists()
    write_report_to(None)


def test_a_quick_guard_leaves_out_what_takes_time(monkeypatch):
    monkeypatch.setattr(guarded_calls, "_timer", None)
    monkeypatch.setattr(guarded_calls, "_limited_memory", None)
    with pytest.raises(RuntimeError), guarded(1.0, quick=True):
        input()
    assert next(itertools.count()) == 0
