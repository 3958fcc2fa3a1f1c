"""A limit of time ends a loop by the system's alarm, and without one, as on Windows, by a watching thread."""

import ctypes
import signal
import threading
import time

import pytest

from mocap._shared import limits
from mocap._shared.limits import Overdue, time_limit

SOON = 0.02  # seconds
SAFE = 60.0  # seconds, after which a loop of a failing test ends by itself


@pytest.fixture(params=["alarm", "watching thread"])
def means(request, monkeypatch):
    if request.param == "alarm" and not hasattr(signal, "setitimer"):
        pytest.skip("this system has no alarm")
    if request.param != "alarm":
        monkeypatch.delattr(signal, "setitimer", raising=False)
    return request.param


def loop_and_catch_errors():
    end = time.monotonic() + SAFE
    while time.monotonic() < end:
        try:
            [][1]
        except Exception:
            continue


@pytest.mark.usefixtures("means")
def test_a_loop_that_catches_all_errors_is_ended_and_the_next_limit_works_as_well():
    for _ in range(3):
        with pytest.raises(Overdue), time_limit(SOON):
            loop_and_catch_errors()


@pytest.mark.usefixtures("means")
def test_code_that_ends_in_time_is_left_alone():
    with time_limit(SOON):
        result = sum(range(10))
    end = time.monotonic() + 3 * SOON
    while time.monotonic() < end:
        assert result == 45


@pytest.mark.usefixtures("means")
def test_an_error_and_an_interruption_pass_through():
    for error in (ZeroDivisionError, KeyboardInterrupt):
        with pytest.raises(error), time_limit(SAFE):
            raise error
    assert not limits._watched


@pytest.mark.usefixtures("means")
def test_inside_another_limit_there_is_none():
    with time_limit(SAFE), time_limit(1e-9):
        end = time.monotonic() + SOON
        while time.monotonic() < end:
            pass


def test_a_loop_in_another_thread_is_ended():
    ended = []

    def work():
        try:
            with time_limit(SOON):
                loop_and_catch_errors()
        except Overdue:
            ended.append(threading.current_thread())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert ended == [thread] and not limits._watched


def test_an_error_on_its_way_as_the_code_ends_is_raised_inside_the_block(monkeypatch):
    monkeypatch.delattr(signal, "setitimer", raising=False)
    begun, raise_in = threading.Event(), ctypes.pythonapi.PyThreadState_SetAsyncExc

    def raise_late(thread, error):
        begun.set()
        time.sleep(SOON)  # meanwhile the code inside ends
        raise_in(thread, error)

    monkeypatch.setattr(ctypes.pythonapi, "PyThreadState_SetAsyncExc", raise_late)
    with pytest.raises(Overdue), time_limit(1e-9):
        begun.wait()
    assert not limits._watched


def test_where_no_thread_starts_there_is_no_limit(monkeypatch):
    def refuse(thread):
        raise RuntimeError("can't start new thread")

    monkeypatch.delattr(signal, "setitimer", raising=False)
    monkeypatch.setattr(threading.Thread, "start", refuse)
    with time_limit(1e-9):
        assert sum(range(10)) == 45
    assert not limits._watched
