"""What functions take as `progress=`."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

Progress = Callable[[Sequence[Any]], Iterable[Any]]
"""Wraps the things to do, and hands them on one by one: `iter` shows nothing, `tqdm.tqdm` shows a bar."""
