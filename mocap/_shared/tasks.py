"""Work through tasks here, or by threads, processes or a cluster; the results come in the tasks' order."""

import multiprocessing
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import AbstractContextManager
from functools import cache
from itertools import chain, islice
from multiprocessing.connection import wait
from typing import TYPE_CHECKING, Any, TypeVar

from mocap.errors import MocapError

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController

Result = TypeVar("Result")

AHEAD = 64  # tasks that workers have at once


def usable_cores() -> int:
    """Count the cores that this process may use, which can be fewer than the machine has."""
    if sys.platform == "emscripten":  # a browser, which has no threads
        return 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def thread_count(jobs: int | None) -> int:
    """Return the number of threads: `jobs`, or one for each usable core.

    Raises
    ------
    MocapError : unless it is a whole number, at least 1.

    Examples
    --------
    >>> thread_count(3)
    3
    """
    if jobs is None:
        return usable_cores()
    if not isinstance(jobs, int) or jobs < 1:
        raise MocapError(f"jobs is a whole number of threads, at least 1, or None for all cores, got {jobs}.")
    return jobs


def one_blas_thread() -> AbstractContextManager[object]:
    """Multiply matrices on one thread only, in this thread and in those that it starts meanwhile.

    Otherwise each thread of a pool would start more threads for its products, and they would wait for each
    other. The bits of a product, which may depend on the number of threads, are also the same for any number.
    BLAS has one number of threads for the process, which one thread at a time can set. A thread that asks
    while another has set it changes nothing.

    Examples
    --------
    >>> with one_blas_thread():
    ...     {library["num_threads"] for library in blas().info()} <= {1}
    True
    """
    return blas().limit(limits=1)  # type: ignore[no-any-return]


@cache
def blas() -> "ThreadpoolController":
    """Return what sets the number of BLAS's threads; finding the libraries takes some milliseconds."""
    import numpy  # noqa: F401 (its BLAS is found only once it is loaded)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


def run_in_order(
    work: Callable[..., Result],
    tasks: Iterable[tuple[Any, ...]],
    executor: Executor | None,
    jobs: int | None = 1,
) -> Iterator[Result]:
    """Work through tasks in their order; only AHEAD are out at once, since each carries its data along.

    Parameters
    ----------
    work : what to do with the items of a task.
    tasks : the arguments of `work`, one tuple for each task.
    executor : where to work; by default on threads of this process.
    jobs : threads without an executor, as for `thread_count`. One task needs none.

    Raises
    ------
    MocapError : for `jobs` that are not a number of threads.

    Examples
    --------
    >>> list(run_in_order(max, [(1, 2), (4, 3)], None))
    [2, 4]
    """
    threads = thread_count(jobs)
    if executor is not None:
        yield from _run_on(executor, work, tasks)
        return
    remaining = iter(tasks)
    first = list(islice(remaining, 2))
    if threads == 1 or len(first) < 2:
        yield from (work(*task) for task in chain(first, remaining))
        return
    with ThreadPoolExecutor(threads) as pool:  # which starts no more threads than there are tasks
        yield from _run_on(pool, work, chain(first, remaining))


def _run_on(
    executor: Executor, work: Callable[..., Result], tasks: Iterable[tuple[Any, ...]]
) -> Iterator[Result]:
    """Work through tasks on an executor."""
    waiting: deque[Future[Result]] = deque()
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
