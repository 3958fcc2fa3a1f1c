"""Progress bars and durations of the stages of a command."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from mocap._shared.progress import Progress
from mocap.cli.messages import VERBOSITY, note

SHORTEST_STAGE = 0.05  # seconds: a shorter stage would be shown as 0.0 s


@contextmanager
def timed_stage(name: str) -> Iterator[None]:
    """Print, with `-v`, the duration of a stage of the work, unless it is very short.

    Parameters
    ----------
    name : the name of the stage, such as "measuring".
    """
    start = time.perf_counter()
    yield
    seconds = time.perf_counter() - start
    if seconds >= SHORTEST_STAGE:
        note(f"{name}: {seconds:.1f} s")


@contextmanager
def timed_reading(path: Path) -> Iterator[None]:
    """Print, with `-v`, the file that is read and the duration."""
    start = time.perf_counter()
    yield
    note(f"read {path} in {time.perf_counter() - start:.2f} s")


def bar(label: str) -> Progress:
    """Return a progress bar for work on a terminal that takes longer than a second.

    The bar is erased at the end. With `-v`, the duration is printed.

    Examples
    --------
    >>> list(bar("counting")([1, 2, 3]))
    [1, 2, 3]
    """
    from tqdm import tqdm  # imported here, so that `mocap --help` stays quick

    verbosity = VERBOSITY.get()
    show = partial(tqdm, desc=label, delay=1.0, leave=False, disable=verbosity.quiet or None)
    return partial(_timed, label, show) if verbosity.verbose else show


def _timed(label: str, show: Progress, items: Sequence[Any]) -> Iterator[Any]:
    """Yield the items, and print their number and the duration."""
    start = time.perf_counter()
    count = 0
    for item in show(items):
        yield item
        count += 1
    note(f"{label}: {count} in {time.perf_counter() - start:.1f} s")
