"""Work through tasks here, or by threads, processes or a cluster; the results come in the tasks' order."""

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future
from multiprocessing.connection import wait
from typing import Any

from mocap._shared.arrays import Array

AHEAD = 64  # tasks that workers have at once


def run_in_order(
    work: Callable[..., Array], tasks: Iterable[tuple[Any, ...]], executor: Executor | None
) -> Iterator[Array]:
    """Work through tasks in their order; only AHEAD are out at once, since each carries its data along.

    Parameters
    ----------
    work : what to do with the items of a task.
    tasks : the arguments of `work`, one tuple for each task.
    executor : where to work; by default here, one task after the other.

    Examples
    --------
    >>> list(run_in_order(max, [(1, 2), (4, 3)], None))
    [2, 4]
    """
    if executor is None:
        yield from (work(*task) for task in tasks)
        return
    waiting: deque[Future[Array]] = deque()
    try:
        for task in tasks:
            waiting.append(executor.submit(work, *task))
            if len(waiting) == AHEAD:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:  # after an error or Ctrl-C, no task is left that still waits
        for future in waiting:
            future.cancel()


def serve() -> None:
    """Make this process one that only works for its parent: it ends with it, and leaves Ctrl-C to it.

    Pass it as `initializer` to a `ProcessPoolExecutor`. Otherwise workers of a killed process wait for ever.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if parent := multiprocessing.parent_process():
        threading.Thread(target=lambda: (wait([parent.sentinel]), os._exit(1)), daemon=True).start()
