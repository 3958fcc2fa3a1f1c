"""A bar on the terminal for work that takes longer than a second."""

import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, TextIO, TypeVar

Item = TypeVar("Item")
Progress = Callable[[Sequence[Any]], Iterable[Any]]
"""What functions take as `progress=`: wraps the things to do, and hands them on one by one."""


def bar(
    items: Sequence[Item], what: str = "", *, stream: TextIO | None = None, delay: float = 1.0
) -> Iterator[Item]:
    """Hand on `items` one by one and draw a bar once `delay` seconds have gone by.

    Parameters
    ----------
    items : the things to do.
    what : a word or two in front of the bar.
    stream : where to draw, standard error by default; nothing is drawn where that is no terminal.
    delay : seconds of silence at the start.

    Examples
    --------
    >>> list(bar([1, 2, 3], "counting"))
    [1, 2, 3]
    """
    stream = stream or sys.stderr
    start, drawn = time.monotonic(), False
    try:
        for done, item in enumerate(items):
            if stream.isatty() and time.monotonic() - start >= delay:
                filled = 30 * done // len(items)
                stream.write(f"\r{what} [{'#' * filled:<30}] {done}/{len(items)}")
                stream.flush()
                drawn = True
            yield item
    finally:
        if drawn:
            stream.write("\r\x1b[K")  # wipe the line: the bar is no part of the report
            stream.flush()
