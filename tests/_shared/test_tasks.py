"""Threads of this process: how many there are, and that BLAS starts none of its own below them."""

import os
import threading

import pytest

from mocap._shared import tasks
from mocap._shared.tasks import blas, one_blas_thread, run_in_order, thread_count, usable_cores
from tests.refusals import refusals


def blas_threads():
    return {library["num_threads"] for library in blas().info()}


def test_cores_are_those_that_the_process_may_use():
    if not hasattr(os, "sched_getaffinity"):
        pytest.skip("only Linux binds a process to cores")
    allowed = os.sched_getaffinity(0)
    assert usable_cores() == thread_count(None) == len(allowed)
    try:
        os.sched_setaffinity(0, {min(allowed)})
        assert usable_cores() == 1
    finally:
        os.sched_setaffinity(0, allowed)


def test_a_browser_has_one_core(monkeypatch):
    monkeypatch.setattr(tasks.sys, "platform", "emscripten")
    assert usable_cores() == 1


test_jobs_are_a_number_of_threads = refusals(
    ("at least 1, or None for all cores, got 0", thread_count, 0),
    ("got -2", thread_count, -2),
    ("got 2.0", thread_count, 2.0),
    ("got four", thread_count, "four"),
)


def test_blas_has_one_thread_in_the_threads_of_a_pool_too():
    if not blas_threads():
        pytest.skip("this BLAS has no threads to set")
    with blas().limit(limits=2):
        several = blas_threads()
        with one_blas_thread():
            with one_blas_thread():  # as in a task that runs here
                assert blas_threads() == {1}
            inside = list(run_in_order(lambda _: blas_threads(), [(n,) for n in range(6)], None, jobs=2))
            assert inside == [{1}] * 6
        assert blas_threads() == several


def test_an_error_gives_blas_its_threads_back():
    before = blas_threads()
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        1 / 0  # noqa: B018
    assert blas_threads() == before


def test_threads_work_at_the_same_time_and_results_keep_their_order():
    both_here = threading.Barrier(2, timeout=60)

    def meet(number):
        both_here.wait()
        return number, threading.current_thread().name

    results = list(run_in_order(meet, [(0,), (1,)], None, jobs=2))
    assert [number for number, _ in results] == [0, 1]
    assert len({thread for _, thread in results}) == 2


@pytest.mark.parametrize(("count", "jobs"), [(1, 4), (3, 1), (0, 4)])
def test_one_task_or_one_job_starts_no_thread(count, jobs):
    here = threading.current_thread().name
    name = lambda _: threading.current_thread().name  # noqa: E731
    assert list(run_in_order(name, [(n,) for n in range(count)], None, jobs=jobs)) == [here] * count


def test_an_error_in_a_thread_reaches_the_caller_and_ends_the_rest():
    done = []

    def work(number):
        if number == 3:
            raise ValueError("three")
        done.append(number)

    with pytest.raises(ValueError, match="three"):
        list(run_in_order(work, ((n,) for n in range(10_000)), None, jobs=2))
    assert len(done) < 200
