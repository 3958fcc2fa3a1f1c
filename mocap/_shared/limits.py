"""A time limit for untrusted code.

In the main thread of Linux and macOS, the limit is an alarm signal of the system, which also interrupts
blocking calls such as `time.sleep`. On Windows, and in other threads, a watchdog thread makes Python raise
the error in the limited thread. The error is raised at the next bytecode instruction of that thread: it ends
endless loops, but does not interrupt a call of a compiled function. Starting the watchdog takes some tenths
of a millisecond, setting the alarm a hundredth of that.
"""

from __future__ import annotations

import ctypes
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress


class Overdue(BaseException):
    """Code has taken longer than its limit.

    It is not an `Exception`, because an endless loop may contain `except Exception`.
    """


_watched: set[int] = set()  # identifiers of the threads that a watchdog limits


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise `Overdue` in the code inside a `with` block after some seconds.

    A limit inside another limit of the same thread has no effect, nor has any limit in the Python of a
    browser, which has no threads.

    Examples
    --------
    >>> with time_limit(0.05):
    ...     while True:
    ...         pass
    Traceback (most recent call last):
    mocap._shared.limits.Overdue
    """
    main = threading.current_thread() is threading.main_thread()
    alarm = main and hasattr(signal, "setitimer")
    if threading.get_ident() in _watched or (alarm and signal.getitimer(signal.ITIMER_REAL)[0]):
        yield
        return
    with _alarm(seconds) if alarm else _watching_thread(seconds):
        yield


@contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    """Raise `Overdue` from the handler of the system's alarm."""

    def overdue(*_: object) -> None:
        raise Overdue

    previous = signal.signal(signal.SIGALRM, overdue)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


@contextmanager
def _watching_thread(seconds: float) -> Iterator[None]:
    """Raise `Overdue` in this thread from a watchdog thread, unless the code inside ends before."""
    limited = threading.get_ident()
    ended = threading.Event()
    raising = threading.Lock()

    def watch() -> None:
        if ended.wait(seconds):
            return
        with raising:
            if not ended.is_set():
                error = ctypes.py_object(Overdue)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(limited), error)

    with suppress(RuntimeError):  # no thread can start, as in the Python of a browser
        threading.Thread(target=watch, daemon=True).start()
    _watched.add(limited)
    try:
        yield
    finally:
        try:
            with raising:  # wait for a pending error, which is raised within `set`
                ended.set()
        finally:
            _watched.discard(limited)
