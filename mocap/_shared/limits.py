"""A limit of time for code that others wrote."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


class Overdue(BaseException):
    """Code has taken longer than its limit.

    It is no `Exception`, because a loop that never ends may hold `except Exception`.
    """


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise `Overdue` in the code inside after some seconds.

    It takes the alarm of Linux and macOS, in the main thread, where notebooks run their cells. Elsewhere, and
    inside another limit, there is none.

    Examples
    --------
    >>> with time_limit(0.05):
    ...     while True:
    ...         pass
    Traceback (most recent call last):
    mocap._shared.limits.Overdue
    """
    main = threading.current_thread() is threading.main_thread()
    if not (main and hasattr(signal, "setitimer")) or signal.getitimer(signal.ITIMER_REAL)[0]:
        yield
        return

    def overdue(*_: object) -> None:
        raise Overdue

    previous = signal.signal(signal.SIGALRM, overdue)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)
