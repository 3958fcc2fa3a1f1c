"""Execution of tasks by threads, processes or a cluster, with results in the order of the tasks."""

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

AHEAD = 64  # the largest number of tasks submitted at a time


def usable_cores() -> int:
    """Return the number of cores that this process may use, which can be fewer than the machine has."""
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
    """Limit BLAS to one thread, as a context manager.

    Otherwise each thread of a pool would start further threads for its matrix products, which compete for the
    cores. The last bits of a product may depend on the number of threads. With this limit, they do not depend
    on the number of threads of the pool. The limit is one for the whole process: within the context of
    another thread it has no effect.

    Examples
    --------
    >>> with one_blas_thread():
    ...     {library["num_threads"] for library in blas().info()} <= {1}
    True
    """
    return blas().limit(limits=1)  # type: ignore[no-any-return]


@cache
def blas() -> "ThreadpoolController":
    """Return the controller of BLAS threads. Finding the libraries takes some milliseconds."""
    import numpy  # noqa: F401 (its BLAS is found only after import)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


def run_in_order(
    work: Callable[..., Result],
    tasks: Iterable[tuple[Any, ...]],
    executor: Executor | None,
    jobs: int | None = 1,
) -> Iterator[Result]:
    """Execute tasks, and yield their results in order. At most AHEAD are submitted, to limit the memory.

    Parameters
    ----------
    work : the function to call for each task.
    tasks : the arguments of `work`, a tuple for each task.
    executor : a pool of processes or a cluster. By default, threads of this process are used.
    jobs : the number of threads without an executor, as for `thread_count`. A single task is executed in
        this thread.

    Raises
    ------
    MocapError : for `jobs` that is not a number of threads.

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
    with ThreadPoolExecutor(threads) as pool:  # starts at most as many threads as tasks
        yield from _run_on(pool, work, chain(first, remaining))


def _run_on(
    executor: Executor, work: Callable[..., Result], tasks: Iterable[tuple[Any, ...]]
) -> Iterator[Result]:
    """Execute tasks on an executor."""
    waiting: deque[Future[Result]] = deque()
    try:
        for task in tasks:
            waiting.append(executor.submit(work, *task))
            if len(waiting) == AHEAD:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:  # after an error or Ctrl-C, cancel the pending tasks
        for future in waiting:
            future.cancel()


def serve() -> None:
    """Initialise a worker process: it ends with its parent, and ignores Ctrl-C, which the parent handles.

    Pass it as `initializer` to a `ProcessPoolExecutor`. Otherwise the workers of a killed process never end.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if parent := multiprocessing.parent_process():
        threading.Thread(target=lambda: (wait([parent.sentinel]), os._exit(1)), daemon=True).start()
